// clothlab: the desktop tool.
#include <QApplication>
#include <QCommandLineParser>
#include <QSurfaceFormat>
#include <clocale>

#include "io/run_folder.h"
#include "main_window/main_window.h"
#include "scene/builtin_scenes.h"
#include "theme/theme.h"
#include "viewport/cloth_view.h"

int main(int argc, char** argv) {
  QApplication application(argc, argv);
  QApplication::setOrganizationName("Clothlab");
  QApplication::setApplicationName("clothlab");
  QApplication::setApplicationDisplayName("Clothlab");
  QApplication::setApplicationVersion(QString::fromStdString(cloth::version()));
  std::setlocale(LC_NUMERIC, "C");  // a decimal point in every file, whatever the desktop's language

  QCommandLineParser parser;
  parser.setApplicationDescription("A desktop lab for cloth simulation.");
  parser.addPositionalArgument("scene", "A scene or session file or the name of a built-in scene.", "[SCENE]");
  parser.addHelpOption();
  parser.addVersionOption();
  parser.process(application);

  QSurfaceFormat::setDefaultFormat(clothlab::ClothView::surface_format());
  clothlab::apply_theme(application);
  application.setWindowIcon(clothlab::icon("clothlab"));

  clothlab::MainWindow window;
  window.show();
  window.openScene(cloth::default_scene_name);
  if (!parser.positionalArguments().isEmpty()) window.openScene(parser.positionalArguments().front());
  return QApplication::exec();
}

// clothlab: the desktop tool.
#include <QApplication>
#include <QCommandLineParser>
#include <QSurfaceFormat>
#include <clocale>

#include "compare/compare_window.h"
#include "compare/comparison_files.h"
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
  parser.addPositionalArgument("file",
                               "A scene, session or comparison (.compare.json), or the name of a built-in one.",
                               "[SCENE|SESSION|COMPARISON]");
  parser.addHelpOption();
  parser.addVersionOption();
  parser.process(application);

  QSurfaceFormat::setDefaultFormat(clothlab::ClothView::surface_format());
  clothlab::apply_theme(application);
  application.setWindowIcon(clothlab::icon("clothlab"));

  const QString wanted = parser.positionalArguments().value(0);
  if (clothlab::is_comparison_name(wanted)) {
    clothlab::CompareWindow window;
    window.show();
    window.openComparison(wanted);
    return QApplication::exec();
  }
  clothlab::MainWindow window;
  window.show();
  window.openScene(cloth::default_scene_name);
  if (!wanted.isEmpty()) window.openScene(wanted);
  return QApplication::exec();
}

// clothlab: the desktop tool.
#include <QApplication>
#include <QCommandLineParser>
#include <QMessageBox>
#include <QSurfaceFormat>
#include <clocale>

#include "io/machine.h"
#include "io/process.h"
#include "main_window/autosave.h"
#include "main_window/lab_window.h"
#include "main_window/stop_signals.h"
#include "theme/theme.h"
#include "viewport/cloth_view.h"

namespace {

/// Catches exceptions from event handlers, usually std::bad_alloc, and shows a message. The window stays
/// open, because it may contain unsaved work.
class Application : public QApplication {
 public:
  using QApplication::QApplication;

  bool notify(QObject* receiver, QEvent* event) override {
    try {
      return QApplication::notify(receiver, event);
    } catch (...) {
      show(QString::fromStdString(cloth::failure_in_hand().text));
      return false;
    }
  }

 private:
  void show(const QString& text) {
    qCritical("clothlab: %s", qPrintable(text));
    if (showing_) return;  // one message is enough
    showing_ = true;
    QMessageBox::critical(activeWindow(), applicationDisplayName(), text);
    showing_ = false;
  }

  bool showing_ = false;
};

int run(int argc, char** argv) {
  Application application(argc, argv);
  QApplication::setOrganizationName("Clothlab");
  QApplication::setApplicationName("clothlab");
  QApplication::setApplicationDisplayName("Clothlab");
  QApplication::setApplicationVersion(QString::fromStdString(cloth::version()));
  std::setlocale(LC_NUMERIC, "C");  // a decimal point in every file, whatever the desktop's language

  QCommandLineParser parser;
  parser.setApplicationDescription("A desktop lab for cloth simulation.");
  parser.addPositionalArgument(
      "file",
      "A scene, session, comparison, mesh (.obj) or study's folder, or the name of a built-in scene or "
      "comparison.",
      "[FILE]");
  parser.addHelpOption();
  parser.addVersionOption();
  parser.process(application);

  QSurfaceFormat::setDefaultFormat(clothlab::ClothView::surface_format());
  clothlab::apply_theme(application);
  application.setWindowIcon(clothlab::icon("clothlab"));

  const clothlab::StopSignals stop_signals([] { QApplication::exit(130); });
  clothlab::open_first_window(parser.positionalArguments().value(0));
  const int exit_code = QApplication::exec();
  // A signal leaves windows open: they save changes aside and finish recordings and studies.
  for (clothlab::LabWindow* window : clothlab::LabWindow::all()) {
    window->autosave().save();
    delete window;
  }
  return exit_code;
}

}  // namespace

int main(int argc, char** argv) {
  cloth::settle_standard_streams();
  cloth::end_by_exit_code("clothlab", 4, 1);
  try {
    return run(argc, argv);
  } catch (...) {
    const cloth::Failure failure = cloth::failure_in_hand();
    qCritical("clothlab: %s", failure.text.c_str());
    return failure.is_defect ? 1 : 4;
  }
}

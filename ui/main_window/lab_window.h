// The base of the windows of a scene and of a comparison: actions and menus for files, edits and runs, the
// dialog about unsaved changes, messages, docks and recording.
#pragma once

#include <QMainWindow>
#include <memory>

#include "bridge/worker_commands.h"
#include "bridge/worker_status.h"
#include "document/document.h"
#include "main_window/transport_bar.h"
#include "params/parameter_panel.h"
#include "widgets/notice_bar.h"

namespace clothlab {

class LabWindow : public QMainWindow {
  Q_OBJECT

 public:
  /// Whether closing or opening another document asks about unsaved changes.
  void setAsksToSave(bool asks) { asks_to_save_ = asks; }

  /// Records into `folder` until the record action is switched off or the worker ends the recording.
  void startRecording(const QString& folder) { send(command::StartRecording{folder.toStdString()}); }
  /// False, with a message in the window, if the file could not be written.
  bool saveTo(const QString& path);

  ParameterPanel& parameters() { return *parameters_; }
  NoticeBar& notice() { return *notice_; }

 protected:
  /// The texts that differ between the windows.
  struct Wording {
    QString document;            ///< "scene"
    QString open_title, filter;  ///< of the dialogs for files
    QString ending;              ///< suffix appended to a file name without one
    QString title;               ///< of the window; %1 is the document's
    QString unsaved;             ///< the question before changes of %1 are lost
    QString play_tip, step_tip, record_tip;
    QString widest_time, widest_rate;  ///< in the transport bar
  };
  /// The commands that every worker accepts.
  using RunCommand =
      std::variant<command::Restart, command::Play, command::Pause, command::SingleStep, command::Speed,
                   command::Brush, command::Pull, command::StartRecording, command::StopRecording>;

  LabWindow(std::unique_ptr<Document> document, Wording wording, QSize pleasant_size, QWidget* parent);
  bool hasAir() { return scene().air && scene().air->drag > 0; }
  void brush(const cloth::BrushGust& gust);
  Document& anyDocument() { return *any_document_; }
  /// Called by a derived class's destructor, because the widgets refer to its link.
  void deleteWidgets();
  /// Makes the form of the document and the notice bar.
  void makeForm();

  virtual void send(const RunCommand& command) = 0;
  virtual void open(const QString& path) = 0;
  /// Empty when done, else what went wrong.
  virtual QString write(const QString& path) = 0;
  /// The edited scene; in a comparison the scene that all panes share.
  virtual const cloth::Scene& scene() = 0;
  virtual void togglePin(int row, int column) = 0;
  /// Shows a message that the wind brush needs air, with a button that adds air.
  virtual void offerAir(const QString& text) = 0;
  virtual void play(bool on);
  virtual void restart() { send(command::Restart{}); }

  void closeEvent(QCloseEvent* event) override;

  /// An action of this window; its tooltip contains the shortcut.
  QAction* makeAction(const char* icon_name, const QString& text, const QString& tip, const QKeySequence& key,
                      const char* name);
  /// Connects pull, wind brush and pin signals of a view or of the panes to the worker and the document.
  template <class View>
  void connectHand(View* view) {
    connect(view, &View::pullChanged, this, [this](const cloth::Pull& pull) { send(command::Pull{pull}); });
    connect(view, &View::pullEnded, this, [this] { send(command::Pull{}); });
    connect(view, &View::brushChanged, this, &LabWindow::brush);
    connect(view, &View::brushEnded, this, [this] {
      if (hasAir()) send(command::Brush{});
    });
    connect(view, &View::pinToggled, this, [this](int particle) {
      const int columns = scene().cloth.columns;
      togglePin(particle / columns, particle % columns);
    });
  }
  /// Sets the central widget: `parts` from top to bottom, of which `stretched` takes the free height.
  void setMiddle(const std::vector<QWidget*>& parts, QWidget* stretched);
  QDockWidget* addDock(const QString& title, const char* name, QWidget* content, Qt::DockWidgetArea area);
  void addTransport();

  /// With an entry to open a file; of the other menus all that both windows have.
  QMenu* addFileMenu();
  void addSaveEntries(QMenu& file);
  void addComparisons(QMenu& menu, const std::function<void(const QString& name)>& open_one);
  QMenu* addEditMenu();
  QMenu* addRunMenu(const QList<QAction*>& actions);
  void addDockEntries(QMenu& view);

  /// Shows a message, or withdraws the one of this cause if the text is empty.
  void say(const QString& cause, NoticeBar::Level level, const QString& text);
  /// Updates actions and messages from the state of a run and of its recording.
  void followRun(const RunStatus& now);
  void followRecording(const RunStatus& before, const RunStatus& now);
  void updateTitle();
  bool mayLoseChanges();
  bool save() { return any_document_->path().isEmpty() ? saveAs() : saveTo(any_document_->path()); }
  bool saveAs();
  /// Asks for a path to save to and appends `ending` if it has no suffix; empty: the user cancelled.
  QString askForPath(const QString& title, const QString& filter, const QString& ending,
                     const QString& present = {});
  void openWithDialog();

  ParameterPanel* parameters_ = nullptr;
  NoticeBar* notice_ = nullptr;
  TransportBar* transport_ = nullptr;
  QAction *play_, *step_, *reset_, *record_, *save_plots_;
  QAction *open_ = nullptr, *save_ = nullptr, *undo_ = nullptr, *redo_ = nullptr;

 private:
  std::unique_ptr<Document> any_document_;
  Wording wording_;
  bool asks_to_save_ = true;
};

}  // namespace clothlab

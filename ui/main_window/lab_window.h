// The base of the windows of a scene and of a comparison: actions and menus for files, edits and runs,
// opening and saving, the dialog about unsaved changes, messages, docks and recording.
#pragma once

#include <QMainWindow>
#include <memory>

#include "bridge/worker_commands.h"
#include "bridge/worker_status.h"
#include "charts/chart_area.h"
#include "document/document.h"
#include "document/remedies.h"
#include "document/save_dialog.h"
#include "main_window/transport_bar.h"
#include "params/parameter_panel.h"
#include "widgets/notice_bar.h"

namespace clothlab {

struct OpenedComparison;
struct OpenedScene;

class LabWindow : public QMainWindow {
  Q_OBJECT

 public:
  /// Opens a file of any FileType, a study's folder, or a built-in scene or comparison by its name; in a new
  /// window if this one does not show that type. On error the window shows a message with place, value and
  /// rule, and nothing else changes.
  void open(const QString& name);
  void openScene(const QString& name);  ///< or a session
  void openComparison(const QString& name);

  /// Closes all windows. Each with unsaved changes or a running study asks first; on Cancel none is closed.
  static void quit();
  /// All windows, visible or not.
  static std::vector<LabWindow*> all();

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
    QString document;  ///< "scene"
    FileKind kind;     ///< of the document's file
    QString title;     ///< of the window; %1 is the document's
    QString unsaved;   ///< the question before changes of %1 are lost
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
  /// Shows what was read without problems, in this window or in a new one.
  virtual void load(const OpenedScene& opened) = 0;
  virtual void load(const OpenedComparison& opened) = 0;
  virtual void loadStudy(const QString& folder) = 0;
  /// Replaces the cloth by the mesh, as an undoable edit.
  virtual void loadMesh(const QString& file);
  /// Empty when done, else what went wrong.
  virtual QString write(const QString& path) = 0;
  /// The edited scene; in a comparison the scene that all panes share.
  virtual const cloth::Scene& scene() = 0;
  virtual void togglePin(int row, int column) = 0;
  /// Shows a message that the wind brush needs air, with a button that adds air.
  virtual void offerAir(const QString& text) = 0;
  virtual void play(bool on);
  virtual void restart() { send(command::Restart{}); }

  /// Asks about what closing the window would lose; false: the user cancelled.
  virtual bool mayClose() { return mayLoseChanges(); }
  void closeEvent(QCloseEvent* event) override;
  void dragEnterEvent(QDragEnterEvent* event) override;
  void dropEvent(QDropEvent* event) override;
  void resizeEvent(QResizeEvent* event) override;
  bool eventFilter(QObject* watched, QEvent* event) override;

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
  /// Sets the central widget: `parts` from top to bottom, of which `stretched` takes the free height and has
  /// the messages over its edge.
  void setMiddle(const std::vector<QWidget*>& parts, QWidget* stretched, Qt::Edge messages);
  QDockWidget* addDock(const QString& title, const char* name, QWidget* content, Qt::DockWidgetArea area);
  /// Docks at the sides get these widths, in px, and get them back when the window was narrower meanwhile.
  void setWidths(const QList<QDockWidget*>& docks, const QList<int>& widths);
  void addTransport();

  /// With an entry to open a file; of the other menus all that both windows have.
  QMenu* addFileMenu();
  void addSaveEntries(QMenu& file);
  void addCloseEntries(QMenu& file);
  void addComparisons(QMenu& menu);
  QMenu* addEditMenu();
  QMenu* addRunMenu(const QList<QAction*>& actions);
  void addDockEntries(QMenu& view);

  /// Shows a message, or withdraws the one of this kind if the text is empty.
  void say(const QString& kind, NoticeBar::Level level, const QString& text);
  /// Updates actions and messages from the state of a run and of its recording.
  void followRun(const RunStatus& now);
  void followRecording(const RunStatus& before, const RunStatus& now);
  /// The edits as one undo step, and a restart.
  void restartWith(
      const Remedy& remedy,
      const std::function<void(const std::string& path, const cloth::ParameterValue& value)>& set);
  void updateTitle();
  bool mayLoseChanges();
  bool save() { return any_document_->path().isEmpty() ? saveAs() : saveTo(any_document_->path()); }
  bool saveAs();
  /// Asks for a path, calls `write` and shows where it wrote, or the error that it returned. `what`:
  /// "picture".
  bool saveByDialog(const QString& what, const std::vector<FileKind>& kinds,
                    const std::function<QString(const QString& path)>& write);
  /// Shows that `what` was saved, or the problem; true if there is none.
  bool saySaved(const QString& what, const QString& path, const QString& problem);
  /// Connects the action and the charts' own button that save the charts.
  void connectCharts(ChartArea* charts);
  void openWithDialog();
  /// Brings the window to the front, so that its question is visible.
  void comeForward();

  ParameterPanel* parameters_ = nullptr;
  NoticeBar* notice_ = nullptr;
  TransportBar* transport_ = nullptr;
  QAction *play_, *step_, *reset_, *record_, *save_plots_;
  QAction *open_ = nullptr, *save_ = nullptr, *undo_ = nullptr, *redo_ = nullptr;

 private:
  bool isSound(const QString& what, const QString& problems);

  std::unique_ptr<Document> any_document_;
  Wording wording_;
  bool asks_to_save_ = true;
  bool may_close_ = false;                 ///< quit() has asked already
  QMap<QDockWidget*, int> wanted_widths_;  ///< px, of the docks at the sides
};

/// Shows a new window, which is deleted when it is closed.
template <class Window>
Window* new_window() {
  auto* window = new Window;
  window->setAttribute(Qt::WA_DeleteOnClose);
  window->show();
  return window;
}

}  // namespace clothlab

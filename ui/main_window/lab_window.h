// The window: the panes in the middle, parameters and charts beside them, timeline and studies below. It
// shows one document, a scene in one pane or a comparison in two to four. It owns the document and the link
// to the worker and connects its signals to the widgets.
#pragma once

#include <QMainWindow>

#include "bridge/run_link.h"
#include "charts/chart_panel.h"
#include "compare/compare_charts.h"
#include "compare/pane_grid.h"
#include "compare/ranking_panel.h"
#include "document/lab_document.h"
#include "document/save_dialog.h"
#include "main_window/transport_bar.h"
#include "params/parameter_panel.h"
#include "simulation/session.h"
#include "timeline/timeline.h"
#include "widgets/notice_bar.h"

class QScrollArea;

namespace clothlab {

class Autosave;
class ScopeTabs;
class StudiesPanel;
class ViewBar;
struct OpenedComparison;
struct OpenedScene;
struct SweptRun;

class LabWindow : public QMainWindow {
  Q_OBJECT

 public:
  explicit LabWindow(QWidget* parent = nullptr);
  ~LabWindow() override;

  // --- lab_window_files.cpp ---

  /// Opens a file of any FileType, a study's folder, or a built-in scene or comparison by its name, in place
  /// of the present document; asks first if that has unsaved changes. On error the window shows a message
  /// with place, value and rule, and nothing else changes. False if it was not opened.
  bool open(const QString& name);
  bool openScene(const QString& name);  ///< or a session, which is replayed
  bool openComparison(const QString& name);
  /// False, with a message in the window, if the file could not be written.
  bool saveTo(const QString& path);
  /// Saves the run so far with all its edits (docs/sessions.md).
  void saveSession(const QString& path);
  /// Offers what a crash has left unsaved, see Autosave.
  void offerUnsaved();
  Autosave& autosave() { return *autosave_; }
  /// Whether closing or opening another document asks about unsaved changes.
  void setAsksToSave(bool asks) { asks_to_save_ = asks; }

  /// Closes all windows. Each with unsaved changes or a running study asks first; on Cancel none is closed.
  static void quit();
  /// All windows, visible or not.
  static std::vector<LabWindow*> all();
  /// Shows a new window, which is deleted when it is closed.
  static LabWindow* showNew();

  /// Records into `folder` until the record action is switched off or the worker ends the recording.
  void startRecording(const QString& folder) { link_.send(command::StartRecording{folder.toStdString()}); }
  void showStudies();

  LabDocument& document() { return document_; }
  RunLink& simulation() { return link_; }
  ClothView& view() { return grid_->view(); }  ///< of the first pane
  PaneGrid& panes() { return *grid_; }
  ChartPanel& charts() { return *charts_; }  ///< of a scene
  CompareCharts& paneCharts() { return *pane_charts_; }
  RankingTable& ranking() { return ranking_->table(); }
  Timeline& timeline() { return *timeline_; }
  StudiesPanel& studies() { return *studies_; }
  ParameterPanel& parameters() { return *parameters_; }
  NoticeBar& notice() { return *notice_; }

 protected:
  void closeEvent(QCloseEvent* event) override;
  void dragEnterEvent(QDragEnterEvent* event) override;
  void dropEvent(QDropEvent* event) override;
  void resizeEvent(QResizeEvent* event) override;
  bool eventFilter(QObject* watched, QEvent* event) override;

 private:
  // lab_window.cpp
  void makeLayout();
  void connectDocument();
  void connectHand();
  void connectPanes();
  void connectRun();
  void play(bool on);
  void restart();
  void beginRun();
  void startRun();
  void followEdit(const SceneChange& change);
  void showDocument();
  void showKind();
  void readStability();
  void noteKeyframes();
  void brush(const cloth::BrushGust& gust);
  void addStillAir();
  void startObstacleMove(int obstacle);
  void moveObstacle(int obstacle, const cloth::Vec3& by);
  void endObstacleMove(int obstacle, bool kept);

  // lab_window_docks.cpp
  void makeDocks();
  QDockWidget* addDock(const QString& title, const char* name, Qt::DockWidgetArea area);
  void setWidths();
  void placeCorners(bool studies);

  // lab_window_follow.cpp
  void followStatus(const WorkerStatus& status);
  void followScene(const WorkerStatus& status);
  void followComparison(const WorkerStatus& status);
  void followRecording(const WorkerStatus& status);
  void followSession(const WorkerStatus& status);
  void followDivergence(const WorkerStatus& status);
  void adoptRun(const WorkerStatus& status);
  void sayDivergence(bool is_new = false);
  void forgetDivergence();
  void forgetPinch();
  std::vector<NoticeAction> helpAgainst(const cloth::Divergence& stop);
  void restartWith(std::size_t pane, const Remedy& remedy);

  // lab_window_menus.cpp
  void makeActions();
  QAction* makeAction(const char* icon_name, const QString& text, const QString& tip, const QKeySequence& key,
                      const char* name);
  void makeMenus();
  void fillFileMenu(QMenu& file);
  void makeEditMenu();
  void makeToolBar();
  void chooseScene(const QString& selected);
  void fillRecentMenu();
  void fillThemeMenu(QMenu& menu);
  void compareMethods();
  void savePicture();
  void saveCloth();

  // lab_window_points.cpp
  void openPoint(const SweptRun& run);
  void openPointInPane(const SweptRun& run);
  void showVaried(const std::string& path);
  void fitTo(const QString& file, const std::string& column);
  void chooseMeasured();
  void showMeasured();

  // lab_window_memory.cpp
  void remember();
  void recall();

  // lab_window_files.cpp
  void openWithDialog();
  bool load(const OpenedScene& opened);
  bool load(const OpenedComparison& opened);
  bool loadMesh(const QString& file);
  bool loadStudy(const QString& folder);
  void restore(const QString& file);
  void openRun(const cloth::Scene& scene, const QString& note);
  template <class Opened>
  Opened readBeside(const QString& name, Opened (*read)(const QString& name));
  std::vector<cloth::Problem> readMeshes(cloth::Scene& scene, const cloth::Scene& known);
  bool isSound(const QString& what, const QString& problems);
  QString what() const { return document_.isComparison() ? tr("comparison") : tr("scene"); }
  bool save() { return document_.path().isEmpty() ? saveAs() : saveTo(document_.path()); }
  bool saveAs();
  void saveSessionAs();
  void saveCharts();
  QString writePoints(std::function<QString(const std::stop_token&)> write);
  bool saveByDialog(const QString& what, const std::vector<FileKind>& kinds,
                    const std::function<QString(const QString& path)>& write);
  bool saySaved(const QString& what, const QString& path, const QString& problem);
  void say(const QString& kind, NoticeBar::Level level, const QString& text);
  void updateTitle();
  bool mayLoseChanges();
  bool mayStopStudy();
  bool mayClose() { return !isWaiting() && mayStopStudy() && mayLoseChanges(); }
  bool isWaiting() const;
  void comeForward();

  LabDocument document_;
  RunLink link_;

  QAction *play_, *play_again_, *step_, *reset_, *record_, *save_plots_, *save_picture_, *save_cloth_,
      *save_session_, *duplicate_;
  QAction *scenes_ = nullptr, *open_ = nullptr, *save_ = nullptr, *undo_ = nullptr, *redo_ = nullptr;
  QMenu* recent_menu_ = nullptr;

  Autosave* autosave_ = nullptr;
  PaneGrid* grid_ = nullptr;
  ParameterPanel* parameters_ = nullptr;
  ScopeTabs* scopes_ = nullptr;
  NoticeBar* notice_ = nullptr;
  ViewBar* view_bar_ = nullptr;
  Timeline* timeline_ = nullptr;
  TransportBar* transport_ = nullptr;
  ChartPanel* charts_ = nullptr;
  CompareCharts* pane_charts_ = nullptr;
  QScrollArea* pane_charts_area_ = nullptr;
  RankingPanel* ranking_ = nullptr;
  StudiesPanel* studies_ = nullptr;
  QDockWidget *parameters_dock_ = nullptr, *charts_dock_ = nullptr, *ranking_dock_ = nullptr,
              *studies_dock_ = nullptr;
  QMap<QDockWidget*, int> wanted_widths_;  ///< px, of the docks at the sides

  bool asks_to_save_ = true;
  bool may_close_ = false;         ///< quit() has asked already
  bool shows_comparison_ = false;  ///< what the widgets are arranged for
  WorkerStatus shown_status_;
  std::optional<cloth::Divergence> divergence_;  ///< until the run is past it or starts again
  std::int64_t divergences_ = 0;                 ///< how many were shown
  std::shared_ptr<const cloth::Comparison>
      followed_;                            ///< the worker's content that the document adopted last
  std::optional<cloth::Session> session_;   ///< a session to be opened instead of the document's scene
  QString saving_session_;                  ///< the file, until it is written
  bool paused_again_ = false;               ///< paused while it was playing again: Play goes on so
  std::optional<cloth::Obstacle> dragged_;  ///< the dragged obstacle as it was before the drag
};

/// Opens the first window of the program with what `name` names; with the default scene if `name` is empty or
/// cannot be opened.
void open_first_window(const QString& name);

}  // namespace clothlab

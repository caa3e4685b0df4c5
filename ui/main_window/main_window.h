// The window of one scene: the view in the middle, parameters and charts beside it. It owns the document and
// the worker's link and connects their signals to the widgets.
#pragma once

#include "bridge/worker_link.h"
#include "charts/chart_panel.h"
#include "document/lab_document.h"
#include "main_window/lab_window.h"
#include "timeline/timeline.h"
#include "viewport/cloth_view.h"

namespace clothlab {

class StudiesPanel;
class ViewBar;

class MainWindow : public LabWindow {
  Q_OBJECT

 public:
  explicit MainWindow(QWidget* parent = nullptr);
  ~MainWindow() override { deleteWidgets(); }

  /// Replaces the present scene; asks first if that has unsaved changes. A session is replayed.
  void load(const OpenedScene& opened) override;
  /// Opens the comparison in a new window.
  void load(const OpenedComparison& opened) override;
  void loadStudy(const QString& folder) override;

  /// Saves the run so far with all its edits (docs/sessions.md).
  void saveSession(const QString& path);

  LabDocument& document() { return document_; }
  SimulationLink& simulation() { return link_; }
  ClothView& view() { return *view_; }
  ChartPanel& charts() { return *charts_; }
  Timeline& timeline() { return *timeline_; }
  StudiesPanel& studies() { return *studies_; }
  void showStudies();

 protected:
  void closeEvent(QCloseEvent* event) override;

 private:
  // main_window.cpp
  void send(const RunCommand& command) override;
  QString write(const QString& path) override;
  const cloth::Scene& scene() override { return document_.scene(); }
  void togglePin(int row, int column) override { document_.togglePin(row, column); }
  void offerAir(const QString& text) override;
  void play(bool on) override;
  void restart() override;
  void makeLayout();
  void connectDocument();
  void connectView();
  void connectSimulation();
  void followChange(const SceneChange& change);
  void startSimulation();
  void readStability();
  void takeStableStep() { document_.setParameter("integrator.time_step", std::string("auto")); }
  void startObstacleMove(int obstacle);
  void moveObstacle(int obstacle, const cloth::Vec3& by);
  void endObstacleMove(int obstacle, bool kept);
  void noteKeyframes();
  void addStillAir();
  bool mayStopStudy();
  bool mayClose() override { return mayStopStudy() && LabWindow::mayClose(); }
  void openRun(const cloth::Scene& scene, const QString& note);

  // main_window_follow.cpp
  void followStatus(const WorkerStatus& status);
  void followScene(const WorkerStatus& status);
  void followSession(const WorkerStatus& status);
  void followDivergence(const WorkerStatus& status);
  void sayDivergence(bool is_new = false);
  void forgetDivergence();
  void forgetPinch();
  std::vector<NoticeAction> helpAgainst(const cloth::Divergence& stop);

  // main_window_menus.cpp
  void makeActions();
  void makeMenus();
  void makeToolBar(QMenu* builtin);
  void fillRecentMenu();
  void saveSessionAs();
  void compareMethods();
  void savePicture();
  void saveCloth();
  void showAbout();

  LabDocument& document_;
  SimulationLink link_;
  ClothView* view_ = nullptr;
  ChartPanel* charts_ = nullptr;
  StudiesPanel* studies_ = nullptr;
  QDockWidget* studies_dock_ = nullptr;
  Timeline* timeline_ = nullptr;
  ViewBar* view_bar_ = nullptr;
  QMenu* recent_menu_ = nullptr;

  QAction* play_again_ = nullptr;
  QAction* save_picture_ = nullptr;
  QAction* save_cloth_ = nullptr;

  WorkerStatus shown_status_;
  std::optional<cloth::Divergence> divergence_;   ///< until the run is past it or starts again
  std::int64_t divergences_ = 0;                  ///< how many were shown
  std::shared_ptr<const cloth::Scene> followed_;  ///< the worker's scene that the document adopted last
  std::optional<cloth::Session> session_;         ///< a session to be opened instead of the document's scene
  QString saving_session_;                        ///< the file, until it is written
  bool paused_again_ = false;                     ///< paused while it was playing again: Play goes on so
  std::optional<cloth::Obstacle> dragged_;        ///< the dragged obstacle as it was before the drag
};

/// Opens the first window of the program: of a comparison if `name` is a valid one, else of a scene; of the
/// default scene if `name` is empty or cannot be opened.
void open_first_window(const QString& name);

}  // namespace clothlab

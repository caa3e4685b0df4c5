// The window: the view in the middle, parameters and charts beside it, the worker behind it. It connects the
// rooms and decides nothing that one of them could.
#pragma once

#include <QMainWindow>
#include <QPointer>

#include "bridge/worker_link.h"
#include "charts/chart_panel.h"
#include "document/lab_document.h"
#include "main_window/transport_bar.h"
#include "params/parameter_panel.h"
#include "timeline/timeline.h"
#include "viewport/cloth_view.h"
#include "widgets/notice_bar.h"

class QDockWidget;
class QMenu;

namespace clothlab {

struct OpenedScene;
class StudiesPanel;
class ViewBar;

class MainWindow : public QMainWindow {
  Q_OBJECT

 public:
  explicit MainWindow(QWidget* parent = nullptr);
  ~MainWindow() override;

  /// A scene's or a session's file or the name of a built-in scene; a session is played. What cannot be
  /// opened is said in the window, and the scene before stays.
  void openScene(const QString& name);

  /// Records into `folder` until the record action is switched off.
  void startRecording(const QString& folder);

  /// The run so far, with everything that was done to it (docs/sessions.md).
  void saveSession(const QString& path);

  /// Whether closing or opening another scene asks about unsaved changes.
  void setAsksToSave(bool asks) { asks_to_save_ = asks; }

  LabDocument& document() { return document_; }
  SimulationLink& simulation() { return link_; }
  ClothView& view() { return *view_; }
  ChartPanel& charts() { return *charts_; }
  ParameterPanel& parameters() { return *parameters_; }
  NoticeBar& notice() { return *notice_; }
  Timeline& timeline() { return *timeline_; }
  StudiesPanel& studies() { return *studies_; }
  void showStudies();

 protected:
  void closeEvent(QCloseEvent* event) override;
  void dragEnterEvent(QDragEnterEvent* event) override;
  void dropEvent(QDropEvent* event) override;

 private:
  // main_window.cpp
  void makeLayout();
  void connectDocument();
  void connectView();
  void connectSimulation();
  void takeScene(const OpenedScene& opened);
  void followChange(const SceneChange& change);
  void startSimulation();
  void restart();
  void play(bool on);
  void readStability();
  void takeStableStep();
  void brush(const cloth::BrushGust& gust);
  void startObstacleMove(int obstacle);
  void moveObstacle(int obstacle, const cloth::Vec3& by);
  void endObstacleMove(int obstacle, bool kept);
  void noteKeyframes();
  void addStillAir();
  bool hasAir() const;
  void updateTitle();
  bool mayLoseChanges();
  bool mayStopStudy();
  void openRun(const cloth::Scene& scene, const QString& note);

  // main_window_follow.cpp
  void followStatus(const WorkerStatus& status);
  void followScene(const WorkerStatus& status);
  void followSession(const WorkerStatus& status);
  void followDivergence(const WorkerStatus& status);
  void sayPinched(const cloth::Divergence& stop);
  void forgetPinch();

  // main_window_menus.cpp
  void makeActions();
  void makeMenus();
  void fillRecentMenu();
  void openWithDialog();
  bool save();
  bool saveAs();
  void saveSessionAs();
  void compareMethods();
  void openComparison();
  void savePicture();
  void saveCloth();
  void toggleRecording(bool on);
  void showAbout();

  LabDocument document_;
  SimulationLink link_;
  ClothView* view_ = nullptr;
  ChartPanel* charts_ = nullptr;
  ParameterPanel* parameters_ = nullptr;
  NoticeBar* notice_ = nullptr;
  StudiesPanel* studies_ = nullptr;
  QDockWidget* studies_dock_ = nullptr;
  TransportBar* transport_ = nullptr;
  Timeline* timeline_ = nullptr;
  ViewBar* view_bar_ = nullptr;
  QMenu* recent_menu_ = nullptr;

  QAction* play_ = nullptr;
  QAction* play_again_ = nullptr;
  QAction* step_ = nullptr;
  QAction* reset_ = nullptr;
  QAction* record_ = nullptr;
  QAction* save_picture_ = nullptr;
  QAction* save_cloth_ = nullptr;
  QAction* save_plots_ = nullptr;

  WorkerStatus shown_status_;
  std::shared_ptr<const cloth::Scene> followed_;  ///< the worker's scene that the document knows
  std::optional<cloth::Session> session_;         ///< to be opened in the place of the document's scene
  QString saving_session_;                        ///< the file, until it is written
  bool paused_again_ = false;                     ///< paused while it was playing again: Play goes on so
  std::optional<cloth::Obstacle> dragged_;        ///< an obstacle, as it was before the hand took it
  bool asks_to_save_ = true;
};

}  // namespace clothlab

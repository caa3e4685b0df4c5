// The window of a comparison: two to four panes of one scene side by side, the form with what they share and
// what each has of its own, charts over all of them, and their ranking.
#pragma once

#include <QMainWindow>

#include "bridge/worker_link.h"
#include "compare/compare_charts.h"
#include "compare/compare_document.h"
#include "compare/pane_grid.h"
#include "compare/ranking_table.h"
#include "params/parameter_panel.h"
#include "widgets/notice_bar.h"
#include "widgets/reading.h"

class QActionGroup;
class QComboBox;
class QLabel;
class QTabBar;

namespace clothlab {

class CompareWindow : public QMainWindow {
  Q_OBJECT

 public:
  explicit CompareWindow(QWidget* parent = nullptr);
  ~CompareWindow() override;

  /// A file or the name of a built-in comparison. What cannot be opened is said in the window, and the
  /// comparison before stays.
  void openComparison(const QString& name);
  /// The scene run by its own method and by two others.
  void compareScene(const cloth::Scene& scene);

  /// Records into `folder` until the record action is switched off or the duration is over.
  void startRecording(const QString& folder);

  /// Whether closing or opening asks about unsaved changes.
  void setAsksToSave(bool asks) { asks_to_save_ = asks; }

  CompareDocument& document() { return document_; }
  CompareLink& simulation() { return link_; }
  PaneGrid& panes() { return *grid_; }
  CompareCharts& charts() { return *charts_; }
  RankingTable& ranking() { return *ranking_; }
  ParameterPanel& parameters() { return *parameters_; }
  NoticeBar& notice() { return *notice_; }

  bool saveTo(const QString& path);

 protected:
  void closeEvent(QCloseEvent* event) override;

 private:
  // compare_window.cpp
  void makeLayout();
  void makeScopeTabs();
  void connectDocument();
  void connectPanes();
  void connectSimulation();
  void followDocument();
  void followStatus(const CompareStatus& status);
  void showScope();
  void showOwnership();
  void showReferences();
  void chooseReference(int index);
  void takeComparison(cloth::Comparison comparison, const QString& path, bool unsaved);
  void setColouring(ViewMode mode, Colouring colouring);
  void brush(const cloth::BrushGust& gust);
  bool mayLoseChanges();
  void updateTitle();

  // compare_window_menus.cpp
  void makeActions();
  void makeMenus();
  void makeViewBar();
  void makeTransport();
  void openWithDialog();
  bool save();
  bool saveAs();
  void toggleRecording(bool on);

  CompareDocument document_;
  CompareLink link_;
  PaneGrid* grid_ = nullptr;
  CompareCharts* charts_ = nullptr;
  RankingTable* ranking_ = nullptr;
  ParameterPanel* parameters_ = nullptr;
  NoticeBar* notice_ = nullptr;
  QTabBar* scopes_ = nullptr;
  QLabel* scope_hint_ = nullptr;
  QComboBox* reference_ = nullptr;
  QComboBox* speed_ = nullptr;
  Reading* time_ = nullptr;
  Reading* rate_ = nullptr;
  QAction* play_ = nullptr;
  QAction* step_ = nullptr;
  QAction* reset_ = nullptr;
  QAction* record_ = nullptr;

  CompareStatus shown_status_;
  QElapsedTimer ranking_clock_;  ///< since the table was filled last
  bool asks_to_save_ = true;
};

}  // namespace clothlab

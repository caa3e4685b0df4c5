// The window of a comparison: two to four panes of one scene side by side, a form for shared values and for
// each pane's own values, common charts, and the ranking.
#pragma once

#include "bridge/worker_link.h"
#include "compare/compare_charts.h"
#include "compare/compare_document.h"
#include "compare/pane_grid.h"
#include "compare/ranking_table.h"
#include "main_window/lab_window.h"

class QComboBox;
class QLabel;
class QTabBar;

namespace clothlab {

class CompareWindow : public LabWindow {
  Q_OBJECT

 public:
  explicit CompareWindow(QWidget* parent = nullptr);
  ~CompareWindow() override { deleteWidgets(); }

  /// Opens the scene in a new window.
  void load(const OpenedScene& opened) override;
  /// Replaces the present comparison; asks first if that has unsaved changes.
  void load(const OpenedComparison& opened) override;
  /// Opens the study in a new window.
  void loadStudy(const QString& folder) override;
  /// Compares the scene's own method with two others.
  void compareScene(const cloth::Scene& scene);

  CompareDocument& document() { return document_; }
  CompareLink& simulation() { return link_; }
  PaneGrid& panes() { return *grid_; }
  CompareCharts& charts() { return *charts_; }
  RankingTable& ranking() { return *ranking_; }

 private:
  void send(const RunCommand& command) override;
  void loadMesh(const QString& file) override;
  QString write(const QString& path) override;
  const cloth::Scene& scene() override { return document_.comparison().scene; }
  void togglePin(int row, int column) override { document_.togglePin(row, column); }
  void offerAir(const QString& text) override;
  void play(bool on) override;
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
  void setColouring(ViewMode mode, Colouring colouring);
  void makeMenus();
  void makeViewBar();

  CompareDocument& document_;
  CompareLink link_;
  PaneGrid* grid_ = nullptr;
  CompareCharts* charts_ = nullptr;
  RankingTable* ranking_ = nullptr;
  QTabBar* scopes_ = nullptr;
  QLabel* scope_hint_ = nullptr;
  QComboBox* reference_ = nullptr;

  CompareStatus shown_status_;
  QElapsedTimer ranking_clock_;  ///< time since the table was last filled
};

}  // namespace clothlab

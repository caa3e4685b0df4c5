// The ranking of a comparison's panes, and above it what their differences are measured from.
#pragma once

#include <QElapsedTimer>
#include <QWidget>

#include "bridge/worker_status.h"
#include "compare/ranking_table.h"

class QComboBox;

namespace clothlab {

class RankingPanel : public QWidget {
  Q_OBJECT

 public:
  explicit RankingPanel(QWidget* parent = nullptr);

  /// The references to choose from, and the comparison's own.
  void showComparison(const cloth::Comparison& comparison);
  /// While it plays, the table is filled a few times a second.
  void showResults(const WorkerStatus& status);
  RankingTable& table() { return *table_; }

 Q_SIGNALS:
  void referenceChosen(const std::string& reference);

 private:
  QComboBox* reference_;
  RankingTable* table_;
  double shown_time_ = -1;       ///< s, of the table
  QElapsedTimer since_results_;  ///< since the table was last filled
};

}  // namespace clothlab

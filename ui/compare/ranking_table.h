// The panes ranked by error and by cost. Click on a head to sort by another column; Ctrl+C copies the table
// as text with tabs: numbers with decimal points, units in the heads.
#pragma once

#include <QTableWidget>

#include "compare/ranking.h"

namespace clothlab {

class RankingTable : public QTableWidget {
  Q_OBJECT

 public:
  explicit RankingTable(QWidget* parent = nullptr);

  void showResults(const std::vector<cloth::PaneResult>& results);
  QString asText() const;
  void copy() const;

  QSize sizeHint() const override { return {640, 170}; }

 protected:
  void keyPressEvent(QKeyEvent* event) override;
  void changeEvent(QEvent* event) override;

 private:
  std::vector<cloth::PaneResult> results_;
};

}  // namespace clothlab

#include "compare/ranking_table.h"

#include <QClipboard>
#include <QGuiApplication>
#include <QHeaderView>
#include <QKeyEvent>
#include <QStyledItemDelegate>
#include <limits>

#include "compare/pane_style.h"
#include "widgets/numbers.h"

namespace clothlab {
namespace {

constexpr double last = std::numeric_limits<double>::infinity();  // what is missing sorts behind all values

constexpr int copied_digits = 9;
constexpr int key_role = Qt::UserRole, style_role = Qt::UserRole + 1;

enum Column {
  pane,
  method,
  by_error,
  rms,
  largest,
  by_cost,
  cost,
  step,
  rms_over_time,
  evaluations,
  columns
};

struct Cell {
  QString text;
  double key;
};

Cell number(double value, int digits = 3) {
  return {number_text(value, digits), value};
}

/// The key is in the unit of the copied table, thousandths of the shown one.
Cell quantity(double value, const std::string& unit, int digits = 3) {
  return {quantity_text(value, unit, digits), 1e3 * value};
}

Cell metres(const std::optional<double>& value, bool is_reference) {
  if (is_reference) return {RankingTable::tr("reference"), -1};
  return value ? quantity(*value, "m") : Cell{QStringLiteral("–"), last};
}

Cell rank_cell(int rank) {
  return rank > 0 ? Cell{QString::number(rank), static_cast<double>(rank)} : Cell{QStringLiteral("–"), last};
}

Cell cell_of(const cloth::PaneResult& r, int column, std::size_t place) {
  switch (column) {
    case pane:
      return {QString::fromStdString(r.name), static_cast<double>(r.style)};
    case method:
      return {QString::fromStdString(r.title), static_cast<double>(place)};
    case step:
      return quantity(r.time_step, "s", 4);
    case rms:
      return metres(r.rms, r.is_reference);
    case largest:
      return metres(r.largest, r.is_reference);
    case rms_over_time:
      return metres(r.rms_over_time, r.is_reference);
    case by_error: {
      if (r.divergence) return {RankingTable::tr("stopped"), last};
      if (r.is_reference) return {QStringLiteral("–"), 0};
      return rank_cell(r.error_rank);
    }
    case cost:
      return r.simulated > 0 ? number(r.cost()) : Cell{QStringLiteral("–"), last};
    case by_cost:
      return rank_cell(r.cost_rank);
    default:
      return {count_text(r.evaluations_each_second()), r.evaluations_each_second()};
  }
}

/// Sorts by a number behind the text.
class KeyedItem : public QTableWidgetItem {
 public:
  bool operator<(const QTableWidgetItem& other) const override {
    return data(key_role).toDouble() < other.data(key_role).toDouble();
  }
};

/// The unit stands behind the number in a right-to-left layout too.
class NumberDelegate : public QStyledItemDelegate {
 public:
  using QStyledItemDelegate::QStyledItemDelegate;

 protected:
  void initStyleOption(QStyleOptionViewItem* option, const QModelIndex& index) const override {
    QStyledItemDelegate::initStyleOption(option, index);
    if (index.column() > method) option->direction = Qt::LeftToRight;
  }
};

}  // namespace

RankingTable::RankingTable(QWidget* parent) : QTableWidget(parent) {
  setObjectName("rankingTable");
  setAccessibleName(tr("Panes ranked by error and by cost"));
  setColumnCount(columns);
  setItemDelegate(new NumberDelegate(this));
  setHorizontalHeaderLabels({tr("Pane"), tr("Method"), tr("By error"), tr("RMS"), tr("Largest"),
                             tr("By cost"), tr("Cost [s/s]"), tr("Step"), tr("Over time"),
                             tr("Evaluations/s")});
  const QString tips[columns] = {
      {},
      {},
      tr("Rank by the RMS difference now"),
      tr("Root of the mean squared distance of all particles from the reference, now"),
      tr("The largest of these distances, now"),
      tr("Rank by cost"),
      tr("Seconds of stepping for each simulated second"),
      tr("As run: a step divides the record interval"),
      tr("Root of the mean of the squared RMS difference over the times so far"),
      tr("Evaluations of the force for each simulated second")};
  for (int c = 0; c < columns; ++c) horizontalHeaderItem(c)->setToolTip(tips[c]);
  verticalHeader()->hide();
  verticalHeader()->setDefaultSectionSize(26);
  horizontalHeader()->setSectionResizeMode(QHeaderView::ResizeToContents);
  horizontalHeader()->setHighlightSections(false);
  horizontalHeader()->setMinimumSectionSize(24);
  setEditTriggers(NoEditTriggers);
  setSelectionBehavior(SelectRows);
  setShowGrid(false);
  setFrameShape(NoFrame);
  setWordWrap(false);
  setSortingEnabled(true);
  sortByColumn(by_error, Qt::AscendingOrder);
}

void RankingTable::showResults(const std::vector<cloth::PaneResult>& results) {
  results_ = results;
  setSortingEnabled(false);  // rows must not move while they are filled
  if (rowCount() != static_cast<int>(results.size())) setRowCount(static_cast<int>(results.size()));
  const std::vector<std::size_t> order = cloth::ranked(results);
  for (std::size_t row = 0; row < order.size(); ++row) {
    const cloth::PaneResult& result = results[order[row]];
    for (int column = 0; column < columns; ++column) {
      QTableWidgetItem* shown = item(static_cast<int>(row), column);
      if (!shown) {
        shown = new KeyedItem;
        shown->setTextAlignment(column <= method ? Qt::AlignLeft | Qt::AlignVCenter
                                                 : Qt::AlignRight | Qt::AlignVCenter);
        setItem(static_cast<int>(row), column, shown);
      }
      const Cell cell = cell_of(result, column, order[row]);
      const QColor colour = result.divergence ? theme().error : theme().text;
      // What an item is told it tells the view, new or not.
      if (shown->text() != cell.text) shown->setText(cell.text);
      if (shown->data(key_role) != cell.key) shown->setData(key_role, cell.key);
      if (shown->foreground() != colour) shown->setForeground(colour);
      if (column != pane || shown->data(style_role) == result.style) continue;
      shown->setData(style_role, result.style);
      shown->setIcon(pane_icon(result.style));
    }
  }
  setSortingEnabled(true);
}

QString RankingTable::asText() const {
  QStringList lines, head;
  for (int c = 0; c < columns; ++c) {
    const bool is_length = c == rms || c == largest || c == rms_over_time;
    head << horizontalHeaderItem(c)->text() + (is_length ? " [mm]" : c == step ? " [ms]" : "");
  }
  lines << head.join('\t');
  for (int row = 0; row < rowCount(); ++row) {
    QStringList cells;
    for (int c = 0; c < columns; ++c) {
      const QString text = item(row, c)->text();
      const bool is_number = c > method && text.at(0).isDigit();
      cells << (is_number ? QString::number(item(row, c)->data(key_role).toDouble(), 'g', copied_digits)
                          : text);
    }
    lines << cells.join('\t');
  }
  return lines.join('\n') + '\n';
}

void RankingTable::copy() const {
  QGuiApplication::clipboard()->setText(asText());
}

void RankingTable::keyPressEvent(QKeyEvent* event) {
  if (event->matches(QKeySequence::Copy)) return copy();
  QTableWidget::keyPressEvent(event);
}

void RankingTable::changeEvent(QEvent* event) {
  QTableWidget::changeEvent(event);
  if (event->type() != QEvent::PaletteChange || results_.empty()) return;
  setRowCount(0);  // icons and colours of the look before
  showResults(std::vector<cloth::PaneResult>(results_));
}

}  // namespace clothlab

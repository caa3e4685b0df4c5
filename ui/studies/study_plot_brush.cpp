// StudyPlot: ranges on the axes of parallel coordinates, by the pointer and by keys.
#include <QKeyEvent>
#include <QMouseEvent>
#include <QToolTip>
#include <algorithm>
#include <cmath>
#include <utility>

#include "studies/study_plot.h"
#include "theme/theme.h"
#include "widgets/numbers.h"

namespace clothlab {
namespace {

constexpr double grip = cloth::parallel_bar_width / 2 + 1, beyond_end = 6;  // px around an axis
constexpr double least_drag = 3;                                            // px; less is a click
constexpr double key_step = 0.05;                                           // of an axis

bool has_same_columns(const cloth::PointTable& a, const cloth::PointTable& b) {
  return std::equal(a.columns.begin(), a.columns.end(), b.columns.begin(), b.columns.end(),
                    [](const cloth::PointColumn& one, const cloth::PointColumn& other) {
                      return one.axis.label == other.axis.label && one.axis.unit == other.axis.unit;
                    });
}

double place_on(const cloth::ParallelAxis& axis, double value) {
  const bool shown = can_show(axis.map.scale(), value);
  return shown ? std::clamp(axis.map.place(value), axis.top, axis.bottom) : axis.bottom;
}

}  // namespace

cloth::ParallelCoordinates* StudyPlot::lines() {
  return std::get_if<cloth::ParallelCoordinates>(&diagram_);
}

std::vector<cloth::AxisBrush> StudyPlot::brushes() const {
  const auto* lines = std::get_if<cloth::ParallelCoordinates>(&diagram_);
  return lines ? lines->brushes : std::vector<cloth::AxisBrush>();
}

/// A diagram that fills, or that has other colours, has the same columns.
void StudyPlot::keepBrushes(Diagram& next) {
  auto* after = std::get_if<cloth::ParallelCoordinates>(&next);
  const auto* before = lines();
  if (after && before && has_same_columns(before->table, after->table)) {
    after->brushes = before->brushes;
  } else {
    drag_.reset();
    chosen_axis_ = -1;
  }
}

void StudyPlot::clearBrushes() {
  drag_.reset();
  chosen_axis_ = -1;
  auto* all = lines();
  if (!all || all->brushes.empty()) return;
  all->brushes.clear();
  showBrushes();
}

QRectF StudyPlot::placeOfAxis(std::size_t column) const {
  const_cast<StudyPlot*>(this)->refresh();
  if (column >= axes_.size()) return {};
  const cloth::ParallelAxis& axis = axes_[column];
  return {axis.x - cloth::parallel_bar_width / 2, axis.top, cloth::parallel_bar_width,
          axis.bottom - axis.top};
}

/// -1: none.
int StudyPlot::axisAt(QPointF at) const {
  for (std::size_t column = 0; column < axes_.size(); ++column) {
    const cloth::ParallelAxis& axis = axes_[column];
    if (std::abs(at.x() - axis.x) <= grip && at.y() >= axis.top - beyond_end &&
        at.y() <= axis.bottom + beyond_end)
      return static_cast<int>(column);
  }
  return -1;
}

const cloth::AxisBrush* StudyPlot::brushOf(std::size_t column) const {
  const auto* all = std::get_if<cloth::ParallelCoordinates>(&diagram_);
  if (!all) return nullptr;
  const auto found = std::find_if(all->brushes.begin(), all->brushes.end(),
                                  [column](const auto& brush) { return brush.column == column; });
  return found == all->brushes.end() ? nullptr : &*found;
}

/// nullopt: none.
void StudyPlot::setBrush(std::size_t column, std::optional<cloth::AxisBrush> brush) {
  auto& brushes = lines()->brushes;
  std::erase_if(brushes, [column](const auto& each) { return each.column == column; });
  if (brush) brushes.push_back(*brush);
  showBrushes();
}

/// Drawn at the next painting, once for all moves of the pointer since the last.
void StudyPlot::showBrushes() {
  stale_ = true;
  const auto* all = lines();
  const QString words = all->brushes.empty() ? QString() : QString::fromStdString(kept_words(*all));
  setAccessibleDescription(words);
  Q_EMIT runHovered(words);
  update();
}

bool StudyPlot::beginDrag(const QMouseEvent& event) {
  const int axis = axisAt(event.position());
  if (event.button() != Qt::LeftButton || axis < 0) return false;
  const auto column = static_cast<std::size_t>(axis);
  const auto* before = brushOf(column);
  drag_ = BrushDrag{column, event.position().y(), axes_[column].map.value_at(event.position().y()),
                    before ? std::optional(*before) : std::nullopt};
  chosen_axis_ = axis;
  shows_choice_ = false;
  QToolTip::hideText();
  update();
  return true;
}

/// The end where it began is a value: the axis may get another range meanwhile.
void StudyPlot::drag(double y) {
  if (std::abs(y - drag_->from) <= least_drag) return setBrush(drag_->column, drag_->before);
  const double value = axes_[drag_->column].map.value_at(y);
  setBrush(drag_->column,
           cloth::AxisBrush{drag_->column, std::min(value, drag_->value), std::max(value, drag_->value)});
}

void StudyPlot::endDrag(double y) {
  const BrushDrag done = *drag_;
  if (std::abs(y - done.from) <= least_drag)
    setBrush(done.column, std::nullopt);  // a click
  else
    drag(y);
  drag_.reset();
}

QString StudyPlot::axisWords(std::size_t column) const {
  const cloth::Axis& axis = std::get<cloth::ParallelCoordinates>(diagram_).table.columns[column].axis;
  const QString name = QString::fromStdString(axis.label);
  const cloth::AxisBrush* brush = brushOf(column);
  if (!brush) return tr("%1: all values").arg(name);
  return tr("%1 from %2 to %3: %4")
      .arg(name, quantity_text(brush->low, axis.unit, 3), quantity_text(brush->high, axis.unit, 3),
           QString::fromStdString(kept_words(std::get<cloth::ParallelCoordinates>(diagram_))));
}

void StudyPlot::hoverAxis(std::size_t column, QPointF at) {
  mark(nullptr);
  over_axis_ = true;
  setCursor(Qt::SizeVerCursor);
  const QString words = axisWords(column);
  QToolTip::showText(
      mapToGlobal(at.toPoint()),
      "<p style='white-space: pre'>" + words.toHtmlEscaped() +
          tr("<br><i>Drag along the axis to pick runs, click to let all pass</i>"
             "<br><i>Keys: ← → axis, Shift ↑ ↓ upper end, Ctrl ↑ ↓ lower end, Delete, Escape</i>"),
      this, placeOfAxis(column).toAlignedRect());
  Q_EMIT runHovered(words);
}

void StudyPlot::leaveAxis() {
  if (!std::exchange(over_axis_, false)) return;
  setCursor(Qt::ArrowCursor);
  QToolTip::hideText();
  Q_EMIT runHovered({});
}

void StudyPlot::chooseAxis(int step) {
  const int count = static_cast<int>(axes_.size());
  if (count == 0) return;
  chosen_axis_ =
      chosen_axis_ < 0 ? (step > 0 ? 0 : count - 1) : std::clamp(chosen_axis_ + step, 0, count - 1);
  shows_choice_ = true;
  const QString words = axisWords(static_cast<std::size_t>(chosen_axis_));
  setAccessibleDescription(words);
  Q_EMIT runHovered(tr("%1. Shift ↑ ↓ moves the upper end, Ctrl ↑ ↓ the lower end").arg(words));
  update();
}

/// Moves an end of the chosen axis' range by a part of the axis, upwards where positive. Where there is no
/// range it is that of the whole axis.
void StudyPlot::moveEnd(bool upper, double part) {
  shows_choice_ = true;
  const auto column = static_cast<std::size_t>(chosen_axis_);
  const cloth::ParallelAxis& axis = axes_[column];
  const auto* now = brushOf(column);
  cloth::AxisBrush brush = now ? *now : cloth::AxisBrush{column, axis.map.low(), axis.map.high()};
  double& end = upper ? brush.high : brush.low;
  const double moved = axis.map.value_at(place_on(axis, end) - part * (axis.bottom - axis.top));
  end = upper ? std::max(moved, brush.low) : std::min(moved, brush.high);
  setBrush(column, brush);
  const QString words = axisWords(column);
  setAccessibleDescription(words);
  Q_EMIT runHovered(words);
}

/// False: the key is for something else.
bool StudyPlot::takeBrushKey(const QKeyEvent& event) {
  if (!lines()) return false;
  const auto modifiers = event.modifiers() & ~Qt::KeypadModifier;
  const bool vertical = event.key() == Qt::Key_Up || event.key() == Qt::Key_Down;
  if (event.key() == Qt::Key_Left || event.key() == Qt::Key_Right) {
    chooseAxis(event.key() == Qt::Key_Right ? 1 : -1);
  } else if (vertical && (modifiers == Qt::ShiftModifier || modifiers == Qt::ControlModifier)) {
    if (chosen_axis_ < 0) chooseAxis(1);
    if (chosen_axis_ >= 0)
      moveEnd(modifiers == Qt::ShiftModifier, event.key() == Qt::Key_Up ? key_step : -key_step);
  } else if (event.key() == Qt::Key_Delete || event.key() == Qt::Key_Backspace) {
    if (chosen_axis_ >= 0) setBrush(static_cast<std::size_t>(chosen_axis_), std::nullopt);
  } else if (event.key() == Qt::Key_Escape && drag_) {
    const BrushDrag left = *drag_;
    drag_.reset();
    setBrush(left.column, left.before);
  } else if (event.key() == Qt::Key_Escape && !lines()->brushes.empty()) {
    clearBrushes();
  } else {
    return false;
  }
  return true;
}

void StudyPlot::paintChosenAxis(QPainter& painter) const {
  if (chosen_axis_ < 0 || !shows_choice_) return;
  painter.setPen(QPen(theme().accent, 2));
  painter.drawRoundedRect(placeOfAxis(static_cast<std::size_t>(chosen_axis_)).adjusted(-3, -3, 3, 3), 3, 3);
}

}  // namespace clothlab

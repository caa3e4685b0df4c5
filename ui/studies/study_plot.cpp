#include "studies/study_plot.h"

#include <QBuffer>
#include <QEvent>
#include <QKeyEvent>
#include <QMouseEvent>
#include <QPdfWriter>
#include <QStyle>
#include <QToolTip>
#include <algorithm>
#include <cmath>
#include <utility>

#include "document/result_files.h"
#include "theme/theme.h"
#include "widgets/building.h"
#include "widgets/numbers.h"

namespace clothlab {
namespace {

constexpr double reach = 5;  // px around a shape that still count as on it
constexpr double smallest_width = 480, lowest_plot = 130, lowest_panel = 110, narrowest_panel = 170;  // px
constexpr double beside_panels = 90;                                                                  // px
constexpr double export_scale = 2;                   // of a PNG
constexpr double label_size = 13, beyond_axis = 60;  // px, of a label and how far it may go beyond its axis

double height_of(const Diagram& diagram) {
  return std::visit([](const auto& plot) { return cloth::height_of(plot); }, diagram);
}

double width_of(const Diagram& diagram) {
  return std::visit([](const auto& plot) { return plot.width; }, diagram);
}

void draw(cloth::PlotCanvas& canvas, const Diagram& diagram) {
  std::visit([&](const auto& plot) { cloth::draw(canvas, plot); }, diagram);
}

/// The largest value of `set` in [low, high] for which the diagram is no higher than `height`.
template <class Set>
void fill_height(Diagram& diagram, double low, double high, double height, Set set) {
  for (int k = 0; k < 14; ++k) {
    const double middle = (low + high) / 2;
    set(middle);
    (height_of(diagram) <= height ? low : high) = middle;
  }
  set(low);
}

void fit(Diagram& diagram, QSizeF room) {
  if (auto* plot = std::get_if<cloth::LinePlot>(&diagram)) {
    plot->width = room.width();
    fill_height(diagram, lowest_plot, room.height(), room.height(), [&](double h) { plot->plot_height = h; });
    // Beside a low plot there is no room for what qualifies the label: the files have it.
    if (cloth::text_width(plot->y.label, label_size) > plot->plot_height + beyond_axis)
      plot->y.label = plot->y.label.substr(0, plot->y.label.find(','));
  } else if (auto* map = std::get_if<cloth::HeatMap>(&diagram)) {
    map->width = room.width();
    const int panels = std::max(1, static_cast<int>(map->panels.size()));
    int best = 1;
    double best_size = 0;
    for (int columns = 1; columns <= panels; ++columns) {
      map->columns = columns;
      fill_height(diagram, 60, room.height(), room.height(), [&](double h) { map->highest = h; });
      const double size = std::min(room.width() / columns, 1.6 * map->highest);
      if (size > best_size) best_size = size, best = columns;
    }
    map->columns = best;
    fill_height(diagram, 60, room.height(), room.height(), [&](double h) { map->highest = h; });
  } else if (auto* lines = std::get_if<cloth::ParallelCoordinates>(&diagram)) {
    lines->width = room.width();
    fill_height(diagram, lowest_plot, room.height(), room.height(),
                [&](double h) { lines->plot_height = h; });
  } else {
    std::get<cloth::CategoryMap>(diagram).width = room.width();
  }
}

/// The least height at which a diagram of this width can be read.
double lowest(Diagram diagram, double width) {
  if (auto* plot = std::get_if<cloth::LinePlot>(&diagram)) {
    plot->width = width;
    plot->plot_height = lowest_plot;
  } else if (auto* map = std::get_if<cloth::HeatMap>(&diagram)) {
    map->width = width;
    map->highest = lowest_panel;
    const int panels = std::max(1, static_cast<int>(map->panels.size()));
    map->columns = std::clamp(static_cast<int>((width - beside_panels) / narrowest_panel), 1, panels);
  } else if (auto* lines = std::get_if<cloth::ParallelCoordinates>(&diagram)) {
    lines->width = width;
    lines->plot_height = lowest_plot;
  } else {
    std::get<cloth::CategoryMap>(diagram).width = width;
  }
  return height_of(diagram);
}

/// As it goes onto the screen, where the panel around it has the title.
Diagram for_screen(Diagram diagram) {
  std::visit([](auto& plot) { plot.title.clear(), plot.subtitle.clear(); }, diagram);
  if (auto* plot = std::get_if<cloth::LinePlot>(&diagram)) plot->caption.clear();
  if (auto* lines = std::get_if<cloth::ParallelCoordinates>(&diagram)) {
    lines->caption.clear();
    lines->invitation = QObject::tr("Drag along an axis to pick runs").toStdString();
  }
  if (auto* map = std::get_if<cloth::HeatMap>(&diagram)) {
    map->caption.clear();
    map->y.label =
        map->y.label.substr(0, map->y.label.find(','));  // no room for what qualifies it: the files have it
  }
  return diagram;
}

double distance_to(const QPainterPath& line, QPointF at) {
  double least = INFINITY;
  for (int k = 1; k < line.elementCount(); ++k) {
    const QPointF from(line.elementAt(k - 1)), to(line.elementAt(k));
    const QPointF along = to - from, away = at - from;
    const double length = QPointF::dotProduct(along, along);
    const double part = length > 0 ? std::clamp(QPointF::dotProduct(away, along) / length, 0.0, 1.0) : 0;
    const QPointF off = away - part * along;
    least = std::min(least, std::hypot(off.x(), off.y()));
  }
  return least;
}

QString written(const QString& name, const QByteArray& bytes) {
  const QString problem = write_file(name, bytes);
  return problem.isEmpty() ? problem : QObject::tr("%1: %2").arg(name, problem);
}

}  // namespace

StudyPlot::StudyPlot(QWidget* parent) : QWidget(parent) {
  setObjectName("studyPlot");
  setMouseTracking(true);
  setAccessibleName(tr("The study's diagram"));
}

void StudyPlot::setDiagram(Diagram diagram) {
  keepBrushes(diagram);
  diagram_ = std::move(diagram);
  stale_ = true;
  keepLegible();
  update();
}

void StudyPlot::setClickOpens(bool opens) {
  click_opens_ = opens;
  setFocusPolicy(opens ? Qt::StrongFocus : Qt::NoFocus);
  setProperty(keeps_arrow_keys, opens);
}

void StudyPlot::setRoom(QSize room) {
  room_ = room;
  keepLegible();
}

/// The least height is that beside a scroll bar, whether there is one or not: then it does not come and go
/// by itself.
void StudyPlot::keepLegible() {
  const int bar = style()->pixelMetric(QStyle::PM_ScrollBarExtent, nullptr, this);
  const double width = std::max(smallest_width, static_cast<double>(room_.width() - bar));
  setMinimumSize(static_cast<int>(smallest_width),
                 static_cast<int>(std::ceil(lowest(for_screen(diagram_), width))));
}

void StudyPlot::refresh() {
  if (!stale_ || size().isEmpty()) return;
  stale_ = false;
  Diagram shown = for_screen(diagram_);
  fit(shown, size());
  picture_ = QPixmap(size() * devicePixelRatioF());
  picture_.setDevicePixelRatio(devicePixelRatioF());
  picture_.fill(theme().panel);
  QPainter painter(&picture_);
  PainterCanvas canvas(painter, font(), PainterCanvas::Look::theme);
  draw(canvas, shown);
  touches_ = canvas.touches();
  smallest_label_ = canvas.smallestText();
  const auto* lines = std::get_if<cloth::ParallelCoordinates>(&shown);
  // A diagram that fills keeps the mark of a run, as far as it is there.
  const std::optional<PlotTouch> before = std::exchange(marked_, std::nullopt);
  for (const PlotTouch& touch : touches_)
    if (before && before->tag >= 0 && touch.tag == before->tag) marked_ = touch;
  axes_ = lines ? axes_of(*lines) : std::vector<cloth::ParallelAxis>();
}

double StudyPlot::smallestLabel() const {
  const_cast<StudyPlot*>(this)->refresh();
  return smallest_label_;
}

QRectF StudyPlot::placeOf(int run) const {
  const_cast<StudyPlot*>(this)->refresh();
  for (const PlotTouch& touch : touches_)
    if (touch.tag == run) return touch.box;
  return {};
}

const PlotTouch* StudyPlot::touchAt(QPointF at) const {
  const PlotTouch* nearest = nullptr;
  double least = INFINITY;
  for (const PlotTouch& touch : touches_) {
    const QRectF& box = touch.box;
    const bool large = box.width() > 4 * reach && touch.line.isEmpty();  // a cell: its neighbours begin there
    const double margin = large ? 0 : reach;
    if (!box.adjusted(-margin, -margin, margin, margin).contains(at)) continue;
    const QPointF away = box.center() - at;
    const bool is_line = !touch.line.isEmpty() && box.width() > 4 * reach;
    const double distance = is_line ? distance_to(touch.line, at) : std::hypot(away.x(), away.y());
    if (is_line && distance > reach) continue;
    if (distance <= least) least = distance, nearest = &touch;
  }
  return nearest;
}

void StudyPlot::mark(const PlotTouch* touch) {
  const bool same = touch ? marked_ && marked_->box == touch->box && marked_->tag == touch->tag : !marked_;
  if (same) return;
  marked_ = touch ? std::optional(*touch) : std::nullopt;
  update();
  setCursor(touch && touch->tag >= 0 ? Qt::PointingHandCursor : Qt::ArrowCursor);
  const QString text = touch ? touch->text() : QString();
  setAccessibleDescription(text);
  Q_EMIT runHovered(text);
}

void StudyPlot::hover(QPointF at) {
  if (const int axis = axisAt(at); axis >= 0) return hoverAxis(static_cast<std::size_t>(axis), at);
  leaveAxis();
  const PlotTouch* touch = touchAt(at);
  const bool same = touch ? marked_ && marked_->box == touch->box && marked_->tag == touch->tag : !marked_;
  if (same) return;
  mark(touch);
  if (touch) {
    QString tip = touch->text().toHtmlEscaped().replace('\n', "<br>");
    if (touch->tag >= 0)
      tip += click_opens_ ? tr("<br><i>Click to open this run, with Ctrl beside those that are open</i>")
                          : tr("<br><i>Double-click to open this run</i>");
    QToolTip::showText(mapToGlobal(at.toPoint()), tip, this);
  } else {
    QToolTip::hideText();
  }
}

/// The nearest run in a direction from the marked one; the first one where none is marked.
const PlotTouch* StudyPlot::next(int dx, int dy) const {
  const PlotTouch* best = nullptr;
  double least = INFINITY;
  for (const PlotTouch& touch : touches_) {
    if (touch.tag < 0) continue;
    if (!marked_) {
      if (!best || touch.tag < best->tag) best = &touch;
      continue;
    }
    const QPointF away = touch.box.center() - marked_->box.center();
    const double along = dx * away.x() + dy * away.y();
    const double across = std::abs(dy * away.x()) + std::abs(dx * away.y());
    if (along < 1) continue;
    // On a curve the next point may be far above or below.
    const double distance =
        along + (dx != 0 && std::holds_alternative<cloth::LinePlot>(diagram_) ? 0.01 : 3) * across;
    if (distance < least) least = distance, best = &touch;
  }
  return best;
}

/// The run that an arrow key leads to.
const PlotTouch* StudyPlot::toward(int key) const {
  switch (key) {
    case Qt::Key_Left:
      return next(-1, 0);
    case Qt::Key_Right:
      return next(1, 0);
    case Qt::Key_Up:
      return next(0, -1);
    case Qt::Key_Down:
      return next(0, 1);
    default:
      return nullptr;
  }
}

void StudyPlot::keyPressEvent(QKeyEvent* event) {
  if (!click_opens_) return QWidget::keyPressEvent(event);
  refresh();
  if (takeBrushKey(*event)) return;
  switch (event->key()) {
    case Qt::Key_Left:
    case Qt::Key_Right:
    case Qt::Key_Up:
    case Qt::Key_Down:
      if (const PlotTouch* to = toward(event->key())) mark(to);
      return;
    case Qt::Key_Return:
    case Qt::Key_Enter:
      if (marked_ && marked_->tag >= 0)
        Q_EMIT runClicked(marked_->tag, event->modifiers().testFlag(Qt::ControlModifier));
      return;
    default:
      return QWidget::keyPressEvent(event);
  }
}

void StudyPlot::paintEvent(QPaintEvent*) {
  refresh();
  QPainter painter(this);
  painter.drawPixmap(0, 0, picture_);
  painter.setRenderHint(QPainter::Antialiasing);
  if (hasFocus()) {
    painter.setPen(QPen(theme().accent, 1, Qt::DotLine));
    painter.drawRect(rect().adjusted(0, 0, -1, -1));
    paintChosenAxis(painter);
  }
  if (!marked_) return;
  const bool is_line = !marked_->line.isEmpty() && marked_->box.width() > 4 * reach;
  painter.setPen(QPen(theme().accent, is_line ? 3 : 2));
  if (is_line)
    painter.drawPath(marked_->line);
  else
    painter.drawRoundedRect(marked_->box.adjusted(-3, -3, 3, 3), 3, 3);
}

void StudyPlot::changeEvent(QEvent* event) {
  if (event->type() == QEvent::PaletteChange || event->type() == QEvent::FontChange ||
      event->type() == QEvent::StyleChange) {
    stale_ = true;
    update();
  }
  QWidget::changeEvent(event);
}

void StudyPlot::resizeEvent(QResizeEvent*) {
  stale_ = true;
  marked_.reset();
}

void StudyPlot::mouseMoveEvent(QMouseEvent* event) {
  drag_ ? drag(event->position().y()) : hover(event->position());
}

void StudyPlot::mousePressEvent(QMouseEvent* event) {
  pressed_ = !beginDrag(*event) && event->button() == Qt::LeftButton;
}

void StudyPlot::mouseReleaseEvent(QMouseEvent* event) {
  if (event->button() != Qt::LeftButton) return;
  if (drag_) return endDrag(event->position().y());
  refresh();  // a click is on what is there now
  if (!std::exchange(pressed_, false) || !click_opens_ || axisAt(event->position()) >= 0) return;
  const PlotTouch* touch = touchAt(event->position());
  if (touch && touch->tag >= 0)
    Q_EMIT runClicked(touch->tag, event->modifiers().testFlag(Qt::ControlModifier));
}

void StudyPlot::mouseDoubleClickEvent(QMouseEvent* event) {
  if (beginDrag(*event) || click_opens_) return;
  const PlotTouch* touch = touchAt(event->position());
  if (touch && touch->tag >= 0) Q_EMIT runActivated(touch->tag);
}

QString save_diagram(const Diagram& diagram, const QString& name, const QFont& font) {
  const QString ending = name.section('.', -1).toLower();
  if (ending == "svg") {
    const std::string svg = std::visit([](const auto& plot) { return cloth::to_svg(plot); }, diagram);
    return written(name, QByteArray::fromStdString(svg));
  }
  const QSizeF size(width_of(diagram), height_of(diagram));
  QByteArray bytes;
  QBuffer buffer(&bytes);
  buffer.open(QIODevice::WriteOnly);
  if (ending == "pdf") {
    QPdfWriter pdf(&buffer);
    pdf.setPageMargins({});
    pdf.setResolution(96);
    pdf.setPageSize(QPageSize(size * 72 / 96, QPageSize::Point, {}, QPageSize::ExactMatch));
    QPainter painter(&pdf);
    PainterCanvas canvas(painter, font, PainterCanvas::Look::light_paper);
    draw(canvas, diagram);
  } else {
    QImage image((size * export_scale).toSize(), QImage::Format_RGB32);
    image.fill(Qt::white);
    QPainter painter(&image);
    painter.scale(export_scale, export_scale);
    PainterCanvas canvas(painter, font, PainterCanvas::Look::light_paper);
    draw(canvas, diagram);
    painter.end();
    if (!image.save(&buffer, "PNG")) return QObject::tr("%1: the picture could not be written").arg(name);
  }
  return written(name, bytes);
}

}  // namespace clothlab

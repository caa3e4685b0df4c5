#include "charts/plot_scene.h"

#include <QCategoryAxis>
#include <QChart>
#include <QFontMetricsF>
#include <QGraphicsLayout>
#include <QLegend>
#include <QLineSeries>
#include <QPainter>
#include <algorithm>
#include <cmath>

namespace clothlab {

namespace {

/// An axis whose ticks and labels are ours. A category axis puts a label at any value; ours are parts of the
/// range, 0 to 1, so that Qt Charts meets neither a value it cannot take the logarithm of nor a range that it
/// takes for none.
QCategoryAxis* add_axis(QChart* chart, QLineSeries* carrier, Qt::Alignment side) {
  auto* axis = new QCategoryAxis;
  axis->setLabelsPosition(QCategoryAxis::AxisLabelsPositionOnValue);
  axis->setTruncateLabels(false);
  axis->setStartValue(-1e300);
  axis->setRange(0, 1);
  chart->addAxis(axis, side);
  carrier->attachAxis(axis);
  return axis;
}

void set_ticks(QCategoryAxis* axis, Range range, std::vector<Tick> ticks) {
  // Without any category Qt Charts forgets the plot's place.
  if (ticks.empty()) ticks.push_back({range.low, QStringLiteral(" ")});
  const auto place = [range](const Tick& tick) {
    return range.span() > 0 ? (tick.position - range.low) / range.span() : 0;
  };
  const QStringList old = axis->categoriesLabels();
  const bool same = std::equal(ticks.begin(), ticks.end(), old.begin(), old.end(),
                               [&](const Tick& tick, const QString& label) {
                                 return tick.label == label && place(tick) == axis->endValue(label);
                               });
  if (same) return;
  for (const QString& label : old) axis->remove(label);
  for (const Tick& tick : ticks) axis->append(tick.label, place(tick));
}

void colour_axis(QCategoryAxis* axis, const Theme& colours, const QFont& font) {
  axis->setLabelsColor(colours.muted_text);
  axis->setLabelsFont(font);
  axis->setGridLinePen(QPen(colours.grid_line, 1));
  axis->setLinePen(QPen(colours.border, 1));
}

}  // namespace

double label_overhang(const QFont& font) {
  return std::ceil(QFontMetricsF(font).height() / 2) + 2;
}

double time_axis_height(const QFont& font) {
  return 2 * QFontMetricsF(font).height() + 2 * spacing;
}

double label_width(const std::vector<Tick>& ticks, const QFont& font) {
  const QFontMetricsF metrics(font);
  double width = 0;
  for (const Tick& tick : ticks) width = std::max(width, metrics.horizontalAdvance(tick.label));
  return std::ceil(width) + spacing + 2;
}

PlotScene::PlotScene(const ChartSpec& spec, bool time_labels, bool on_screen)
    : spec_(spec), time_labels_(time_labels), chart_(new QChart) {
  addItem(chart_);
  chart_->legend()->hide();
  chart_->setMargins({});
  chart_->layout()->setContentsMargins(0, 0, 0, 0);
  chart_->setBackgroundVisible(false);
  chart_->setAnimationOptions(QChart::NoAnimation);
  auto* carrier = new QLineSeries;  // the axes need a series to belong to; the curves are our own
  chart_->addSeries(carrier);
  time_axis_ = add_axis(chart_, carrier, Qt::AlignBottom);
  y_axis_ = add_axis(chart_, carrier, Qt::AlignLeft);
  time_axis_->setLabelsVisible(time_labels);
  curves_ = new CurvesItem(chart_);
  curves_->setZValue(100);
  if (on_screen) curves_->setCacheMode(QGraphicsItem::DeviceCoordinateCache);
  overlay_ = new OverlayItem(chart_);
  overlay_->setZValue(101);
}

void PlotScene::set_look(const Theme& colours, const QFont& font) {
  setFont(font);
  field_ = colours.field;
  title_colour_ = colours.muted_text;
  colour_axis(time_axis_, colours, font);
  colour_axis(y_axis_, colours, font);
  curves_->set_theme(colours);
  overlay_->set_look(colours, font);
}

/// Not by Qt Charts, whose own plot background reaches beyond a plot area that was set by hand, and whose
/// axis cuts its title in a low chart.
void PlotScene::drawBackground(QPainter* painter, const QRectF&) {
  painter->fillRect(map_.plot, field_);
  if (!time_labels_) return;
  const QRectF below(map_.plot.left(), map_.plot.bottom(), map_.plot.width(), time_axis_height(font()));
  if (below.bottom() > sceneRect().bottom() + 1) return;  // a low chart
  painter->setFont(font());
  painter->setPen(title_colour_);
  painter->drawText(below.adjusted(0, 0, 0, -spacing / 2.0), Qt::AlignHCenter | Qt::AlignBottom,
                    QStringLiteral("Simulated time (s)"));
}

void PlotScene::set_geometry(QSizeF size, const QRectF& plot) {
  if (sceneRect().size() == size && map_.plot == plot) return;
  setSceneRect(QRectF(QPointF(), size));
  chart_->resize(size);
  chart_->setPlotArea(plot);
  chart_->layout()->invalidate();  // else axes whose ticks stay the same keep their old place
  map_.plot = plot;
  curves_->set_plot(plot);
  overlay_->set_area(QRectF(QPointF(), size));
}

void PlotScene::show(const ChartRecord& record, const PlotFrame& frame) {
  frame_ = frame;
  map_.time = frame.time;
  map_.y = frame.y;
  set_ticks(time_axis_, frame.time, frame.time_ticks);
  set_ticks(y_axis_, frame.y, frame.y_ticks);
  curves_->build(record, spec_, frame.shown, map_, frame.logarithmic);
  std::optional<double> limit;
  if (spec_.has_limit && frame.limit_shown && record.deformation_rate && *record.deformation_rate > 0) {
    const double percent = *record.deformation_rate * limit_spec().scale;
    limit = map_.y_of(frame.logarithmic ? std::log10(percent) : percent);
  }
  curves_->set_limit(limit);
  overlay_->set_map(map_);
  note_skipped_points(record);
  chart_->layout()->activate();
}

void PlotScene::note_skipped_points(const ChartRecord& record) {
  std::size_t skipped = 0;
  if (frame_.logarithmic)
    for (std::size_t i = 0; i < spec_.curves.size(); ++i)
      if (frame_.shown[i]) {
        const CurveSpec& curve = spec_.curves[i];
        skipped += curve.series(record).summary(curve.column, frame_.time.low, frame_.time.high).not_positive;
      }
  overlay_->set_note(skipped == 0 ? QString()
                                  : QStringLiteral("%1 point%2 ≤ 0 not shown on a log axis")
                                        .arg(skipped)
                                        .arg(skipped == 1 ? QString() : QStringLiteral("s")));
}

}  // namespace clothlab

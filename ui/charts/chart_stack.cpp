#include "charts/chart_stack.h"

#include <QRect>
#include <algorithm>

#include "charts/live_chart.h"

namespace clothlab {

namespace {

constexpr int chart_gap = spacing / 2;
constexpr int smallest_plot = 10, low_plot = 40;  // px
constexpr double smallest_gutter_px = 30;
constexpr double gutter_slack_px = 12;  // a narrower gutter must save this much before the plots move

}  // namespace

ChartStack::ChartStack(const ChartRecord& record, TimeView::Span span, QObject* parent)
    : QObject(parent), record_(record) {
  time_.set_span(span);
}

void ChartStack::add(LiveChart* chart) {
  charts_.push_back(chart);
  connect_chart(chart);
}

void ChartStack::insert(std::size_t at, LiveChart* chart) {
  charts_.insert(charts_.begin() + static_cast<std::ptrdiff_t>(at), chart);
  connect_chart(chart);
}

/// All charts share the time axis; each has its own y axis.
void ChartStack::connect_chart(LiveChart* chart) {
  PlotView* view = &chart->view();
  connect(chart, &LiveChart::changed, this, &ChartStack::changed);
  connect(view, &PlotView::time_zoomed, this, [this](double anchor_s, double factor) {
    time_.zoom(record_.times(), anchor_s, factor);
    Q_EMIT changed();
  });
  connect(view, &PlotView::time_panned, this, [this](double by_s) {
    time_.pan(record_.times(), by_s);
    Q_EMIT changed();
  });
  connect(view, &PlotView::y_zoomed, this, [this, chart](double anchor, double factor) {
    chart->zoom_y(anchor, factor);
    Q_EMIT changed();
  });
  connect(view, &PlotView::y_panned, this, [this, chart](double by) {
    chart->pan_y(by);
    Q_EMIT changed();
  });
  connect(view, &PlotView::box_chosen, this, [this, chart](Range time, Range y) {
    time_.show(record_.times(), time);
    chart->set_y_range(y);
    Q_EMIT changed();
  });
  connect(view, &PlotView::reset_wanted, this, &ChartStack::follow);
  connect(view, &PlotView::y_reset_wanted, this, [this, chart] {
    chart->set_y_range(std::nullopt);
    Q_EMIT changed();
  });
  connect(view, &PlotView::hovered, this,
          [this, chart](std::optional<double> time_s) { Q_EMIT hovered(chart, time_s); });
}

bool ChartStack::is_live() const {
  return time_.is_live() && std::none_of(charts_.begin(), charts_.end(),
                                         [](const LiveChart* chart) { return chart->has_own_y_range(); });
}

void ChartStack::follow() {
  time_.follow();
  for (LiveChart* chart : charts_) chart->set_y_range(std::nullopt);
  Q_EMIT changed();
}

void ChartStack::lay_out(const QRect& room) {
  int left = static_cast<int>(charts_.size());
  const auto height_of_plots = [&] {
    int height = room.height() - (left - 1) * chart_gap;
    for (const LiveChart* chart : charts_) height -= chart->height_beside_plot(room.width());
    return height;
  };
  for (LiveChart* chart : charts_) chart->set_low(false);
  if (height_of_plots() < left * low_plot)
    for (LiveChart* chart : charts_) chart->set_low(true);
  int plots = height_of_plots();
  int top = room.top();
  for (LiveChart* chart : charts_) {
    const int plot = std::max(smallest_plot, plots / left--);
    plots -= plot;
    const int height = chart->height_beside_plot(room.width()) + plot;
    chart->setGeometry(room.left(), top, room.width(), height);
    chart->lay_out();
    top += height + chart_gap;
  }
}

void ChartStack::draw() {
  const Range shown = shown_times();
  double needed = smallest_gutter_px;
  for (LiveChart* chart : charts_) needed = std::max(needed, chart->prepare(record_, shown));
  needed += spacing;
  if (needed > gutter_ || needed < gutter_ - gutter_slack_px) gutter_ = needed;
  for (LiveChart* chart : charts_) chart->draw(record_, gutter_);
}

void ChartStack::read(std::optional<double> time_s) {
  for (LiveChart* chart : charts_) chart->read(record_, time_s);
}

}  // namespace clothlab

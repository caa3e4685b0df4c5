#include "charts/chart_area.h"

#include <QEvent>
#include <QPainter>

#include "charts/live_chart.h"

namespace clothlab {

ChartArea::ChartArea(ChartRecord record, TimeView::Span span, QSize export_size, QWidget* parent)
    : QWidget(parent), record_(std::move(record)), stack_(record_, span), export_size_(export_size) {
  setAccessibleName(tr("Charts"));
  constexpr int refresh_interval = 34;  // ms: no more than 30 updates per second
  data_timer_.setInterval(refresh_interval);
  view_timer_.setSingleShot(true);
  view_timer_.setInterval(0);
  connect(&data_timer_, &QTimer::timeout, this, [this] {
    if (stale_ && isVisible())
      refresh();
    else
      data_timer_.stop();
  });
  connect(&view_timer_, &QTimer::timeout, this, &ChartArea::refresh);
  connect(&stack_, &ChartStack::changed, this, &ChartArea::view_changed);
  connect(&stack_, &ChartStack::hovered, this, [this](LiveChart* chart, std::optional<double> time_s) {
    cursor_x_.reset();
    if (time_s) cursor_x_ = chart->scene().map().x_of(*time_s);
    update_read_out();
  });
}

QString ChartArea::exportPng(const QString& path, QSize size) {
  refresh();
  return save_png(path, size == QSize() ? export_size_ : size, {record_, stack_.charts(), font()});
}

QString ChartArea::exportSvg(const QString& path, QSize size) {
  refresh();
  return save_svg(path, size == QSize() ? export_size_ : size, {record_, stack_.charts(), font()});
}

std::function<QString(const std::stop_token&)> ChartArea::csvWriter(const QString& path) const {
  return [path, record = record_, columns = csv_columns(), times = stack_.shown_times()](
             const std::stop_token& stop) { return save_csv(path, record, columns, times, stop); };
}

QString ChartArea::save(const QString& path) {
  const QString suffix = suffix_of(path);
  return suffix == ".png" ? exportPng(path) : suffix == ".svg" ? exportSvg(path) : exportCsv(path);
}

std::vector<FileKind> ChartArea::kinds() {
  return {{tr("Picture"), {".png"}}, {tr("Drawing"), {".svg"}}, {tr("Points"), {".csv"}}};
}

std::map<QString, bool> ChartArea::logarithmicAxes() {
  for (const LiveChart* chart : stack_.charts()) axes_[chart->spec().key] = chart->is_logarithmic();
  return axes_;
}

void ChartArea::setLogarithmicAxes(const std::map<QString, bool>& axes) {
  axes_ = axes;
  for (LiveChart* chart : stack_.charts())
    if (const auto axis = axes_.find(chart->spec().key); axis != axes_.end())
      chart->set_logarithmic(axis->second);
}

void ChartArea::data_changed() {
  stale_ = true;
  if (isVisible() && !data_timer_.isActive()) data_timer_.start();
}

void ChartArea::view_changed() {
  stale_ = true;
  if (isLive() != was_live_) Q_EMIT liveChanged(was_live_ = isLive());
  if (isVisible()) view_timer_.start();
}

void ChartArea::refresh() {
  stale_ = false;
  if (stack_.charts().empty()) return;
  stack_.draw();
  show_message();
  update_read_out();
}

void ChartArea::update_read_out() {
  std::optional<double> at;
  if (cursor_x_ && !record_.empty()) {
    const double wanted = stack_.charts().front()->scene().map().time_at(*cursor_x_);
    const SampleSeries& series = record_.samples.empty() ? record_.draws : record_.samples;
    at = series.time(series.nearest(wanted));
  }
  stack_.read(at);
}

void ChartArea::lay_out() {
  const int top = lay_out_head();
  stack_.lay_out({0, top, width(), height() - top - spacing / 2});
}

void ChartArea::apply_look() {
  for (LiveChart* chart : stack_.charts()) chart->apply_look();
  updateGeometry();
  lay_out();
  view_changed();
}

void ChartArea::changeEvent(QEvent* event) {
  QWidget::changeEvent(event);
  if (event->type() == QEvent::PaletteChange || event->type() == QEvent::FontChange) apply_look();
}

void ChartArea::showEvent(QShowEvent* event) {
  QWidget::showEvent(event);
  lay_out();
  refresh();
}

void ChartArea::hideEvent(QHideEvent* event) {
  data_timer_.stop();
  view_timer_.stop();
  cursor_x_.reset();
  QWidget::hideEvent(event);
}

void ChartArea::resizeEvent(QResizeEvent*) {
  lay_out();
  if (isVisible()) refresh();
}

void ChartArea::paintEvent(QPaintEvent*) {
  QPainter(this).fillRect(rect(), theme().panel);
}

}  // namespace clothlab

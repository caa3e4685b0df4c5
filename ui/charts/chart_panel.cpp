#include "charts/chart_panel.h"

#include <QKeyEvent>
#include <QPainter>
#include <QTimer>
#include <algorithm>
#include <cmath>

#include "charts/chart_bar.h"
#include "charts/chart_export.h"
#include "charts/chart_stack.h"
#include "charts/live_chart.h"

namespace clothlab {

namespace {

constexpr int refresh_interval_ms = 34;  // no more than 30 updates per second
constexpr double key_pan = 0.1, key_zoom = 0.8;
constexpr QSize smallest{260, 300};  // px

TimeView::Span span_of(ChartPanel::TimeSpan span) {
  return span == ChartPanel::TimeSpan::last_minute ? TimeView::Span::last_minute : TimeView::Span::whole_run;
}

}  // namespace

struct ChartPanel::Parts {
  ChartRecord record;
  ChartStack stack{record, TimeView::Span::last_minute};
  ChartBar* bar = nullptr;
  QTimer data_timer;  ///< runs only while there is something new and somebody to see it
  QTimer view_timer;  ///< joins the mouse moves between two paints into one update
  bool stale = true;
  bool was_live = true;
  std::optional<double> cursor_x;  ///< px in the plots' views
};

ChartPanel::ChartPanel(QWidget* parent) : QWidget(parent), parts_(std::make_unique<Parts>()) {
  setObjectName(QStringLiteral("chart_panel"));
  setAccessibleName(tr("Charts"));
  setFocusPolicy(Qt::ClickFocus);
  const auto& specs = chart_specs();
  for (std::size_t i = 0; i < specs.size(); ++i)
    parts_->stack.add(new LiveChart(specs[i], i + 1 == specs.size(), this));
  connect(&parts_->stack, &ChartStack::changed, this, &ChartPanel::view_changed);
  connect(&parts_->stack, &ChartStack::hovered, this, [this](LiveChart* chart, std::optional<double> time_s) {
    parts_->cursor_x.reset();
    if (time_s) parts_->cursor_x = chart->scene().map().x_of(*time_s);
    update_read_out();
  });
  make_bar();
  parts_->data_timer.setParent(this);
  parts_->view_timer.setParent(this);
  parts_->data_timer.setInterval(refresh_interval_ms);
  parts_->view_timer.setSingleShot(true);
  parts_->view_timer.setInterval(0);
  connect(&parts_->data_timer, &QTimer::timeout, this, [this] {
    if (parts_->stale && isVisible())
      refresh();
    else
      parts_->data_timer.stop();
  });
  connect(&parts_->view_timer, &QTimer::timeout, this, &ChartPanel::refresh);
  apply_look();
}

ChartPanel::~ChartPanel() = default;

void ChartPanel::make_bar() {
  ChartBar* bar = parts_->bar = new ChartBar(this);
  connect(bar, &ChartBar::span_chosen, this, [this](TimeView::Span span) {
    setTimeSpan(span == TimeView::Span::last_minute ? TimeSpan::last_minute : TimeSpan::whole_run);
  });
  connect(bar, &ChartBar::live_wanted, this, &ChartPanel::goLive);
  connect(bar, &ChartBar::save_wanted, this, &ChartPanel::saveAs);
  connect(bar, &ChartBar::box_mode_changed, this, [this](bool on) {
    for (LiveChart* chart : parts_->stack.charts()) chart->view().set_box_mode(on);
  });
}

void ChartPanel::append(std::span<const ChartSample> samples) {
  if (samples.empty()) return;
  const bool reset = !parts_->record.samples.empty() &&
                     std::any_of(samples.begin(), samples.end(), [this](const ChartSample& s) {
                       return s.time_s < parts_->record.samples.last_time();
                     });
  parts_->record.append(samples);
  if (reset) parts_->stack.time().follow();
  data_changed();
}

void ChartPanel::appendDrawTime(double time_s, double milliseconds) {
  parts_->record.append_draw_time(time_s, milliseconds);
  data_changed();
}

void ChartPanel::clear() {
  parts_->record.clear();
  goLive();
}

void ChartPanel::setDeformationRate(std::optional<double> fraction) {
  if (fraction && !std::isfinite(*fraction)) fraction.reset();
  if (parts_->record.deformation_rate == fraction) return;
  parts_->record.deformation_rate = fraction;
  view_changed();
}

void ChartPanel::setTimeSpan(TimeSpan span) {
  parts_->stack.time().set_span(span_of(span));
  parts_->bar->set_span(span_of(span));
  goLive();
}

ChartPanel::TimeSpan ChartPanel::timeSpan() const {
  return parts_->stack.time().span() == TimeView::Span::last_minute ? TimeSpan::last_minute
                                                                    : TimeSpan::whole_run;
}

void ChartPanel::setLogarithmic(Chart chart, bool on) {
  parts_->stack.charts()[static_cast<std::size_t>(chart)]->set_logarithmic(on);
}

bool ChartPanel::isLogarithmic(Chart chart) const {
  return parts_->stack.charts()[static_cast<std::size_t>(chart)]->is_logarithmic();
}

bool ChartPanel::isLive() const {
  return parts_->stack.is_live();
}

void ChartPanel::goLive() {
  parts_->stack.follow();
}

std::pair<double, double> ChartPanel::shownTimes() const {
  const Range shown = parts_->stack.shown_times();
  return {shown.low, shown.high};
}

QString ChartPanel::exportPng(const QString& path, QSize size) {
  refresh();
  return save_png(path, size, {parts_->record, parts_->stack.charts(), font()});
}

QString ChartPanel::exportSvg(const QString& path, QSize size) {
  refresh();
  return save_svg(path, size, {parts_->record, parts_->stack.charts(), font()});
}

QString ChartPanel::exportCsv(const QString& path) const {
  return save_csv(path, parts_->record, run_columns(), parts_->stack.shown_times());
}

void ChartPanel::saveAs() {
  save_charts_by_dialog(this, [this](const QString& path, const QString& ending) {
    return ending == "png" ? exportPng(path) : ending == "svg" ? exportSvg(path) : exportCsv(path);
  });
}

void ChartPanel::data_changed() {
  parts_->stale = true;
  if (isVisible() && !parts_->data_timer.isActive()) parts_->data_timer.start();
}

void ChartPanel::view_changed() {
  parts_->stale = true;
  update_live_button();
  if (isVisible()) parts_->view_timer.start();
}

void ChartPanel::refresh() {
  Parts& p = *parts_;
  p.stale = false;
  p.stack.draw();
  p.stack.charts()[1]->set_message(p.record.empty() ? tr("Press play to see energy, strain and frame time")
                                                    : QString());
  update_read_out();
}

void ChartPanel::update_read_out() {
  Parts& p = *parts_;
  std::optional<double> at;
  if (p.cursor_x && !p.record.empty()) {
    const double wanted = p.stack.charts().front()->scene().map().time_at(*p.cursor_x);
    const SampleSeries& series = p.record.samples.empty() ? p.record.draws : p.record.samples;
    at = series.time(series.nearest(wanted));
  }
  p.stack.read(at);
}

void ChartPanel::update_live_button() {
  const bool live = isLive();
  if (live == parts_->was_live) return;
  parts_->was_live = live;
  parts_->bar->set_live(live);
  Q_EMIT liveChanged(live);
}

QSize ChartPanel::sizeHint() const {
  return {460, 560};
}

QSize ChartPanel::minimumSizeHint() const {
  return smallest.expandedTo({parts_->bar->minimumSizeHint().width(), 0});
}

void ChartPanel::lay_out() {
  ChartBar* bar = parts_->bar;
  bar->setGeometry(0, spacing / 2, width(), bar->sizeHint().height());
  const int top = bar->geometry().bottom() + 1 + spacing / 2;
  parts_->stack.lay_out({0, top, width(), height() - top - spacing / 2});
}

void ChartPanel::apply_look() {
  parts_->bar->apply_look(chart_font(font()));
  for (LiveChart* chart : parts_->stack.charts()) chart->apply_look();
  updateGeometry();
  lay_out();
  view_changed();
}

void ChartPanel::changeEvent(QEvent* event) {
  QWidget::changeEvent(event);
  if (event->type() == QEvent::PaletteChange || event->type() == QEvent::FontChange) apply_look();
}

void ChartPanel::showEvent(QShowEvent* event) {
  QWidget::showEvent(event);
  lay_out();
  refresh();
}

void ChartPanel::hideEvent(QHideEvent* event) {
  parts_->data_timer.stop();
  parts_->view_timer.stop();
  parts_->cursor_x.reset();
  QWidget::hideEvent(event);
}

void ChartPanel::resizeEvent(QResizeEvent*) {
  lay_out();
  if (isVisible()) refresh();
}

void ChartPanel::keyPressEvent(QKeyEvent* event) {
  const Range recorded = parts_->record.times();
  TimeView& time = parts_->stack.time();
  const Range shown = time.shown(recorded);
  const double middle = (shown.low + shown.high) / 2;
  switch (event->key()) {
    case Qt::Key_Left:
      time.pan(recorded, -key_pan * shown.span());
      break;
    case Qt::Key_Right:
      time.pan(recorded, key_pan * shown.span());
      break;
    case Qt::Key_Plus:
    case Qt::Key_Equal:
      time.zoom(recorded, middle, key_zoom);
      break;
    case Qt::Key_Minus:
      time.zoom(recorded, middle, 1 / key_zoom);
      break;
    case Qt::Key_Home:
      goLive();
      return;
    default:
      QWidget::keyPressEvent(event);
      return;
  }
  view_changed();
}

void ChartPanel::paintEvent(QPaintEvent*) {
  QPainter painter(this);
  painter.fillRect(rect(), theme().panel);
}

}  // namespace clothlab

#include "charts/chart_panel.h"

#include <QButtonGroup>
#include <QKeyEvent>
#include <QPainter>
#include <QTimer>
#include <QToolTip>
#include <algorithm>
#include <array>
#include <cmath>

#include "charts/chart_export.h"
#include "charts/live_chart.h"
#include "charts/time_view.h"

namespace clothlab {

namespace {

constexpr int refresh_interval_ms = 34;  // no more than 30 updates per second
constexpr int chart_gap = spacing / 2;
constexpr double key_pan = 0.1, key_zoom = 0.8;
constexpr double smallest_gutter_px = 30;
constexpr double gutter_slack_px = 12;  // a narrower gutter must save this much before the plots move

}  // namespace

struct ChartPanel::Parts {
  ChartRecord record;
  TimeView time;
  std::vector<LiveChart*> charts;
  FlatButton *last_minute = nullptr, *whole_run = nullptr, *live = nullptr, *box = nullptr, *save = nullptr,
             *help = nullptr;
  QTimer data_timer;  ///< runs only while there is something new and somebody to see it
  QTimer view_timer;  ///< joins the mouse moves between two paints into one update
  bool stale = true;
  bool was_live = true;
  double gutter = 0;               ///< px, the same in all charts
  std::optional<double> cursor_x;  ///< px in the plots' views
};

ChartPanel::ChartPanel(QWidget* parent) : QWidget(parent), parts_(std::make_unique<Parts>()) {
  setObjectName(QStringLiteral("chart_panel"));
  setAccessibleName(tr("Charts"));
  setFocusPolicy(Qt::ClickFocus);
  const auto& specs = chart_specs();
  for (std::size_t i = 0; i < specs.size(); ++i) {
    parts_->charts.push_back(new LiveChart(specs[i], i + 1 == specs.size(), this));
    connect_chart(i);
  }
  make_tool_bar();
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

void ChartPanel::make_tool_bar() {
  const auto button = [this](const QString& text, const char* name, const QString& tip) {
    auto* made = new FlatButton(text, this);
    made->setObjectName(QString::fromLatin1(name));
    made->setToolTip(tip);
    return made;
  };
  Parts& p = *parts_;
  p.last_minute = button(tr("Last 60 s"), "last_minute", tr("Follow the last 60 seconds of simulated time"));
  p.whole_run = button(tr("Whole run"), "whole_run", tr("Show the run from its start"));
  auto* spans = new QButtonGroup(this);
  for (FlatButton* span : {p.last_minute, p.whole_run}) {
    span->setCheckable(true);
    spans->addButton(span);
  }
  p.last_minute->setChecked(true);
  p.live = button(tr("● Live"), "live", tr("Follow the run again (double-click or Home)"));
  p.live->setAccessibleName(tr("Live"));
  p.live->setEmphasised(true);
  p.live->hide();
  p.box = button(tr("Zoom box"), "zoom_box", tr("Drag a box to zoom into (or right-drag, or Shift + drag)"));
  p.box->setCheckable(true);
  p.save = button(tr("Save…"), "save_charts", tr("Save the charts as PNG or SVG, or their points as CSV"));
  p.help = button(tr("?"), "chart_help", PlotView::help());
  p.help->setAccessibleName(tr("How to zoom and pan"));
  connect(p.last_minute, &FlatButton::clicked, this, [this] { setTimeSpan(TimeSpan::last_minute); });
  connect(p.whole_run, &FlatButton::clicked, this, [this] { setTimeSpan(TimeSpan::whole_run); });
  connect(p.live, &FlatButton::clicked, this, &ChartPanel::goLive);
  connect(p.save, &FlatButton::clicked, this, &ChartPanel::saveAs);
  connect(p.box, &FlatButton::toggled, this, [this](bool on) {
    for (LiveChart* chart : parts_->charts) chart->view().set_box_mode(on);
  });
  connect(p.help, &FlatButton::clicked, this, [this] {
    QToolTip::showText(parts_->help->mapToGlobal(QPoint(0, parts_->help->height())), PlotView::help(),
                       parts_->help);
  });
}

void ChartPanel::connect_chart(std::size_t index) {
  LiveChart* chart = parts_->charts[index];
  PlotView* view = &chart->view();
  connect(chart, &LiveChart::changed, this, &ChartPanel::view_changed);
  connect(view, &PlotView::time_zoomed, this, [this](double anchor_s, double factor) {
    parts_->time.zoom(parts_->record.times(), anchor_s, factor);
    view_changed();
  });
  connect(view, &PlotView::time_panned, this, [this](double by_s) {
    parts_->time.pan(parts_->record.times(), by_s);
    view_changed();
  });
  connect(view, &PlotView::y_zoomed, this, [this, chart](double anchor, double factor) {
    chart->zoom_y(anchor, factor);
    view_changed();
  });
  connect(view, &PlotView::y_panned, this, [this, chart](double by) {
    chart->pan_y(by);
    view_changed();
  });
  connect(view, &PlotView::box_chosen, this, [this, chart](Range time, Range y) {
    parts_->time.show(parts_->record.times(), time);
    chart->set_y_range(y);
    view_changed();
  });
  connect(view, &PlotView::reset_wanted, this, &ChartPanel::goLive);
  connect(view, &PlotView::y_reset_wanted, this, [this, chart] {
    chart->set_y_range(std::nullopt);
    view_changed();
  });
  connect(view, &PlotView::hovered, this, [this, chart](std::optional<double> time_s) {
    parts_->cursor_x.reset();
    if (time_s) parts_->cursor_x = chart->scene().map().x_of(*time_s);
    update_read_out();
  });
}

void ChartPanel::append(std::span<const ChartSample> samples) {
  if (samples.empty()) return;
  const bool reset = !parts_->record.samples.empty() &&
                     std::any_of(samples.begin(), samples.end(), [this](const ChartSample& s) {
                       return s.time_s < parts_->record.samples.last_time();
                     });
  parts_->record.append(samples);
  if (reset) parts_->time.follow();
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
  parts_->time.set_span(span == TimeSpan::last_minute ? TimeView::Span::last_minute
                                                      : TimeView::Span::whole_run);
  (span == TimeSpan::last_minute ? parts_->last_minute : parts_->whole_run)->setChecked(true);
  goLive();
}

ChartPanel::TimeSpan ChartPanel::timeSpan() const {
  return parts_->time.span() == TimeView::Span::last_minute ? TimeSpan::last_minute : TimeSpan::whole_run;
}

void ChartPanel::setLogarithmic(Chart chart, bool on) {
  parts_->charts[static_cast<std::size_t>(chart)]->set_logarithmic(on);
}

bool ChartPanel::isLogarithmic(Chart chart) const {
  return parts_->charts[static_cast<std::size_t>(chart)]->is_logarithmic();
}

bool ChartPanel::isLive() const {
  return parts_->time.is_live() &&
         std::none_of(parts_->charts.begin(), parts_->charts.end(),
                      [](const LiveChart* chart) { return chart->has_own_y_range(); });
}

void ChartPanel::goLive() {
  parts_->time.follow();
  for (LiveChart* chart : parts_->charts) chart->set_y_range(std::nullopt);
  view_changed();
}

std::pair<double, double> ChartPanel::shownTimes() const {
  const Range shown = parts_->time.shown(parts_->record.times());
  return {shown.low, shown.high};
}

QString ChartPanel::exportPng(const QString& path, QSize size) {
  refresh();
  return save_png(path, size, {parts_->record, parts_->charts, font()});
}

QString ChartPanel::exportSvg(const QString& path, QSize size) {
  refresh();
  return save_svg(path, size, {parts_->record, parts_->charts, font()});
}

QString ChartPanel::exportCsv(const QString& path) const {
  return save_csv(path, parts_->record, run_columns(), parts_->time.shown(parts_->record.times()));
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
  const Range shown = p.time.shown(p.record.times());
  double needed = smallest_gutter_px;
  for (LiveChart* chart : p.charts) needed = std::max(needed, chart->prepare(p.record, shown));
  needed += spacing;
  if (needed > p.gutter || needed < p.gutter - gutter_slack_px) p.gutter = needed;
  for (LiveChart* chart : p.charts) {
    chart->draw(p.record, p.gutter);
    chart->set_message({});
  }
  if (p.record.empty()) p.charts[1]->set_message(tr("Press play to see energy, strain and frame time"));
  update_read_out();
}

void ChartPanel::update_read_out() {
  Parts& p = *parts_;
  std::optional<double> at;
  if (p.cursor_x && !p.record.empty()) {
    const double wanted = p.charts.front()->scene().map().time_at(*p.cursor_x);
    const SampleSeries& series = p.record.samples.empty() ? p.record.draws : p.record.samples;
    at = series.time(series.nearest(wanted));
  }
  for (LiveChart* chart : p.charts) chart->read(p.record, at);
}

void ChartPanel::update_live_button() {
  const bool live = isLive();
  if (live == parts_->was_live) return;
  parts_->was_live = live;
  parts_->live->setVisible(!live);
  Q_EMIT liveChanged(live);
}

QSize ChartPanel::sizeHint() const {
  return {460, 560};
}

QSize ChartPanel::minimumSizeHint() const {
  return {280, 300};
}

void ChartPanel::lay_out() {
  Parts& p = *parts_;
  const int row = p.save->sizeHint().height();
  int x = spacing;
  const int y = spacing / 2;
  for (FlatButton* button : {p.last_minute, p.whole_run}) {
    const QSize size = button->sizeHint();
    button->setGeometry(x, y, size.width(), size.height());
    x += size.width() + spacing / 4;
  }
  x = width() - spacing;
  for (FlatButton* button : {p.help, p.save, p.box, p.live}) {
    const QSize size = button->sizeHint();
    x -= size.width();
    button->setGeometry(x, y, size.width(), size.height());
    x -= spacing / 4;
  }
  // Equal plots: what is left of the height after headers, gaps and the one time axis, in three.
  int top = y + row + spacing / 2;
  int plots = height() - top - spacing / 2 - 2 * chart_gap;
  for (const LiveChart* chart : p.charts) plots -= chart->height_beside_plot(width());
  int left = static_cast<int>(p.charts.size());
  for (LiveChart* chart : p.charts) {
    const int plot = std::max(10, plots / left--);
    plots -= plot;
    const int height = chart->height_beside_plot(width()) + plot;
    chart->setGeometry(0, top, width(), height);
    top += height + chart_gap;
  }
}

void ChartPanel::apply_look() {
  const QFont small = chart_font(font());
  Parts& p = *parts_;
  for (FlatButton* button : {p.last_minute, p.whole_run, p.live, p.box, p.save, p.help})
    button->setFont(small);
  for (LiveChart* chart : p.charts) chart->apply_look();
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
  const Range shown = parts_->time.shown(recorded);
  const double middle = (shown.low + shown.high) / 2;
  switch (event->key()) {
    case Qt::Key_Left:
      parts_->time.pan(recorded, -key_pan * shown.span());
      break;
    case Qt::Key_Right:
      parts_->time.pan(recorded, key_pan * shown.span());
      break;
    case Qt::Key_Plus:
    case Qt::Key_Equal:
      parts_->time.zoom(recorded, middle, key_zoom);
      break;
    case Qt::Key_Minus:
      parts_->time.zoom(recorded, middle, 1 / key_zoom);
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

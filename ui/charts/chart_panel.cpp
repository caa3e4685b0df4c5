#include "charts/chart_panel.h"

#include <QDragEnterEvent>
#include <QKeyEvent>
#include <QMimeData>
#include <QUrl>
#include <algorithm>
#include <cmath>

#include "charts/chart_bar.h"
#include "charts/live_chart.h"
#include "widgets/building.h"

namespace clothlab {

namespace {

/// The one file that is dragged, where it is a table; else empty.
QString dropped_table(const QMimeData& data) {
  const QList<QUrl> urls = data.urls();
  if (urls.size() != 1 || !urls.front().isLocalFile()) return {};
  const QString file = urls.front().toLocalFile();
  for (const char* suffix : {".csv", ".tsv", ".txt"})
    if (file.endsWith(QLatin1String(suffix), Qt::CaseInsensitive)) return file;
  return {};
}

constexpr double key_pan = 0.1, key_zoom = 0.8;
constexpr QSize smallest{260, 290};  // px: with legends in two rows each plot has some 30

}  // namespace

ChartPanel::ChartPanel(QWidget* parent) : ChartArea({}, TimeView::Span::last_minute, {1600, 1200}, parent) {
  setObjectName(QStringLiteral("chart_panel"));
  setFocusPolicy(Qt::ClickFocus);
  setProperty(keeps_arrow_keys, true);
  setAcceptDrops(true);
  const auto& specs = chart_specs();
  for (std::size_t i = 0; i < specs.size(); ++i)
    stack_.add(new LiveChart(specs[i], i + 1 == specs.size(), this));
  make_bar();
  apply_look();
}

ChartPanel::~ChartPanel() {
  qDeleteAll(probe_charts_);  // before their specs
}

void ChartPanel::make_bar() {
  bar_ = new ChartBar(this);
  bar_->apply_look(chart_font(font()));
  connect(bar_, &ChartBar::span_chosen, this, &ChartPanel::setTimeSpan);
  connect(bar_, &ChartBar::live_wanted, this, &ChartPanel::goLive);
  connect(bar_, &ChartBar::save_wanted, this, &ChartPanel::saveWanted);
  connect(bar_, &ChartBar::box_mode_changed, this, [this](bool on) {
    box_mode_ = on;
    for (LiveChart* chart : stack_.charts()) chart->view().set_box_mode(on);
  });
  connect(this, &ChartArea::liveChanged, bar_, &ChartBar::set_live);
}

void ChartPanel::append(std::span<const ChartSample> samples) {
  if (samples.empty()) return;
  const bool reset =
      !record_.samples.empty() && std::any_of(samples.begin(), samples.end(), [this](const ChartSample& s) {
        return s.time_s < record_.samples.last_time();
      });
  record_.append(samples);
  follow_probes();
  if (reset) stack_.time().follow();
  data_changed();
}

/// Their charts stand above that of the frame time, which has the labels of the time axis.
void ChartPanel::follow_probes() {
  if (record_.probes == charted_probes_) return;
  charted_probes_ = record_.probes;
  logarithmicAxes();  // as the user chose them
  for (LiveChart* chart : probe_charts_) stack_.take(chart);
  qDeleteAll(probe_charts_);
  probe_charts_.clear();
  probe_specs_.clear();
  for (ChartSpec& spec : probe_chart_specs(charted_probes_)) {
    probe_specs_.push_back(std::make_unique<ChartSpec>(std::move(spec)));
    auto* chart = new LiveChart(*probe_specs_.back(), false, this);
    chart->view().set_box_mode(box_mode_);
    stack_.insert(stack_.charts().size() - 1, chart);
    probe_charts_.push_back(chart);
    chart->show();
  }
  setLogarithmicAxes(std::map<QString, bool>(axes_));
  apply_look();
}

std::vector<CsvColumn> ChartPanel::csv_columns() const {
  std::vector<CsvColumn> columns = run_columns();
  for (std::size_t k = 0; k < record_.probes.size(); ++k)
    columns.push_back({QByteArray::fromStdString(record_.probes[k]), Source::samples, sample_columns + k});
  return columns;
}

void ChartPanel::appendDrawTime(double time_s, double milliseconds) {
  record_.append_draw_time(time_s, milliseconds);
  data_changed();
}

void ChartPanel::clear() {
  record_.clear();
  record_.set_probes({});
  follow_probes();
  goLive();
}

void ChartPanel::setDeformationRate(std::optional<double> fraction) {
  if (fraction && !std::isfinite(*fraction)) fraction.reset();
  if (record_.deformation_rate == fraction) return;
  record_.deformation_rate = fraction;
  view_changed();
}

void ChartPanel::setMeasured(const std::optional<MeasuredDots>& dots) {
  if (record_.measured == dots) return;
  record_.measured = dots;
  view_changed();
}

/// Other files are for the window.
void ChartPanel::dragEnterEvent(QDragEnterEvent* event) {
  if (!dropped_table(*event->mimeData()).isEmpty())
    event->acceptProposedAction();
  else
    event->ignore();
}

void ChartPanel::dropEvent(QDropEvent* event) {
  const QString file = dropped_table(*event->mimeData());
  if (file.isEmpty()) return event->ignore();
  event->acceptProposedAction();
  std::string column;
  for (const LiveChart* chart : stack_.charts())
    if (chart->geometry().contains(event->position().toPoint())) column = column_of(*chart);
  Q_EMIT tableDropped(file, column);
}

/// The column of the record that a chart's first curve is of; of the energies the kinetic one.
std::string ChartPanel::column_of(const LiveChart& chart) const {
  const CurveSpec& curve = chart.spec().curves.front();
  if (chart.spec().key == "energy") return "kinetic_J";
  if (chart.spec().key == "strain") return "max_strain";
  const bool is_of_probe = curve.source == Source::samples && curve.column >= sample_columns;
  return is_of_probe ? record_.probes[curve.column - sample_columns] : std::string();
}

void ChartPanel::setTimeSpan(TimeSpan span) {
  stack_.time().set_span(span);
  bar_->set_span(span);
  goLive();
}

void ChartPanel::show_message() {
  stack_.charts()[1]->set_message(record_.empty() ? tr("Press play to see energy, strain and frame time")
                                                  : QString());
}

QSize ChartPanel::minimumSizeHint() const {
  return smallest.expandedTo({bar_->minimumSizeHint().width(), 0});
}

int ChartPanel::lay_out_head() {
  bar_->setGeometry(0, spacing / 2, width(), bar_->sizeHint().height());
  return bar_->geometry().bottom() + 1 + spacing / 2;
}

void ChartPanel::changeEvent(QEvent* event) {
  if (event->type() == QEvent::PaletteChange || event->type() == QEvent::FontChange)
    bar_->apply_look(chart_font(font()));
  ChartArea::changeEvent(event);
}

void ChartPanel::keyPressEvent(QKeyEvent* event) {
  const Range recorded = record_.times();
  TimeView& time = stack_.time();
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

}  // namespace clothlab

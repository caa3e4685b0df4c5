#include "charts/live_chart.h"

#include <QLabel>
#include <algorithm>
#include <cmath>
#include <utility>

#include "widgets/numbers.h"

namespace clothlab {

namespace {

constexpr double y_tick_distance = 28, time_tick_distance = 45;
constexpr double smallest_log_span = 1e-3;
constexpr int read_digits = 4;
constexpr int legend_margin = spacing / 2;
constexpr double noise = 1e-12;  // in any unit shown: rounding of what is zero, which gets no axis of its own

int intervals(double px, double distance) {
  return std::clamp(static_cast<int>(px / distance), 3, 20);
}

/// An axis tells its ticks apart by their labels, so no two are equal.
void blank_labels(std::vector<Tick>& ticks) {
  for (std::size_t i = 0; i < ticks.size(); ++i)
    ticks[i].label = QString(static_cast<qsizetype>(i) + 1, u' ');
}

}  // namespace

LiveChart::LiveChart(const ChartSpec& spec, bool time_labels, QWidget* parent)
    : QWidget(parent),
      spec_(spec),
      time_labels_(time_labels),
      title_(new QLabel(spec.title, this)),
      log_button_(new FlatButton(tr("log"), this)),
      scene_(new PlotScene(spec, time_labels, true)),
      view_(new PlotView(scene_, this)) {
  scene_->setParent(this);
  setObjectName(spec.key);
  view_->setObjectName(spec.key + "_plot");
  view_->setAccessibleName(spec.title);
  view_->setAccessibleDescription(tr("Live chart over simulated time"));
  title_->setToolTip(PlotView::help());
  const auto add_entry = [this](const CurveSpec& curve) {
    auto* entry = new LegendEntry(curve.name, curve.style, this);
    const QString& name = curve.short_name.isEmpty() ? curve.name : curve.short_name;
    entry->setObjectName(spec_.key + "_" + name.toLower().replace(' ', '_'));
    connect(entry, &LegendEntry::toggled, this, [this] { Q_EMIT changed(); });
    return entry;
  };
  for (const CurveSpec& curve : spec.curves) legend_.push_back(add_entry(curve));
  if (spec.has_limit) {
    limit_entry_ = add_entry(limit_spec());
    limit_entry_->hide();
  }
  log_button_->setObjectName(spec.key + "_log");
  log_button_->setCheckable(true);
  log_button_->setToolTip(tr("Logarithmic axis"));
  log_button_->setAccessibleName(tr("Logarithmic axis: %1").arg(spec.title));
  connect(log_button_, &FlatButton::toggled, this, &LiveChart::set_logarithmic);
  apply_look();
}

void LiveChart::apply_look() {
  const QFont small = chart_font(font());
  QFont bold = small;
  bold.setWeight(QFont::DemiBold);
  title_->setFont(bold);
  log_button_->setFont(small);
  for (LegendEntry* entry : legend_) entry->setFont(small);
  if (limit_entry_) limit_entry_->setFont(small);
  scene_->set_look(theme(), small);
  lay_out();
}

void LiveChart::set_logarithmic(bool on) {
  if (on == logarithmic_) return;
  logarithmic_ = on;
  log_button_->setChecked(on);
  if (own_y_) {  // the same stretch of values, as far as the other axis has it
    Range range = *own_y_;
    if (on && range.high <= 0)
      own_y_.reset();
    else if (on)
      own_y_ = Range{std::log10(range.low > 0 ? range.low : range.high * 1e-3), std::log10(range.high)};
    else
      own_y_ = Range{std::pow(10.0, range.low), std::pow(10.0, range.high)};
  }
  Q_EMIT changed();
}

void LiveChart::set_y_range(std::optional<Range> axis_range) {
  own_y_ = axis_range;
  if (!own_y_) {
    sticky_.forget();
    return;
  }
  // As close as the labels and a double can follow, and no farther out than any value of use.
  const double size = std::max(std::abs(own_y_->low), std::abs(own_y_->high));
  const double closest = logarithmic_ ? smallest_log_span : std::max(size * 1e-9, 1e-30);
  const double widest = logarithmic_ ? 60 : 1e30;
  const double span = std::clamp(own_y_->span(), closest, widest);
  const double middle = std::clamp((own_y_->low + own_y_->high) / 2, logarithmic_ ? -150.0 : -1e30,
                                   logarithmic_ ? 150.0 : 1e30);
  own_y_ = Range{middle - span / 2, middle + span / 2};
}

void LiveChart::zoom_y(double anchor, double factor) {
  const Range now = frame_.y;
  set_y_range(Range{anchor + (now.low - anchor) * factor, anchor + (now.high - anchor) * factor});
}

bool LiveChart::has_room_for_names(int width) const {
  int needed = title_->sizeHint().width() + log_button_->sizeHint().width() + 2 * spacing;
  for (const CurveSpec& curve : spec_.curves) needed += LegendEntry::width_of(curve.name, title_->font());
  return needed <= width;
}

void LiveChart::name_curves(bool in_full) {
  named_elsewhere_ = !in_full;
  for (std::size_t i = 0; i < legend_.size(); ++i)
    legend_[i]->setName(in_full ? spec_.curves[i].name : spec_.curves[i].short_name, spec_.curves[i].name);
  lay_out();
}

std::vector<bool> LiveChart::shown_curves() const {
  std::vector<bool> shown;
  for (const LegendEntry* entry : legend_) shown.push_back(entry->isChecked());
  return shown;
}

bool LiveChart::limit_on(const ChartRecord& record) const {
  return limit_entry_ && limit_entry_->isChecked() && record.deformation_rate && *record.deformation_rate > 0;
}

/// Of the curves shown, in the chart's unit; low above high when there is nothing.
/// Measured values within the times shown, where their curve is.
template <class Include>
void LiveChart::include_measured(const ChartRecord& record, bool positive, const Include& include) const {
  const auto column = record.measured_column();
  for (std::size_t i = 0; column && i < spec_.curves.size(); ++i) {
    const CurveSpec& curve = spec_.curves[i];
    if (!legend_[i]->isChecked() || curve.source != Source::samples || curve.column != *column) continue;
    for (std::size_t k = 0; k < record.measured->times.size(); ++k) {
      const double value = record.measured->values[k] * curve.scale;
      if (frame_.time.contains(record.measured->times[k]) && (!positive || value > 0)) include(value, value);
    }
  }
}

Range LiveChart::data_range(const ChartRecord& record, bool positive) const {
  Range range{std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity()};
  const auto include = [&range](double low, double high) {
    if (std::isfinite(low)) range.low = std::min(range.low, low);
    if (std::isfinite(high)) range.high = std::max(range.high, high);
  };
  for (std::size_t i = 0; i < spec_.curves.size(); ++i) {
    if (!legend_[i]->isChecked()) continue;
    const CurveSpec& curve = spec_.curves[i];
    const auto found = curve.series(record).summary(curve.column, frame_.time.low, frame_.time.high);
    if (!positive)
      include(found.min * curve.scale, found.max * curve.scale);
    else if (std::isfinite(found.min_positive))
      include(found.min_positive * curve.scale, found.max * curve.scale);
  }
  include_measured(record, positive, include);
  const bool some = range.low <= range.high;
  if (limit_on(record) && (some || !positive)) {
    const double limit = *record.deformation_rate * limit_spec().scale;
    include(limit, limit);
  }
  return range;
}

Range LiveChart::automatic_y(const ChartRecord& record) {
  Range values = data_range(record, logarithmic_);
  const bool nothing = values.low > values.high;
  if (logarithmic_) return nothing ? Range{-2, 1} : sticky_.logarithmic(values);
  if (nothing || std::max(std::abs(values.low), std::abs(values.high)) < noise) return {0, 1};
  // Zero belongs on the axis unless the values lie far away from it.
  if (values.low > 0 && (spec_.from_zero || values.low < values.span())) values.low = 0;
  if (values.high < 0 && -values.high < values.span()) values.high = 0;
  return sticky_.linear(values, intervals(scene_->map().plot.height(), y_tick_distance));
}

void LiveChart::choose_ticks(PlotFrame& frame, QSizeF plot_size) const {
  const int y_intervals = intervals(plot_size.height(), y_tick_distance);
  frame.y_ticks = frame.logarithmic ? log_ticks(frame.y, y_intervals) : linear_ticks(frame.y, y_intervals);
  // As many time ticks as leave some room between their labels.
  for (int count = intervals(plot_size.width(), time_tick_distance); count > 0; --count) {
    frame.time_ticks = linear_ticks(frame.time, count);
    const double step = nice_step(frame.time.span(), count) / frame.time.span() * plot_size.width();
    if (label_width(frame.time_ticks, title_->font()) + spacing <= step) break;
  }
}

double LiveChart::prepare(const ChartRecord& record, Range time) {
  const bool limit_known = record.deformation_rate && *record.deformation_rate > 0;
  if (limit_entry_ && limit_entry_->isHidden() == limit_known) {
    limit_entry_->setVisible(limit_known);
    lay_out();
  }
  frame_.time = time;
  frame_.logarithmic = logarithmic_;
  frame_.shown = shown_curves();
  frame_.limit_shown = limit_on(record);
  frame_.y = own_y_ ? *own_y_ : automatic_y(record);
  choose_ticks(frame_, scene_->map().plot.size());
  if (record.empty()) {  // numbers on the axes would mean nothing yet
    blank_labels(frame_.y_ticks);
    blank_labels(frame_.time_ticks);
  }
  return label_width(frame_.y_ticks, title_->font());
}

void LiveChart::draw(const ChartRecord& record, double gutter) {
  scene_->set_geometry(view_->size(), plot_rect(gutter));
  scene_->show(record, frame_);
}

PlotFrame LiveChart::frame_for(QSizeF plot_size) const {
  PlotFrame frame = frame_;
  choose_ticks(frame, plot_size);
  return frame;
}

void LiveChart::read(const ChartRecord& record, std::optional<double> time_s) {
  if (!time_s || record.empty()) {
    scene_->overlay().set_read_out(std::nullopt, false);
    return;
  }
  ReadOut out;
  out.time_s = *time_s;
  const std::vector<bool> shown = shown_curves();
  for (std::size_t i = 0; i < spec_.curves.size(); ++i) {
    const CurveSpec& curve = spec_.curves[i];
    const SampleSeries& series = curve.series(record);
    if (!shown[i] || series.empty()) continue;
    const double value = series.value(curve.column, series.nearest(*time_s)) * curve.scale;
    ReadOut::Row row{&curve, tr("none"), std::nullopt};
    if (std::isfinite(value)) {
      row.value = quantity_text(value, spec_.unit.toStdString(), read_digits);
      if (!logarithmic_ || value > 0) row.y = logarithmic_ ? std::log10(value) : value;
    }
    out.rows.push_back(row);
  }
  if (limit_on(record)) {
    const double percent = *record.deformation_rate * limit_spec().scale;
    out.rows.push_back(
        {&limit_spec(), quantity_text(percent, spec_.unit.toStdString(), read_digits), std::nullopt});
  }
  scene_->overlay().set_read_out(std::move(out), time_labels_);
}

std::vector<LegendEntry*> LiveChart::entries() const {
  std::vector<LegendEntry*> all = legend_;
  if (limit_entry_ && !limit_entry_->isHidden()) all.push_back(limit_entry_);
  return all;
}

bool LiveChart::legend_beside_title(int width) const {
  int needed = title_->sizeHint().width() + log_button_->sizeHint().width() + 2 * spacing;
  for (const LegendEntry* entry : entries()) needed += entry->sizeHint().width();
  return needed <= width;
}

std::vector<std::vector<LegendEntry*>> LiveChart::legend_rows(int width) const {
  if (legend_beside_title(width)) return {entries()};
  if (is_low_ && named_elsewhere_) return {};
  std::vector<std::vector<LegendEntry*>> rows;
  int x = width;  // the first one begins a row
  for (LegendEntry* entry : entries()) {
    const int needed = entry->sizeHint().width();
    if (x + needed > width - legend_margin) {
      rows.emplace_back();
      x = legend_margin;
    }
    rows.back().push_back(entry);
    x += needed;
  }
  return rows;
}

int LiveChart::header_height(int width) const {
  const int row = log_button_->sizeHint().height();
  const int title_rows = legend_beside_title(width) ? 0 : 1;
  return row * (title_rows + static_cast<int>(legend_rows(width).size()));
}

/// A low chart has no title of its time axis.
double LiveChart::height_below_plot() const {
  if (!time_labels_) return label_overhang(title_->font());
  return std::floor(time_axis_height(title_->font()) / (is_low_ ? 2 : 1));
}

int LiveChart::height_beside_plot(int width) const {
  const double above = label_overhang(title_->font());
  return header_height(width) + static_cast<int>(above + std::floor(height_below_plot()));
}

QRectF LiveChart::plot_rect(double gutter) const {
  const double above = label_overhang(title_->font());
  return {gutter, above, std::max(1.0, view_->width() - gutter - plot_right_margin),
          std::max(1.0, view_->height() - above - height_below_plot())};
}

void LiveChart::lay_out() {
  const int row = log_button_->sizeHint().height();
  const QSize log = log_button_->sizeHint();
  log_button_->setGeometry(width() - log.width() - plot_right_margin + spacing / 2, 0, log.width(),
                           log.height());
  title_->setGeometry(spacing, 0, std::min(title_->sizeHint().width(), log_button_->x() - 2 * spacing), row);
  const bool beside_title = legend_beside_title(width());
  int y = beside_title ? 0 : row;
  const auto rows = legend_rows(width());
  for (LegendEntry* entry : legend_) entry->setVisible(!rows.empty());
  for (const auto& line : rows) {
    int x = legend_margin;
    if (beside_title) {
      x = log_button_->x() - spacing / 2;
      for (const LegendEntry* entry : line) x -= entry->sizeHint().width();
    }
    for (LegendEntry* entry : line) {
      entry->setGeometry(QRect({x, y}, entry->sizeHint()));
      x += entry->sizeHint().width();
    }
    y += row;
  }
  const int header = header_height(width());
  view_->setGeometry(0, header, width(), std::max(1, height() - header));
}

}  // namespace clothlab

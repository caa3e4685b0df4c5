#include "document/varied_ranges.h"

#include <algorithm>
#include <cmath>

#include "document/lab_document.h"
#include "scene/scene_parameters.h"

namespace clothlab {
namespace {

constexpr int usual_counts[] = {12, 9, 5};  // of the first, the second and further parameters
constexpr double usual_factor = 4;          // to each side of the present value, on a logarithmic scale
constexpr double usual_part = 0.25;         // of the slider's range to each side, on a linear one

std::optional<double> number_of(const cloth::ParameterValue& value) {
  if (const auto* number = std::get_if<double>(&value)) return *number;
  if (const auto* whole = std::get_if<std::int64_t>(&value)) return static_cast<double>(*whole);
  return std::nullopt;
}

double rounded(double value, const cloth::ParameterInfo& info) {
  if (info.kind == cloth::Kind::integer) return std::round(value);
  if (value == 0) return 0;
  const double power = std::pow(10.0, 1 - std::floor(std::log10(std::abs(value))));
  return std::round(value * power) / power;
}

/// Around the value, within what the parameter and its slider allow.
VariedRange range_around(const cloth::Parameter& parameter, std::optional<double> value) {
  const cloth::ParameterInfo& info = parameter.info;
  const double low = std::max(info.slider_minimum, info.minimum);
  const double high = std::min(info.slider_maximum, info.maximum);
  VariedRange range{.path = parameter.path, .from = low, .to = high};
  if (info.scale == cloth::Scale::logarithmic && high > 0) {
    range.scale = cloth::AxisScale::logarithmic;
    const double middle = value.value_or(0) > 0 ? *value : high / 30;
    range.from = std::max(middle / usual_factor, info.minimum);
    range.to = std::min(middle * usual_factor, info.maximum);
  } else if (value) {
    range.from = std::max(*value - usual_part * (high - low), low);
    range.to = std::min(*value + usual_part * (high - low), high);
  }
  range.from = rounded(range.from, info);
  range.to = rounded(range.to, info);
  if (!(range.from < range.to)) range.from = low, range.to = high;
  if (info.minimum_excluded && range.from <= info.minimum) range.from = range.to / 100;
  return range;
}

/// A range of whole numbers has no more values than there are.
int largest_count(const cloth::ParameterInfo& info, const VariedRange& range) {
  if (info.kind != cloth::Kind::integer) return VariedRanges::most_values;
  return static_cast<int>(std::min<double>(VariedRanges::most_values, range.to - range.from + 1));
}

}  // namespace

bool can_be_varied(const cloth::ParameterInfo& info) {
  const bool is_number = info.kind == cloth::Kind::number || info.kind == cloth::Kind::integer;
  return is_number && info.slider_maximum > info.slider_minimum;
}

class VariedRanges::Command : public SideCommand {
 public:
  Command(VariedRanges& ranges, const QString& text, std::vector<VariedRange> after, int drag)
      : SideCommand(text), ranges_(ranges), before_(ranges.all_), after_(std::move(after)), drag_(drag) {}

  void undo() override { apply(before_); }
  void redo() override { apply(after_); }
  int id() const override { return 2; }

  bool mergeWith(const QUndoCommand* other) override {
    const auto* next = static_cast<const Command*>(other);
    if (drag_ == 0 || drag_ != next->drag_) return false;
    after_ = next->after_;
    setObsolete(after_ == before_);
    return true;
  }

 private:
  void apply(const std::vector<VariedRange>& all) {
    ranges_.all_ = all;
    Q_EMIT ranges_.changed();
  }

  VariedRanges& ranges_;
  std::vector<VariedRange> before_, after_;
  int drag_;
};

VariedRanges::VariedRanges(LabDocument& document) : document_(document) {
  connect(&document, &LabDocument::loaded, this, [this] {
    all_.clear();
    Q_EMIT changed();
  });
}

std::vector<VariedRange> VariedRanges::list() const {
  std::vector<VariedRange> present;
  for (const VariedRange& range : all_)
    if (find_parameter(document_.scene(), range.path)) present.push_back(range);
  return present;
}

std::optional<VariedRange> VariedRanges::find(const std::string& path) const {
  for (const VariedRange& range : all_)
    if (range.path == path) return range;
  return std::nullopt;
}

QString VariedRanges::label(const std::string& path) const {
  const auto parameter = find_parameter(document_.scene(), path);
  return parameter ? in_sentence(parameter->info.label) : QString::fromStdString(path);
}

void VariedRanges::add(const std::string& path) {
  const auto parameter = find_parameter(document_.scene(), path);
  if (!parameter || !can_be_varied(parameter->info) || find(path) || list().size() >= most) return;
  VariedRange range = range_around(*parameter, number_of(parameter->get(document_.scene())));
  range.count = std::min(usual_counts[std::min<std::size_t>(list().size(), std::size(usual_counts) - 1)],
                         largest_count(parameter->info, range));
  std::vector<VariedRange> after = all_;
  // A grid over two needs fewer values of each than a curve.
  if (after.size() == 1 && after.front().count == usual_counts[0]) after.front().count = usual_counts[1];
  if (after.size() == 2)
    for (VariedRange& other : after)
      if (other.count == usual_counts[1]) other.count = usual_counts[2];
  after.push_back(range);
  push(tr("Vary %1").arg(label(path)), std::move(after), 0);
  Q_EMIT added(path);
}

void VariedRanges::remove(const std::string& path) {
  std::vector<VariedRange> after = all_;
  std::erase_if(after, [&](const VariedRange& range) { return range.path == path; });
  if (after.size() == all_.size()) return;
  push(tr("Do not vary %1").arg(label(path)), std::move(after), 0);
}

QString VariedRanges::set(const VariedRange& range) {
  const auto parameter = find_parameter(document_.scene(), range.path);
  std::vector<VariedRange> after = all_;
  const auto at = std::find_if(after.begin(), after.end(),
                               [&](const VariedRange& other) { return other.path == range.path; });
  if (!parameter || at == after.end()) return tr("is not varied");
  const cloth::ParameterInfo& info = parameter->info;
  for (const double end : {range.from, range.to}) {
    if (info.kind == cloth::Kind::integer && end != std::round(end)) return tr("must be a whole number");
    const bool whole = info.kind == cloth::Kind::integer;
    const auto value = whole ? cloth::ParameterValue(static_cast<std::int64_t>(end)) : end;
    if (const auto rule = broken_rule(info, value)) return QString::fromStdString(*rule);
    if (range.scale == cloth::AxisScale::logarithmic && !(end > 0))
      return tr("must be > 0 where values go in equal ratios");
  }
  if (!(range.from < range.to)) return tr("must begin below its end");
  if (*at == range) return {};
  *at = range;
  at->count = std::clamp(range.count, 2, largest_count(info, range));
  push(tr("Change the range of %1").arg(label(range.path)), std::move(after), document_.presentDrag());
  return {};
}

void VariedRanges::push(const QString& text, std::vector<VariedRange> after, int drag) {
  document_.undoStack().push(new Command(*this, text, std::move(after), drag));
}

}  // namespace clothlab

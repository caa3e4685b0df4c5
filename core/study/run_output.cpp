#include "study/run_output.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "measure/droop.h"
#include "simulation/recorder.h"

namespace cloth {
namespace {

constexpr double no_output = std::numeric_limits<double>::quiet_NaN();

/// The reductions of output_endings(), in their order.
constexpr Reduction with_ending[] = {Reduction::maximum, Reduction::minimum, Reduction::mean};

/// The measures of one row: what several of them share is measured once.
class RowShape {
 public:
  explicit RowShape(const Simulation& simulation) : simulation_(simulation) {}

  double value_of(const std::string& name) {
    if (name == "lowest_point") return droop().lowest;
    if (name == "sag") return droop().drop;
    if (name == "droop_ratio") return droop().ratio();
    if (name == "extent_x") return extent().x();
    if (name == "extent_y") return extent().y();
    if (name == "extent_z") return extent().z();
    return name == "extent" ? extent().maxCoeff() : no_output;
  }

 private:
  const Droop& droop() {
    if (!droop_)
      droop_ =
          measure_droop(simulation_.system(), simulation_.state().position, gravity_of(simulation_.scene()));
    return *droop_;
  }

  const Vec3& extent() {
    if (!extent_) {
      const Vec3Field& position = simulation_.state().position;
      const auto of = [&](const double* x) {
        const auto [least, most] = std::minmax_element(x, x + position.size());
        return *most - *least;
      };
      extent_ = Vec3(of(position.x()), of(position.y()), of(position.z()));
    }
    return *extent_;
  }

  const Simulation& simulation_;
  std::optional<Droop> droop_;
  std::optional<Vec3> extent_;
};

void add_shape_measures(bool is_pinned, std::vector<std::string>& names) {
  for (const ShapeMeasure& measure : shape_measures()) {
    const std::string name = measure.name;
    if (is_pinned || !(name == "sag" || name == "droop_ratio")) names.push_back(name);
  }
}

/// The columns of record.csv that any machine has alike.
std::vector<std::string> recorded_sources(const Simulation& simulation) {
  std::vector<std::string> names = record_columns(simulation.quantities());
  std::erase(names, "step_time_us");
  return names;
}

}  // namespace

const std::vector<std::string>& reduction_names() {
  static const std::vector<std::string> names{"final",       "max",         "min",         "mean",
                                              "first-above", "first-below", "stays-below", "rms"};
  return names;
}

const std::string& name_of(Reduction reduction) {
  return reduction_names()[static_cast<std::size_t>(reduction)];
}

bool has_bound(Reduction reduction) {
  return reduction == Reduction::first_above || reduction == Reduction::first_below ||
         reduction == Reduction::stays_below;
}

const std::vector<std::string>& output_endings() {
  static const std::vector<std::string> endings = [] {
    std::vector<std::string> all;
    for (const Reduction reduction : with_ending) all.push_back(":" + name_of(reduction));
    return all;
  }();
  return endings;
}

RunOutput parse_output(const std::string& text) {
  const auto& endings = output_endings();
  for (std::size_t k = 0; k < endings.size(); ++k)
    if (text.ends_with(endings[k]))
      return {.of = text.substr(0, text.size() - endings[k].size()), .reduce = with_ending[k]};
  return {.of = text};
}

const std::vector<ShapeMeasure>& shape_measures() {
  static const std::vector<ShapeMeasure> all{
      {"lowest_point", "m", "height of the lowest particle, against gravity"},
      {"sag", "m", "how far the lowest particle hangs below the pinned one nearest to it horizontally"},
      {"droop_ratio", "", "that drop over the horizontal distance between the two"},
      {"extent", "m", "the largest of the three extents"},
      {"extent_x", "m", "from the least to the largest x of any particle"},
      {"extent_y", "m", "likewise in y"},
      {"extent_z", "m", "likewise in z"}};
  return all;
}

std::vector<std::string> output_sources(const Simulation& simulation) {
  std::vector<std::string> names = recorded_sources(simulation);
  add_shape_measures(!simulation.scene().cloth.pins.empty(), names);
  return names;
}

std::vector<std::string> output_sources(const Scene& scene) {
  Scene small = scene;  // of a grid the columns follow from its blocks, not from its size
  small.integrator.time_step = scene.record.interval;  // "auto" may find none
  if (!scene.cloth.is_mesh()) {
    small.cloth.rows = small.cloth.columns = 3;
    small.cloth.pins.clear();
    small.probes.clear();
  }
  std::vector<std::string> names = recorded_sources(Simulation(small));
  if (!scene.cloth.is_mesh())
    for (std::string& column : probe_columns(scene.probes)) names.push_back(std::move(column));
  add_shape_measures(!scene.cloth.pins.empty(), names);
  return names;
}

std::vector<double> output_values(const std::vector<std::string>& sources, const Simulation& simulation,
                                  const Measurement& row) {
  RowShape shape(simulation);
  std::vector<double> values;
  values.reserve(sources.size());
  for (const std::string& source : sources) {
    const auto recorded = recorded_value(source, row, simulation.quantities());
    values.push_back(recorded ? *recorded : shape.value_of(source));
  }
  return values;
}

double value_of_output(const std::string& source, const Simulation& simulation, const Measurement& row) {
  return output_values({source}, simulation, row).front();
}

std::optional<std::string> broken_outputs_rule(const std::vector<std::string>& outputs,
                                               const std::vector<std::string>& known) {
  if (outputs.empty()) return "must name at least one";
  for (std::size_t k = 0; k < outputs.size(); ++k) {
    if (std::find(known.begin(), known.end(), parse_output(outputs[k]).of) == known.end())
      return fmt::format("{}: must be one of {}, alone or with {}", outputs[k], fmt::join(known, ", "),
                         fmt::join(output_endings(), ", "));
    const auto here = outputs.begin() + static_cast<std::ptrdiff_t>(k);
    if (std::find(outputs.begin(), here, outputs[k]) != here)
      return fmt::format("{}: is there twice", outputs[k]);
  }
  return std::nullopt;
}

std::string unit_of_output(const std::string& output) {
  const std::string source = parse_output(output).of;
  for (const ShapeMeasure& measure : shape_measures())
    if (source == measure.name) return measure.unit;
  if (const auto words = words_of_probe_column(source)) return words->unit;
  for (const auto& [ending, unit] : {std::pair{"_J", "J"}, {"_Ns", "N s"}, {"_m", "m"}, {"_s", "s"}})
    if (source.ends_with(ending)) return unit;
  return "";
}

void OutputReducer::add(double time, double value) {
  if (output_.reduce == Reduction::rms) {
    add_measured(time, value);
  } else if (time < output_.from || time > output_.to) {
    return;
  } else if (has_bound(output_.reduce)) {
    add_crossing(time, value);
  } else if (output_.reduce == Reduction::mean) {
    if (any_) {
      integral_ += 0.5 * (value + value_before_) * (time - time_before_);
      length_ += time - time_before_;
    }
  } else if (!any_ || output_.reduce == Reduction::final_value) {
    result_ = value;
  } else {
    // A value that is not a number stays one: it must not get lost among the others.
    const bool is_better = output_.reduce == Reduction::maximum ? value > result_ : value < result_;
    if (is_better || std::isnan(value)) result_ = value;
  }
  any_ = true;
  time_before_ = time;
  value_before_ = value;
}

void OutputReducer::add(const Simulation& simulation, const Measurement& row) {
  add(row.time, value_of_output(output_.of, simulation, row));
}

void OutputReducer::add_crossing(double time, double value) {
  const double sign = output_.reduce == Reduction::first_above ? 1 : -1;
  const double beyond = sign * (value - output_.bound);
  if (!(beyond > 0)) {
    // What has passed the bound before is not on that side to the end.
    if (output_.reduce == Reduction::stays_below) found_ = false;
    return;
  }
  if (found_) return;
  found_ = true;
  result_ = time;
  if (!any_) return;
  const double before = sign * (value_before_ - output_.bound);
  result_ = time_before_ + (time - time_before_) * (before / (before - beyond));
}

void OutputReducer::add_measured(double time, double value) {
  const MeasuredCurve& curve = output_.measured;
  // A run whose duration is no whole number of steps may end a rounding error before the curve does.
  const double reach = time * (1 + 1e-9);
  for (; next_ < curve.times.size() && curve.times[next_] <= reach; ++next_) {
    const double at = curve.times[next_];
    const double part = any_ && time > time_before_ ? (at - time_before_) / (time - time_before_) : 1;
    const double simulated = any_ ? value_before_ + part * (value - value_before_) : value;
    squares_ += (simulated - curve.values[next_]) * (simulated - curve.values[next_]);
  }
}

double OutputReducer::result() const {
  if (output_.reduce == Reduction::rms) {
    const std::size_t size = output_.measured.times.size();
    return size > 0 && next_ == size ? std::sqrt(squares_ / static_cast<double>(size)) : no_output;
  }
  if (!any_) return no_output;
  if (has_bound(output_.reduce)) return found_ ? result_ : no_output;
  if (output_.reduce == Reduction::mean) return length_ > 0 ? integral_ / length_ : value_before_;
  return result_;
}

}  // namespace cloth

#include "sweep/sweep_output.h"

#include <algorithm>
#include <cmath>

#include "measure/droop.h"
#include "simulation/recorder.h"

namespace cloth {
namespace {

constexpr double no_output = std::numeric_limits<double>::quiet_NaN();

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
    return extent().maxCoeff();
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

bool is_shape_measure(const std::string& name) {
  const auto& all = shape_measures();
  return std::any_of(all.begin(), all.end(), [&](const ShapeMeasure& known) { return known.name == name; });
}

}  // namespace

const std::vector<std::string>& reduction_names() {
  static const std::vector<std::string> names{"final",       "max",         "min", "mean",
                                              "first-above", "first-below", "rms"};
  return names;
}

const std::string& name_of(Reduction reduction) {
  return reduction_names()[static_cast<std::size_t>(reduction)];
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
  std::vector<std::string> names = record_columns(simulation.quantities());
  std::erase(names, "step_time_us");  // of the machine: no two runs agree in it
  for (const ShapeMeasure& measure : shape_measures())
    if (std::find(names.begin(), names.end(), measure.name) == names.end()) names.emplace_back(measure.name);
  return names;
}

std::vector<double> output_values(const std::vector<std::string>& names, const Simulation& simulation,
                                  const Measurement& row) {
  RowShape shape(simulation);
  std::vector<double> values;
  values.reserve(names.size());
  for (const std::string& name : names) {
    const auto recorded = recorded_value(name, row, simulation.quantities());
    values.push_back(recorded ? *recorded : is_shape_measure(name) ? shape.value_of(name) : no_output);
  }
  return values;
}

void OutputReducer::add(double time, double value) {
  if (output_->reduce == Reduction::rms) {
    add_measured(time, value);
  } else if (time < output_->from || time > output_->to) {
    return;
  } else if (output_->reduce == Reduction::first_above || output_->reduce == Reduction::first_below) {
    add_crossing(time, value);
  } else if (output_->reduce == Reduction::mean) {
    if (any_) {
      integral_ += 0.5 * (value + value_before_) * (time - time_before_);
      length_ += time - time_before_;
    }
  } else if (!any_ || output_->reduce == Reduction::final_value) {
    result_ = value;
  } else {
    // A value that is not a number stays one: it must not get lost among the others.
    const bool is_better = output_->reduce == Reduction::maximum ? value > result_ : value < result_;
    if (is_better || std::isnan(value)) result_ = value;
  }
  any_ = true;
  time_before_ = time;
  value_before_ = value;
}

void OutputReducer::add_crossing(double time, double value) {
  const double sign = output_->reduce == Reduction::first_above ? 1 : -1;
  const double beyond = sign * (value - output_->bound);
  if (found_ || !(beyond > 0)) return;
  found_ = true;
  result_ = time;
  if (!any_) return;
  const double before = sign * (value_before_ - output_->bound);
  result_ = time_before_ + (time - time_before_) * (before / (before - beyond));
}

void OutputReducer::add_measured(double time, double value) {
  const MeasuredCurve& curve = output_->measured;
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
  if (output_->reduce == Reduction::rms) {
    const std::size_t size = output_->measured.times.size();
    return size > 0 && next_ == size ? std::sqrt(squares_ / static_cast<double>(size)) : no_output;
  }
  if (!any_) return no_output;
  if (output_->reduce == Reduction::first_above || output_->reduce == Reduction::first_below)
    return found_ ? result_ : no_output;
  if (output_->reduce == Reduction::mean) return length_ > 0 ? integral_ / length_ : value_before_;
  return result_;
}

}  // namespace cloth

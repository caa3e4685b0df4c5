#include "study/grid_output.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "measure/droop.h"
#include "simulation/recorder.h"

namespace cloth {
namespace {

constexpr const char *lowest_name = "lowest_point_m", *droop_name = "droop_m", *ratio_name = "droop_ratio";
constexpr std::array<const char*, 4> over_names{"", ":max", ":min", ":mean"};

}  // namespace

double value_of_quantity(const std::string& quantity, const Simulation& simulation, const Measurement& row) {
  if (const auto value = recorded_value(quantity, row, simulation.quantities())) return *value;
  const Droop droop =
      measure_droop(simulation.system(), simulation.state().position, gravity_of(simulation.scene()));
  if (quantity == lowest_name) return droop.lowest;
  if (quantity == droop_name) return droop.drop;
  return quantity == ratio_name ? droop.ratio() : NAN;
}

GridOutput parse_output(const std::string& text) {
  for (std::size_t over = 1; over < over_names.size(); ++over)
    if (text.ends_with(over_names[over]))
      return {text.substr(0, text.size() - std::string(over_names[over]).size()),
              static_cast<OverTime>(over)};
  return {text, OverTime::at_end};
}

std::vector<std::string> output_quantities(const Scene& scene) {
  Scene small = scene;  // the columns follow from its blocks, not from its size
  small.cloth.rows = small.cloth.columns = 3;
  small.cloth.pins.clear();
  small.probes.clear();
  small.integrator.time_step = scene.record.interval;  // "auto" may find none
  std::vector<std::string> known = record_columns(Simulation(small).quantities());
  std::erase(known, "step_time_us");
  for (std::string& column : probe_columns(scene.probes)) known.push_back(std::move(column));
  known.emplace_back(lowest_name);
  if (!scene.cloth.pins.empty()) known.insert(known.end(), {droop_name, ratio_name});
  return known;
}

std::optional<std::string> broken_outputs_rule(const std::vector<std::string>& outputs,
                                               const std::vector<std::string>& known) {
  if (outputs.empty()) return "must name at least one";
  for (std::size_t k = 0; k < outputs.size(); ++k) {
    if (std::find(known.begin(), known.end(), parse_output(outputs[k]).quantity) == known.end())
      return fmt::format("{}: must be one of {}, alone or with :max, :min or :mean", outputs[k],
                         fmt::join(known, ", "));
    if (std::find(outputs.begin(), outputs.begin() + static_cast<std::ptrdiff_t>(k), outputs[k]) !=
        outputs.begin() + static_cast<std::ptrdiff_t>(k))
      return fmt::format("{}: is there twice", outputs[k]);
  }
  return std::nullopt;
}

std::string unit_of_output(const std::string& output) {
  const std::string quantity = parse_output(output).quantity;
  if (const auto words = words_of_probe_column(quantity)) return words->unit;
  for (const auto& [ending, unit] : {std::pair{"_J", "J"}, {"_Ns", "N s"}, {"_m", "m"}, {"_s", "s"}})
    if (quantity.ends_with(ending)) return unit;
  return "";
}

void OutputReading::add(const Simulation& simulation, const Measurement& row) {
  const double value = value_of_quantity(output_.quantity, simulation, row);
  if (rows_++ == 0) {
    first_time_ = row.time;
    extreme_ = value;
  } else {
    integral_ += (row.time - last_time_) * (last_ + value) / 2;
    const bool is_beyond = output_.over == OverTime::minimum ? value < extreme_ : value > extreme_;
    if (is_beyond || std::isnan(value)) extreme_ = value;
  }
  last_time_ = row.time;
  last_ = value;
}

double OutputReading::value() const {
  if (rows_ == 0) return NAN;
  if (output_.over == OverTime::at_end) return last_;
  if (output_.over != OverTime::mean) return extreme_;
  return last_time_ > first_time_ ? integral_ / (last_time_ - first_time_) : last_;
}

}  // namespace cloth

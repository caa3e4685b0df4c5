#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "io/machine.h"
#include "scene/scene_json.h"
#include "study/work_precision_report.h"

namespace cloth {
namespace {

using json = nlohmann::ordered_json;

std::string number_or_empty(double value, bool there = true) {
  return there && std::isfinite(value) ? csv_number(value) : "";
}

json finite(double value) {
  return std::isfinite(value) ? json(value) : json(nullptr);
}

json run_json(const WorkPrecisionRun& run) {
  json object{{"time_step_s", finite(run.time_step)},
              {"steps", run.steps},
              {"status", name_of(run.status)},
              {"force_evaluations", run.count.force_evaluations},
              {"factorisations", run.count.factorisations},
              {"iterations", run.count.iterations},
              {"linear_iterations", run.count.linear_iterations},
              {"rms_error_m", finite(run.error.rms_position)},
              {"largest_error_m", finite(run.error.largest_position)},
              {"rms_velocity_error_m_s", finite(run.error.rms_velocity)},
              {"wall_s", run.samples.empty() ? json(nullptr) : json(run.time.least)},
              {"wall_median_s", run.samples.empty() ? json(nullptr) : json(run.time.median)},
              {"repeats", run.samples.size()}};
  if (run.tolerance > 0) object["tolerance"] = run.tolerance;
  if (!run.detail.empty()) object["detail"] = run.detail;
  return object;
}

json method_json(const MethodStudy& method) {
  const OrderEstimate& order = method.order;
  json object{{"name", method.ladder.facts.name},
              {"nominal_order", method.ladder.facts.order},
              {"observed_order", order.asymptotic ? json(order.order.value) : json("pre-asymptotic")},
              {"stable_step_s", finite(method.ladder.limit.value_or(NAN))},
              {"runs", json::array()}};
  if (order.asymptotic)
    object["order_standard_error"] = order.order.standard_error;
  else
    object["order_reason"] = order.reason;
  for (const WorkPrecisionRun& run : method.runs) object["runs"].push_back(run_json(run));
  return object;
}

json cheapest_json(const WorkPrecision& study) {
  json list = json::array();
  for (const double error : wanted_errors()) {
    const auto best = cheapest(study, error);
    if (!best) continue;
    const ErrorCost cost = cost_of(study.methods[*best], error).value();
    list.push_back({{"rms_error_m", error},
                    {"method", study.methods[*best].ladder.facts.name},
                    {"wall_s", cost.seconds},
                    {"time_step_s", cost.time_step}});
  }
  return list;
}

json machine_json() {
  const MachineFacts facts = machine_facts();
  return {{"processor", facts.processor},   {"cores", facts.cores}, {"compiler", facts.compiler},
          {"build_type", facts.build_type}, {"flags", facts.flags}, {"system", facts.operating_system},
          {"version", facts.version},       {"date", facts.date}};
}

}  // namespace

void visit_fields(CsvFields& fields, WorkPrecisionRun& run, const WorkPrecision& study,
                  const MethodStudy& method) {
  const bool timed = !run.samples.empty();
  const bool ran = run.status != RunStatus::refused;
  const auto time = [&](const char* name, double seconds) {
    fields.derived(name, number_or_empty(seconds, timed));
  };
  const OrderEstimate& order = method.order;
  fields.derived("method", method.ladder.facts.name);
  fields.finite("time_step", run.time_step);
  fields.whole("steps", run.steps, ran || run.steps > 0);
  fields.whole("force_evaluations", run.count.force_evaluations, ran);
  time("wall_s", run.time.least);
  fields.finite("rms_error_m", run.error.rms_position);
  fields.derived("relative_error", number_or_empty(run.error.rms_position / study.diagonal));
  fields.status(run.status, run_status_names);
  fields.derived("observed_order", order.asymptotic ? csv_number(order.order.value) : "pre-asymptotic");
  fields.derived("order_standard_error", number_or_empty(order.order.standard_error, order.asymptotic));
  fields.derived("overall_slope", number_or_empty(order.overall.value, order.overall.points > 1));
  fields.finite("largest_error_m", run.error.largest_position);
  fields.finite("rms_velocity_error_m_s", run.error.rms_velocity);
  fields.finite("energy_error_J", run.energy_error);
  fields.whole("factorisations", run.count.factorisations, ran);
  fields.whole("iterations", run.count.iterations, ran);
  fields.whole("linear_iterations", run.count.linear_iterations, ran);
  fields.whole("velocity_iterations", run.count.velocity_iterations, ran);
  fields.whole("limiter_sweeps", run.count.limiter_sweeps, ran);
  fields.whole("limiter_iterations", run.limiter_iterations, ran);
  fields.whole("rejected_steps", run.count.rejected_steps, ran);
  time("wall_median_s", run.time.median);
  time("wall_lower_quartile_s", run.time.lower_quartile);
  time("wall_upper_quartile_s", run.time.upper_quartile);
  fields.derived("repeats", std::to_string(run.samples.size()));
  fields.number("tolerance", run.tolerance, run.tolerance > 0, 0.0);
  fields.derived("stable_step_s", number_or_empty(method.ladder.limit.value_or(NAN)));
  fields.text("detail", run.detail);
  fields.whole("rung", run.rung, true, -1, 60);
  if (fields.has("estimated_s")) fields.number("estimated_s", run.estimated, ran, 0.0);  // not in old ones
}

void visit_fields(CsvFields& fields, TimedSample& sample, const MethodStudy& method,
                  const WorkPrecisionRun& run) {
  fields.derived("method", method.ladder.facts.name);
  fields.derived("time_step", csv_number(run.time_step));
  fields.derived("steps", std::to_string(run.steps));
  fields.derived("tolerance", number_or_empty(run.tolerance, run.tolerance > 0));
  fields.whole("repeat", sample.repeat, true, 0, 1'000'000);
  fields.whole("turn", sample.turn, true, 0, 1'000'000);
  fields.number("wall_s", sample.seconds);
}

CsvTable table_of(const WorkPrecision& study) {
  CsvTable table{written(WorkPrecisionRun{}, study, MethodStudy{}).names, {}};
  for (const MethodStudy& method : study.methods)
    for (const WorkPrecisionRun& run : method.runs) table.rows.push_back(written(run, study, method).texts);
  return table;
}

CsvTable sample_table(const WorkPrecision& study) {
  CsvTable table{written(TimedSample{}, MethodStudy{}, WorkPrecisionRun{}).names, {}};
  for (const MethodStudy& method : study.methods)
    for (const WorkPrecisionRun& run : method.runs)
      for (const TimedSample& sample : run.samples) table.rows.push_back(written(sample, method, run).texts);
  return table;
}

std::string study_json(const WorkPrecision& study) {
  const ReferenceSolution& reference = study.reference;
  json root{{"title", study.scene.title},
            {"scene_hash", scene_hash(study.scene)},
            {"status", study.stopped               ? "stopped"
                       : reference.failure.empty() ? "finished"
                                                   : "no reference"},
            {"particles", study.particles},
            {"horizon_s", study.horizon},
            {"sample_times", study.samples},
            {"repeats", study.repeats},
            {"smooth", reference.smooth},
            {"reference", reference.first},
            {"reference_check", reference.second},
            {"floor_rms_m", reference.floor.rms_position},
            {"floor_largest_m", reference.floor.largest_position},
            {"excited_frequency_per_s", reference.excited_frequency},
            {"cheapest", cheapest_json(study)},
            {"methods", json::array()},
            {"machine", machine_json()}};
  if (study.parts > 0) root["parts"] = study.parts;
  if (!reference.failure.empty()) root["failure"] = reference.failure;
  for (const MethodStudy& method : study.methods) root["methods"].push_back(method_json(method));
  return root.dump(2) + "\n";
}

const std::vector<double>& wanted_errors() {
  static const std::vector<double> errors{1e-2, 1e-3, 1e-4, 1e-5, 1e-6, 1e-7, 1e-8};
  return errors;
}

std::optional<ErrorCost> cost_of(const MethodStudy& method, double error) {
  const WorkPrecisionRun* before = nullptr;
  for (const WorkPrecisionRun& run : method.runs) {
    if (!run.reached_horizon() || run.samples.empty() || run.rung < 0) continue;
    if (run.error.rms_position > error) {
      before = &run;
      continue;
    }
    if (!before) return ErrorCost{run.time.least, run.time_step, true};
    const double part = std::log(before->error.rms_position / error) /
                        std::log(before->error.rms_position / run.error.rms_position);
    const auto between = [&](double a, double b) { return a * std::pow(b / a, part); };
    return ErrorCost{between(before->time.least, run.time.least), between(before->time_step, run.time_step),
                     false};
  }
  return std::nullopt;
}

std::optional<std::size_t> cheapest(const WorkPrecision& study, double error) {
  std::optional<std::size_t> best;
  double least = INFINITY;
  for (std::size_t m = 0; m < study.methods.size(); ++m) {
    const auto cost = cost_of(study.methods[m], error);
    if (!cost || !(cost->seconds < least)) continue;
    least = cost->seconds;
    best = m;
  }
  return best;
}

std::string study_text(const WorkPrecision& study) {
  std::string text =
      fmt::format("{}\n{:.6g} s simulated, {} sample times; reference trusted to {:.2g} m (RMS)\n\n",
                  study.scene.title, study.horizon, study.samples, study.reference.floor.rms_position);
  text += fmt::format("  {:<22} {:>5}  {:<15} {:>4} {:>11} {:>11} {:>10}\n", "method", "order", "observed",
                      "runs", "best RMS", "its step", "its time");
  for (const MethodStudy& method : study.methods) {
    const WorkPrecisionRun* best = nullptr;
    int done = 0;
    for (const WorkPrecisionRun& run : method.runs) {
      if (!run.reached_horizon()) continue;
      ++done;
      if (!best || run.error.rms_position < best->error.rms_position) best = &run;
    }
    text += fmt::format("  {:<22} {:>5}  {:<15} {:>4}", method.ladder.facts.name, method.ladder.facts.order,
                        order_text(method.order), done);
    if (best)
      text += fmt::format(" {:>9.2e} m {:>9.3g} s {:>8.2g} s", best->error.rms_position, best->time_step,
                          best->time.least);
    text += "\n";
  }
  text += "\nCheapest for an RMS position error of\n";
  for (const double error : wanted_errors())
    if (const auto best = cheapest(study, error)) {
      const ErrorCost cost = cost_of(study.methods[*best], error).value();
      text += fmt::format("  {:.0e} m  {:<22} {:.2g} s{}\n", error, study.methods[*best].ladder.facts.name,
                          cost.seconds, cost.at_first_run ? " (its longest step is better than that)" : "");
    }
  return text;
}

}  // namespace cloth

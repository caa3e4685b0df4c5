#include "bench/peers/peer_tables.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "bench/speed/bench_page.h"

namespace cloth::peers {
namespace {

using json = nlohmann::ordered_json;
using speed::number;
using speed::Page;

std::string iterations_text(const PeerSeries& series) {
  return series.iterations > 0 ? std::to_string(series.iterations) : "";
}

/// "1.2e-04"
std::string error_text(double error) {
  return std::isfinite(error) ? fmt::format("{:.2g}", error) : "-";
}

TextTable run_table(const PeerScene& scene) {
  TextTable table;
  table.columns = {{"Program"},          {"Method"},          {"Step (ms)", true},
                   {"Iterations", true}, {"Error (m)", true}, {"Largest (m)", true},
                   {"ms / s", true},     {"Quartiles", true}, {"Remark"}};
  for (const PeerSeries& series : scene.series)
    for (const PeerRun& run : series.runs) {
      std::vector<double> costs;
      for (const double seconds : run.seconds) costs.push_back(1e3 * seconds / scene.horizon);
      const speed::Spread spread = speed::spread_of(costs);
      table.rows.push_back(
          {series.program, series.method, fmt::format("{:.4g}", 1e3 * run.time_step), iterations_text(series),
           error_text(run.error.rms_position), error_text(run.error.largest_position),
           costs.empty() ? "" : number(spread.median),
           costs.empty() ? "" : number(spread.low) + " to " + number(spread.high), run.failure});
    }
  return table;
}

std::string time_text(const std::optional<TimeToError>& time) {
  if (!time) return "not reached";
  return (time->is_bound ? "<= " : "") + number(time->milliseconds);
}

TextTable time_table(const PeerScene& scene) {
  TextTable table;
  table.columns = {{"Program"}, {"Method"}, {"Iterations", true}};
  const std::vector<double> decades = error_decades(scene);
  for (const double error : decades) table.columns.push_back({fmt::format("{:.0e} m", error), true});
  for (const PeerSeries& series : scene.series) {
    std::vector<std::string> row{series.program, series.method, iterations_text(series)};
    for (const double error : decades) row.push_back(time_text(time_to_error(series, error, scene.horizon)));
    table.rows.push_back(row);
  }
  return table;
}

std::string first_text(const std::optional<FirstThere>& first) {
  if (!first) return "not reached";
  const PeerSeries& series = *first->series;
  const std::string iterations = series.iterations > 0 ? fmt::format(" ({})", series.iterations) : "";
  return fmt::format("{} {}{}", time_text(first->time), series.method, iterations);
}

std::vector<std::string> programs_of(const PeerScene& scene) {
  std::vector<std::string> programs;
  for (const PeerSeries& series : scene.series)
    if (std::find(programs.begin(), programs.end(), series.program) == programs.end())
      programs.push_back(series.program);
  return programs;
}

/// The fastest of each program, and the first program's time under each other's.
TextTable first_table(const PeerScene& scene) {
  TextTable table;
  table.columns = {{"Error", true}};
  const std::vector<std::string> programs = programs_of(scene);
  for (const std::string& program : programs) table.columns.push_back({program + " (ms / s)"});
  for (std::size_t k = 1; k < programs.size(); ++k)
    table.columns.push_back({programs[k] + " / " + programs[0], true});
  for (const double error : error_decades(scene)) {
    std::vector<std::string> row{fmt::format("{:.0e} m", error)};
    for (const std::string& program : programs) row.push_back(first_text(first_there(scene, program, error)));
    const auto ours = first_there(scene, programs[0], error);
    for (std::size_t k = 1; k < programs.size(); ++k) {
      const auto theirs = first_there(scene, programs[k], error);
      const bool both = ours && theirs;
      row.push_back(both ? number(theirs->time.milliseconds / ours->time.milliseconds) : "");
    }
    table.rows.push_back(row);
  }
  return table;
}

void add_scene(Page& page, const PeerScene& scene) {
  page.heading(fmt::format("{0}, {1} x {1}", scene.name, scene.size));
  page.paragraph(fmt::format(
      "{}; {:g} s, errors at {} times: root mean square of the distances of all particles to the reference. "
      "Reference: {}; checked by {}: {:.2g} m apart.",
      scene.title, scene.horizon, scene.samples, scene.reference.first, scene.reference.second,
      scene.reference.floor.rms_position));
  page.table(run_table(scene));
  page.heading(fmt::format("{0}, {1} x {1}: time to an error (ms / s)", scene.name, scene.size));
  page.paragraph(
      "Between two steps that were run, logarithms are interpolated; \"<=\" where the longest step is more "
      "exact "
      "already; \"not reached\" where no step that was run is as exact.");
  page.table(time_table(scene));
  page.heading(fmt::format("{0}, {1} x {1}: the fastest of each program", scene.name, scene.size));
  page.table(first_table(scene));
}

const char* const what_is_compared =
    "Processor time of the steps alone, one thread, medians of rounds in turns, in ms for each second "
    "simulated. Each run of Bullet is a process of its own, warmed up by 20 steps. Clothlab, "
    "springs-explicit "
    "and springs-implicit solve the same equations, forces in N/m. links is position based: its limit is an "
    "inextensible cloth, or depends on the step, so that its error levels off; links-by-stiffness takes "
    "kLST = 1 - (1 + h^2 k (1/m1 + 1/m2))^(-1 / passes), with which one link alone moves as by backward "
    "Euler, "
    "but the force of a link is not quite linear. Iterations: passes over the links, or at most so many of "
    "Newton's method.";

std::string built(const PeerReport& report, bool markdown) {
  Page page(markdown);
  const MachineFacts& machine = report.machine;
  page.paragraph(fmt::format("Clothlab {}, {}, {}; {}, {} cores; {}", machine.version, machine.compiler,
                             machine.build_type, machine.processor, machine.cores,
                             fmt::join(report.versions, "; ")));
  page.paragraph(what_is_compared);
  if (!report.complete) page.paragraph("Interrupted: this is what was finished.");
  for (const PeerScene& scene : report.scenes) add_scene(page, scene);
  std::string text = page.take();
  return markdown ? text.substr(1) : text;
}

json finite(double value) {
  return std::isfinite(value) ? json(value) : json();
}

json run_json(const PeerRun& run, double horizon) {
  return {{"time_step_s", run.time_step},
          {"steps", run.steps},
          {"error_rms_m", finite(run.error.rms_position)},
          {"error_largest_m", finite(run.error.largest_position)},
          {"error_rms_m_per_s", finite(run.error.rms_velocity)},
          {"processor_ms_per_simulated_s", run.seconds.empty() ? json() : json(run.cost(horizon))},
          {"processor_s", run.seconds},
          {"failure", run.failure.empty() ? json() : json(run.failure)}};
}

json series_json(const PeerSeries& series, const PeerScene& scene) {
  json object{{"program", series.program},
              {"method", series.method},
              {"iterations", series.iterations > 0 ? json(series.iterations) : json()},
              {"runs", json::array()},
              {"time_to_error", json::array()}};
  for (const PeerRun& run : series.runs) object["runs"].push_back(run_json(run, scene.horizon));
  for (const double error : error_decades(scene)) {
    const auto time = time_to_error(series, error, scene.horizon);
    object["time_to_error"].push_back(
        {{"error_m", error},
         {"processor_ms_per_simulated_s", time ? json(time->milliseconds) : json()},
         {"is_upper_bound", time ? json(time->is_bound) : json()}});
  }
  return object;
}

}  // namespace

std::vector<double> error_decades(const PeerScene& scene) {
  const double floor = scene.reference.floor.rms_position;
  double least = 1, most = 0;
  for (const PeerSeries& series : scene.series)
    for (const PeerRun& run : series.runs)
      if (run.is_measured() && run.error.rms_position > 0)
        least = std::min(least, run.error.rms_position), most = std::max(most, run.error.rms_position);
  std::vector<double> decades;
  for (int power = -1; power >= -12; --power)
    if (const double error = std::pow(10, power); error >= std::max(least, floor) && error < most)
      decades.push_back(error);
  return decades;
}

std::string peer_text(const PeerReport& report) {
  return built(report, false);
}

std::string peer_markdown(const PeerReport& report) {
  return built(report, true);
}

std::string peer_json(const PeerReport& report) {
  json object{{"machine",
               {{"processor", report.machine.processor},
                {"cores", report.machine.cores},
                {"operating_system", report.machine.operating_system},
                {"compiler", report.machine.compiler},
                {"flags", report.machine.flags},
                {"build", report.machine.build_type},
                {"date", report.machine.date}}},
              {"clothlab", report.machine.version},
              {"libraries", report.versions},
              {"complete", report.complete},
              {"repeats", report.repeats},
              {"peers", json::array()}};
  for (const PeerScene& scene : report.scenes) {
    json one{{"scene", scene.name},
             {"size", scene.size},
             {"horizon_s", scene.horizon},
             {"samples", scene.samples},
             {"reference", scene.reference.first},
             {"checked_by", scene.reference.second},
             {"reference_floor_rms_m", scene.reference.floor.rms_position},
             {"series", json::array()}};
    for (const PeerSeries& series : scene.series) one["series"].push_back(series_json(series, scene));
    object["peers"].push_back(std::move(one));
  }
  return object.dump(2) + "\n";
}

}  // namespace cloth::peers

// What Table 1 leaves out: the time that each method needs for the same error; and the orders that are left
// once the deformation is limited.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "integrators/registry.h"
#include "simulation/step_batches.h"
#include "study/reproduce/study_page.h"

namespace cloth {
namespace {

constexpr int runs_of_each = 3;

struct Rung {
  int steps = 0;
  double error = 0;    ///< m
  double seconds = 0;  ///< least of all runs
};
struct Ladder {
  std::string method;
  std::vector<Rung> rungs;  ///< from the longest step down
};

struct Outcome {
  Vec3Field position;
  double seconds = 0;
};

std::optional<Outcome> run_steps(Scene scene, const std::string& method, int steps, StudyPage& study,
                                 double fraction) {
  scene.integrator.method = method;
  scene.integrator.time_step = scene.duration / steps;
  Simulation simulation(scene);
  StepBatches batches(simulation, [&] { return !study.go_on(fraction); });
  if (!batches.run_to(steps)) return std::nullopt;
  return Outcome{simulation.state().position, batches.seconds()};
}

struct TimeFor {
  double seconds = 0, step = 0;
  enum class From { between, extrapolated, stability } from = From::between;
};

/// Log-log between the two rungs around the error; beyond the last rung along the method's own order. Where
/// even the longest step is more accurate than wanted, that step: stability decides.
TimeFor time_for(const Ladder& ladder, double wanted, double horizon) {
  const auto& rungs = ladder.rungs;
  const auto step_of = [&](const Rung& rung) { return horizon / rung.steps; };
  if (rungs.front().error <= wanted)
    return {rungs.front().seconds, step_of(rungs.front()), TimeFor::From::stability};
  for (std::size_t k = 1; k < rungs.size(); ++k) {
    if (rungs[k].error > wanted) continue;
    const double part = std::log(rungs[k - 1].error / wanted) / std::log(rungs[k - 1].error / rungs[k].error);
    const auto blend = [&](double a, double b) { return a * std::pow(b / a, part); };
    return {blend(rungs[k - 1].seconds, rungs[k].seconds), blend(step_of(rungs[k - 1]), step_of(rungs[k]))};
  }
  const double factor = std::pow(rungs.back().error / wanted, 1.0 / facts_of(ladder.method).order);
  return {rungs.back().seconds * factor, step_of(rungs.back()) / factor, TimeFor::From::extrapolated};
}

HtmlCell time_cell(const TimeFor& time, double least) {
  const char* mark = time.from == TimeFor::From::extrapolated ? " *"
                     : time.from == TimeFor::From::stability  ? " †"
                                                              : "";
  return {HtmlText(time.seconds < 10 ? fmt::format("{:.3f} s{}", time.seconds, mark)
                                     : fmt::format("{:.0f} s{}", time.seconds, mark)),
          time.seconds == least ? Verdict::good : Verdict::none,
          fmt::format("with a step of {:.3g} ms", 1e3 * time.step)};
}

/// log2 of the last halving of the step whose errors stand clear of the reference's own.
double clear_order(const Ladder& ladder, double floor) {
  double order = 0;
  for (std::size_t k = 1; k < ladder.rungs.size(); ++k) {
    const Rung &coarse = ladder.rungs[k - 1], &fine = ladder.rungs[k];
    if (fine.steps == 2 * coarse.steps && (order == 0 || fine.error > 10 * floor))
      order = std::log2(coarse.error / fine.error);
  }
  return order;
}

/// Returns the largest of the wanted errors at which Runge-Kutta 4 is the cheapest; 0: at none.
double add_wanted_table(const std::vector<Ladder>& ladders, double horizon, StudyPage& study) {
  double crossing = 0;
  HtmlTable table = number_table(
      "Time for a wanted error; coloured: the cheapest. † the longest stable step is more accurate than "
      "wanted; * extrapolated along the method's order",
      {"error wanted, m"});
  for (const Ladder& ladder : ladders) table.columns.push_back({facts_of(ladder.method).title, Align::right});
  for (const double wanted : {1e-3, 1e-4, 1e-5, 1e-6, 1e-7, 1e-8}) {
    std::vector<TimeFor> times;
    double least = std::numeric_limits<double>::infinity();
    for (const Ladder& ladder : ladders) {
      times.push_back(time_for(ladder, wanted, horizon));
      least = std::min(least, times.back().seconds);
      study.number(fmt::format("{}: time for an error of {:.0e} m", ladder.method, wanted),
                   times.back().seconds, "s");
    }
    HtmlRow row{{HtmlCell(html_number(wanted, 1))}};
    if (times[1].seconds == least) crossing = std::max(crossing, wanted);
    for (const TimeFor& time : times) row.cells.push_back(time_cell(time, least));
    table.rows.push_back(std::move(row));
  }
  study.page().table(table);
  return crossing;
}

LinePlot ladder_plot(const std::vector<Ladder>& ladders, double horizon, double floor, bool against_time) {
  LinePlot plot{
      .x = {.label = against_time ? "run time" : "time step", .unit = "s", .scale = AxisScale::logarithmic},
      .y = {.label = "root mean square error", .unit = "m", .scale = AxisScale::logarithmic},
      .plot_height = 380};
  if (floor > 0) plot.floor = PlotFloor{floor, "difference of two references"};
  for (const Ladder& ladder : ladders) {
    PlotSeries series{.name = facts_of(ladder.method).title,
                      .detail = fmt::format("order {}, observed {:.2f}", facts_of(ladder.method).order,
                                            clear_order(ladder, floor))};
    for (const Rung& rung : ladder.rungs)
      series.points.push_back({.x = against_time ? rung.seconds : horizon / rung.steps, .y = rung.error});
    plot.series.push_back(std::move(series));
  }
  return plot;
}

/// Every rung timed in turn with all others, `rounds` times; false where stopped.
bool climb(std::vector<Ladder>& ladders, const Scene& scene, const Vec3Field& reference, int rounds,
           StudyPage& study, double from, double to) {
  double total = 0, done = 0;
  for (const Ladder& ladder : ladders)
    for (const Rung& rung : ladder.rungs)
      total += rounds * rung.steps * facts_of(ladder.method).evaluations_per_step;
  for (int round = 0; round < rounds; ++round)
    for (Ladder& ladder : ladders)
      for (Rung& rung : ladder.rungs) {
        const auto outcome =
            run_steps(scene, ladder.method, rung.steps, study, from + (to - from) * done / total);
        if (!outcome) return false;
        done += rung.steps * facts_of(ladder.method).evaluations_per_step;
        rung.error = rms_distance(outcome->position, reference);
        rung.seconds = round == 0 ? outcome->seconds : std::min(rung.seconds, outcome->seconds);
      }
  return true;
}

std::vector<Ladder> make_ladders(const std::vector<int>& steps) {
  std::vector<Ladder> ladders;
  for (const char* method : report_methods) {
    ladders.push_back({method, {}});
    for (const int n : steps) ladders.back().rungs.push_back({.steps = n});
  }
  return ladders;
}

void add_smooth(StudyPage& study) {
  const Scene scene = scene_run("corners-free", {"duration=0.5"}).scene;
  const auto coarse = run_steps(scene, "rk4", 7200, study, 0);
  const auto fine = coarse ? run_steps(scene, "rk4", 14400, study, 0.1) : std::nullopt;
  if (!fine) return;
  const double floor = study.number("difference of two references, smooth",
                                    rms_distance(coarse->position, fine->position), "m");
  std::vector<Ladder> ladders = make_ladders({450, 900, 1800, 3600, 7200});
  for (Rung longest{.steps = 320}; Ladder & ladder : ladders)
    if (ladder.method == "rk4") ladder.rungs.insert(ladder.rungs.begin(), longest);
  if (!climb(ladders, scene, fine->position, runs_of_each, study, 0.3, 0.85)) return;
  for (const Ladder& ladder : ladders)
    study.number(ladder.method + ": observed order, smooth", clear_order(ladder, floor), "",
                 facts_of(ladder.method).order);
  LinePlot plot = ladder_plot(ladders, scene.duration, floor, true);
  plot.title = "Error against run time, nothing limited";
  plot.subtitle = fmt::format("corners-free, 33 x 33 particles, t = 0.5 s; least of {} runs", runs_of_each);
  study.plot("equal-error", plot,
             "The error after 0.5 s of simulated time against the time it took. The lower left is better.");
  const double crossing = add_wanted_table(ladders, scene.duration, study);
  study.number("Runge-Kutta 4 is the cheapest from this error down (0: never)", crossing, "m");
  study.page().paragraph(
      HtmlText("The reference is Runge-Kutta 4 with 14400 steps; with 7200 it differs by ") +
      html_number(floor, 2) +
      " m. Where a rough picture is enough, stability decides and not accuracy: the longest stable step is "
      "already better than wanted, and a cheap step wins. Semi-implicit Euler, whose step costs no more than "
      "Verlet's, pays for its order 1 as "
      "soon as accuracy counts. " +
      (crossing > 0
           ? HtmlText("Runge-Kutta 4, the dearest method in Table 1, is the cheapest from an error of ") +
                 html_number(crossing, 1) + " m down."
           : HtmlText("Runge-Kutta 4 is not the cheapest for any error in the table.")));
}

void add_limited(StudyPage& study) {
  study.page().heading("With the deformation limited: order 1 for all", 3);
  const Scene scene = scene_run("corners-shear", {"cloth.rows=7", "cloth.columns=7", "duration=0.5",
                                                  "deformation.tolerance=1e-9", "deformation.rate=0.02",
                                                  "deformation.max_sweeps=100000"})
                          .scene;
  const auto reference = run_steps(scene, "rk4", 32000, study, 0.86);
  if (!reference) return;
  std::vector<Ladder> ladders = make_ladders({250, 500, 1000, 2000, 4000});
  if (!climb(ladders, scene, reference->position, 1, study, 0.9, 1)) return;
  LinePlot plot = ladder_plot(ladders, scene.duration, 0, false);
  plot.title = "Error against step with the deformation limited";
  plot.subtitle = "corners-shear with 7 x 7 particles and a rate of 2 %, t = 0.5 s";
  plot.triangles = {{1, "1"}};
  for (Ladder& ladder : ladders) {
    const double mean = std::log(ladder.rungs.front().error / ladder.rungs.back().error) / std::log(16.0);
    study.number(ladder.method + ": mean observed order, limited", mean, "", 1);
    PlotSeries& series = plot.series[static_cast<std::size_t>(&ladder - ladders.data())];
    series.detail = fmt::format("order {} → {:.2f} with limiting", facts_of(ladder.method).order, mean);
  }
  study.plot("limited-order", plot,
             "The limiter acts once a step, at its end: first order by construction, whatever the method "
             "under it. A higher order gains nothing here.");
}

}  // namespace

void reproduce_equal_error(StudyPage& study) {
  HtmlPage& page = study.page();
  page.heading("What Table 1 leaves out: time at equal error");
  page.paragraph(
      "The same step for every method compares the price of a step, not of a result. Here every method runs "
      "with a ladder of steps from just under its stability limit down.");
  add_smooth(study);
  if (study.go_on(0.85)) add_limited(study);
}

}  // namespace cloth

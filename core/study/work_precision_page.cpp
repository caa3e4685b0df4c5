#include <fmt/format.h>

#include <cmath>
#include <functional>

#include "report/html_page.h"
#include "scene/scene_json.h"
#include "study/work_precision_report.h"

namespace cloth {
namespace {

HtmlText seconds(double value) {
  return html_number(value, 3) + " s";
}

HtmlText metres(double value) {
  return html_number(value, 3) + " m";
}

void add_notices(const WorkPrecision& study, HtmlPage& page) {
  if (study.stopped)
    page.notice("The study was stopped before its end; tables and figures hold what was finished.",
                Verdict::warn);
  if (!study.reference.failure.empty() && !study.stopped)
    page.notice("There is no reference, so that there are no errors: " + study.reference.failure,
                Verdict::bad);
  if (study.parts > 0)
    page.notice(
        fmt::format("{} parts of this study were made and timed by processes of their own, on processors of "
                    "one name. Errors and counts do not depend on that; times of two methods can be compared "
                    "as far as nothing else slowed one of their processes.",
                    study.parts),
        Verdict::warn);
  if (!study.reference.smooth)
    page.notice(
        "The scene limits stretching or has obstacles. Projections at the end of a step are not smooth in "
        "time: "
        "expect first order from every method, whatever its order without them. The reference is the same "
        "loop "
        "with the same projections and a far finer step, so that what is measured is the error of time "
        "alone, "
        "not the difference between models. The limiter's tolerance is 1e-6 at most in all runs.",
        Verdict::warn);
}

void add_cheapest(const WorkPrecision& study, HtmlPage& page) {
  page.heading("Which method is cheapest for a wanted error");
  page.paragraph(
      "Run time for an RMS position error, read along each method's line of measured points. No value: the "
      "runs did not reach that error. In brackets: the longest step is already more accurate than that, so "
      "that this is the least time measured.");
  HtmlTable table{"Run time in seconds to an RMS position error", {{"Method"}}, {}};
  for (const double error : wanted_errors()) table.columns.push_back({metres(error), Align::right});
  for (std::size_t m = 0; m < study.methods.size(); ++m) {
    HtmlRow row;
    row.cells.emplace_back(study.methods[m].ladder.facts.title);
    for (const double error : wanted_errors()) {
      const auto cost = cost_of(study.methods[m], error);
      if (!cost) {
        row.cells.emplace_back("");
        continue;
      }
      const HtmlText time = html_number(cost->seconds, 2);
      const bool best = cheapest(study, error) == m;
      row.cells.emplace_back(cost->at_first_run ? "(" + time + ")" : time,
                             best ? Verdict::good : Verdict::none,
                             fmt::format("at a step of {:.3g} s", cost->time_step));
    }
    table.rows.push_back(row);
  }
  page.table(table);
}

std::string sentence_for(const WorkPrecision& study, double error) {
  const auto best = cheapest(study, error);
  if (!best) return "";
  const ErrorCost cost = cost_of(study.methods[*best], error).value();
  return fmt::format("{} at a step of {:.2g} s", study.methods[*best].ladder.facts.title, cost.time_step);
}

/// Runs of the same answer are one sentence.
void add_conclusions(const WorkPrecision& study, HtmlPage& page) {
  std::vector<HtmlText> items;
  for (const double error : wanted_errors())
    if (const std::string text = sentence_for(study, error); !text.empty())
      items.push_back("For " + metres(error) + ": " + html_strong(text) + ".");
  if (!items.empty()) {
    page.paragraph("On this machine, for this scene and this stretch of time, the cheapest was");
    page.list(items);
  }
  page.paragraph(
      "Read it with care: methods whose times differ by less than the bars are equal; another scene, "
      "stiffness "
      "or number of particles moves the lines; an error in position says nothing of energy or of strain.");
}

HtmlText limit_text(const StepLadder& ladder) {
  if (ladder.by_tolerance) return "by error control";
  if (!ladder.limit) return "none is stable";
  return std::isfinite(*ladder.limit) ? seconds(*ladder.limit) : HtmlText("any (linear theory)");
}

void add_orders(const WorkPrecision& study, HtmlPage& page) {
  page.heading("Observed orders");
  page.paragraph(
      "The order is the least-squares slope of ln(error) against ln(step) with its standard error, over a "
      "window "
      "of at least four steps that resolve the fastest excited motion (step times its frequency at most "
      "0.3), "
      "with errors above ten times the floor, whose orders between neighbours are monotone and differ by at "
      "most 0.1 (0.2 from order 4 on). Where there is no such window it says pre-asymptotic: the nominal "
      "order "
      "then says nothing about these steps.");
  HtmlTable table{"Orders of the errors in position and velocity",
                  {{"Method"},
                   {"Nominal", Align::right},
                   {"Position", Align::right},
                   {"Velocity", Align::right},
                   {"Between neighbouring steps"},
                   {"Longest stable step", Align::right},
                   {"Remark"}},
                  {}};
  for (const MethodStudy& method : study.methods) {
    std::string pairwise;
    for (const double p : method.order.pairwise)
      pairwise += fmt::format("{}{:.2f}", pairwise.empty() ? "" : ", ", p);
    table.rows.push_back(
        {{method.ladder.facts.title, std::to_string(method.ladder.facts.order), order_text(method.order),
          order_text(method.velocity_order), pairwise, limit_text(method.ladder), method.order.reason}});
  }
  page.table(table);
}

/// A column of the table of runs.
struct RunColumn {
  HtmlColumn head;
  std::function<HtmlCell(const WorkPrecisionRun&)> cell;
};

RunColumn count_column(const char* head, std::int64_t (*count)(const WorkPrecisionRun&)) {
  return {{head, Align::right}, [count](const WorkPrecisionRun& run) -> HtmlCell {
            const std::int64_t n = count(run);
            return n > 0 ? std::to_string(n) : std::string();
          }};
}

RunColumn number_column(const char* head, double (*value)(const WorkPrecisionRun&)) {
  return {{head, Align::right}, [value](const WorkPrecisionRun& run) -> HtmlCell {
            const double number = value(run);
            return number > 0 ? html_number(number) : HtmlText();
          }};
}

HtmlCell status_cell(const WorkPrecisionRun& run) {
  HtmlText what = name_of(run.status);
  if (run.tolerance > 0) what = what + ", tolerance " + html_number(run.tolerance, 1);
  if (run.rung < 0) what = what + ", beyond the limit";
  if (run.status == RunStatus::stable) return what;
  return {what, run.status == RunStatus::refused ? Verdict::warn : Verdict::bad, run.detail};
}

using Run = WorkPrecisionRun;

std::int64_t sum_over(const WorkPrecision& study, std::int64_t (*count)(const Run&)) {
  std::int64_t sum = 0;
  for (const MethodStudy& method : study.methods)
    for (const Run& run : method.runs) sum += count(run);
  return sum;
}

/// Counts that no run has are left out.
std::vector<RunColumn> run_columns(const WorkPrecision& study) {
  std::vector<RunColumn> columns{
      number_column("Step (s)", [](const Run& run) { return run.time_step; }),
      count_column("Steps", [](const Run& run) { return run.steps; }),
      count_column("Force evaluations", [](const Run& run) { return run.count.force_evaluations; })};
  const std::vector<std::pair<const char*, std::int64_t (*)(const Run&)>> counts{
      {"Factorisations", [](const Run& run) { return run.count.factorisations; }},
      {"Iterations", [](const Run& run) { return run.count.iterations + run.count.linear_iterations; }},
      {"Limiter", [](const Run& run) { return run.count.limiter_sweeps + run.limiter_iterations; }}};
  for (const auto& [head, count] : counts)
    if (sum_over(study, count) > 0) columns.push_back(count_column(head, count));
  columns.push_back(number_column("RMS error (m)", [](const Run& run) { return run.error.rms_position; }));
  columns.push_back(number_column("Largest (m)", [](const Run& run) { return run.error.largest_position; }));
  columns.push_back(number_column("Velocity (m/s)", [](const Run& run) { return run.error.rms_velocity; }));
  columns.push_back(number_column("Least time (s)", [](const Run& run) { return run.time.least; }));
  columns.push_back(number_column("Median (s)", [](const Run& run) { return run.time.median; }));
  columns.push_back({{"Status"}, status_cell});
  return columns;
}

/// Why runs failed or were refused, each in a sentence.
void add_causes(const WorkPrecision& study, HtmlPage& page) {
  std::vector<HtmlText> items;
  for (const MethodStudy& method : study.methods)
    for (const Run& run : method.runs)
      if (!run.detail.empty())
        items.push_back(html_strong(method.ladder.facts.title) +
                        (std::isfinite(run.time_step) ? " at " + seconds(run.time_step) : HtmlText()) + ": " +
                        name_of(run.status) + "; " + run.detail);
  if (items.empty()) return;
  page.heading("What failed, and why", 3);
  page.list(items);
}

void add_runs(const WorkPrecision& study, HtmlPage& page) {
  page.heading("Every run");
  page.paragraph("The same as " + html_code("work_precision.csv") +
                 ", which has quartiles too; every timed repeat is in " +
                 html_code("work_precision_samples.csv") + ".");
  HtmlTable table{"Runs, from each method's longest step to its shortest", {{"Method"}}, {}};
  const std::vector<RunColumn> columns = run_columns(study);
  for (const RunColumn& column : columns) table.columns.push_back(column.head);
  for (const MethodStudy& method : study.methods)
    for (const Run& run : method.runs) {
      HtmlRow row;
      row.cells.emplace_back(method.ladder.facts.title);
      for (const RunColumn& column : columns) row.cells.push_back(column.cell(run));
      table.rows.push_back(row);
    }
  page.begin_details(fmt::format("{} runs", table.rows.size()), true);
  page.table(table);
  page.end_details();
  add_causes(study, page);
}

void add_protocol(const WorkPrecision& study, HtmlPage& page) {
  const ReferenceSolution& reference = study.reference;
  page.heading("How it was measured");
  page.facts(
      {{"Scene", study.scene.title},
       {"Scene hash", html_code(scene_hash(study.scene))},
       {"Particles", std::to_string(study.particles)},
       {"Horizon", seconds(study.horizon) + ", a whole number of every fixed step"},
       {"Errors", fmt::format("at {} fixed times over the horizon, all particles", study.samples)},
       {"Reference", reference.first},
       {"Checked by", reference.second},
       {"Floor", metres(reference.floor.rms_position) + " RMS, " + metres(reference.floor.largest_position) +
                     " at most: what the two differ by"},
       {"Fastest excited motion", reference.smooth ? html_number(reference.excited_frequency) + " 1/s"
                                                   : HtmlText("not estimated: the motion is not smooth")},
       {"Steps",
        "halved from just under the stability limit, and one run beyond it; error control: tolerances "
        "from 0.01 down by tens"},
       {"Time", fmt::format("steady clock around the stepping loop only; each run once untimed as its "
                            "warm-up (it also gave errors and counts), then at least {} repeats, all runs "
                            "of a repeat in shuffled order, one thread; the least is plotted",
                            study.repeats)},
       {"Budget",
        fmt::format("{:.0f} s of estimated run time, {:.0f} s used. The estimate is made from counted "
                    "work, so that the same runs are made on every machine; runs that do not "
                    "fit are refused and listed",
                    study.budget, study.estimated)},
       {"Solvers",
        "Newton's method to a relative change of 1e-8; projective, XPBD and VBD with the scene's "
        "number of iterations"}});
  page.machine_facts();
  page.folded("The scene", write_scene(study.scene));
}

}  // namespace

std::string study_page(const WorkPrecision& study, const std::string& command, double) {
  HtmlPage page(
      "Error against run time: " + study.scene.title,
      "What an error costs with each method: every method with a series of steps, its errors against a "
      "reference that none of them made, its time around the stepping loop alone.");
  add_notices(study, page);
  page.heading("Error against run time");
  page.figure(
      to_svg(study_plot(study)),
      "Down and left is better. A line of slope -p belongs to order p. Marks in the row on top are runs "
      "that failed or were refused; rest the pointer on a mark for its numbers.",
      command);
  add_cheapest(study, page);
  add_conclusions(study, page);
  add_orders(study, page);
  page.figure(to_svg(study_plot(study, PlotAgainst::step)),
              "The same errors against the step: here the slope is the order itself.", command);
  page.figure(
      to_svg(study_plot(study, PlotAgainst::force_evaluations)),
      "The same errors against force evaluations, which do not depend on the machine. Implicit methods "
      "also solve equations, which this axis does not count.",
      command);
  add_runs(study, page);
  add_protocol(study, page);
  return page.to_html();
}

}  // namespace cloth

#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "study/work_precision_report.h"

namespace cloth {
namespace {

double abscissa(const WorkPrecisionRun& run, PlotAgainst against) {
  if (against == PlotAgainst::step) return run.time_step;
  return against == PlotAgainst::run_time ? run.time.least : static_cast<double>(run.count.force_evaluations);
}

Axis axis_of(PlotAgainst against) {
  static const Axis axes[] = {{.label = "run time", .unit = "s", .scale = AxisScale::logarithmic},
                              {.label = "time step", .unit = "s", .scale = AxisScale::logarithmic},
                              {.label = "force evaluations", .scale = AxisScale::logarithmic}};
  return axes[static_cast<std::size_t>(against)];
}

std::string note_of(const WorkPrecisionRun& run) {
  std::string note =
      fmt::format("step {:.4g} s, {} steps, {} force evaluations\nlargest error {:.2e} m", run.time_step,
                  run.steps, run.count.force_evaluations, run.error.largest_position);
  if (run.tolerance > 0) note += fmt::format("\ntolerance {:.0e}", run.tolerance);
  if (run.count.factorisations > 0)
    note += fmt::format("\n{} factorisations, {} iterations", run.count.factorisations, run.count.iterations);
  if (run.rung < 0) note += "\nbeyond the stability limit";
  if (!run.detail.empty()) note += "\n" + run.detail;
  return note;
}

std::string legend_of(const MethodStudy& method, bool smooth) {
  const OrderEstimate& order = method.order;
  std::string text = fmt::format("order {}", method.ladder.facts.order);
  if (!smooth && method.ladder.facts.order > 1) text += ", 1 expected here";
  if (order.asymptotic) return fmt::format("{}, observed {}", text, order_text(order));
  text += ", pre-asymptotic";
  if (order.overall.points > 1) text += fmt::format(" (slope {:.1f})", order.overall.value);
  return text;
}

PlotSeries series_of(const WorkPrecision& study, const MethodStudy& method, PlotAgainst against,
                     int first_run) {
  PlotSeries series{.name = method.ladder.facts.title, .detail = legend_of(method, study.reference.smooth)};
  const auto& names = integrator_names();
  series.style =
      static_cast<int>(std::find(names.begin(), names.end(), method.ladder.facts.name) - names.begin());
  for (const WorkPrecisionRun& run : method.runs) {
    const int tag = first_run + static_cast<int>(&run - method.runs.data());
    if (!run.reached_horizon()) {
      const std::string cause = std::string(name_of(run.status)) + ": " + run.detail;
      series.failed.push_back(
          {run.status == RunStatus::refused && against != PlotAgainst::step ? 0 : abscissa(run, against),
           cause, run.status == RunStatus::refused ? -1 : tag});
      continue;
    }
    if (against == PlotAgainst::run_time && run.samples.empty()) continue;
    PlotPoint point{
        .x = abscissa(run, against), .y = run.error.rms_position, .note = note_of(run), .tag = tag};
    if (against == PlotAgainst::run_time) point.x_range = {run.time.least, run.time.upper_quartile};
    series.points.push_back(point);
  }
  return series;
}

/// One for each order that a studied method has; all are 1 where limiter or contact make them so.
std::vector<SlopeTriangle> triangles_of(const WorkPrecision& study, PlotAgainst against) {
  std::set<int> orders;
  for (const MethodStudy& method : study.methods)
    orders.insert(study.reference.smooth ? method.ladder.facts.order : 1);
  std::vector<SlopeTriangle> triangles;
  for (const int order : orders)
    triangles.push_back(
        {against == PlotAgainst::step ? 1.0 * order : -1.0 * order, fmt::format("{}", order)});
  return triangles;
}

std::vector<std::string> caption_of(const WorkPrecision& study, PlotAgainst against) {
  std::vector<std::string> caption;
  if (against == PlotAgainst::run_time)
    caption.push_back(
        fmt::format("RMS position error over {} particles and {} fixed times up to {:.4g} s. Run time: least "
                    "of at least {} "
                    "interleaved repeats of the stepping loop alone; bars reach to the upper quartile.",
                    study.particles, study.samples, study.horizon, study.repeats));
  if (!study.reference.smooth)
    caption.push_back(
        "Deformation rate or contact at work: expect first order from every method; what was observed stands "
        "in "
        "the legend.");
  if (study.stopped) caption.push_back("The study was stopped: what is drawn was finished.");
  return caption;
}

}  // namespace

LinePlot study_plot(const WorkPrecision& study, PlotAgainst against) {
  LinePlot plot;
  plot.title = "Error against " + axis_of(against).label;
  plot.subtitle = study.scene.title;
  plot.caption = caption_of(study, against);
  plot.x = axis_of(against);
  plot.y = {.label = "RMS position error", .unit = "m", .scale = AxisScale::logarithmic};
  int run = 0;  // counted over all methods
  for (const MethodStudy& method : study.methods) {
    plot.series.push_back(series_of(study, method, against, run));
    run += static_cast<int>(method.runs.size());
  }
  if (const double floor = 10 * study.reference.floor.rms_position; floor > 0) {
    plot.floor = PlotFloor{floor, "within ten times what the two references differ by"};
    plot.y.low = floor / 100;  // room for its label
  }
  plot.triangles = triangles_of(study, against);
  if (against == PlotAgainst::run_time) plot.best_line = "least error for the time";
  return plot;
}

}  // namespace cloth

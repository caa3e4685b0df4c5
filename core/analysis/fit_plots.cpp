#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "analysis/fit_report.h"

namespace cloth {

LinePlot curve_plot(const FitAccount& account, const FitCurve& curve) {
  LinePlot plot{.title = curve.name, .subtitle = account.title, .x = curve.x, .y = curve.y};
  PlotSeries measured{
      .name = "measured", .detail = "with two sigmas to each side", .style = 4, .line = false},
      simulated{.name = "simulated", .detail = "at the fitted values", .style = 1, .markers = false};
  for (std::size_t k = 0; k < curve.targets.size(); ++k) {
    const FitTarget& target = account.problem.targets[curve.targets[k]];
    PlotPoint point{.x = curve.at[k], .y = target.measured};
    if (account.problem.sigmas_known)
      point.y_range = {target.measured - 2 * target.sigma, target.measured + 2 * target.sigma};
    measured.points.push_back(point);
    simulated.points.push_back({.x = curve.at[k], .y = account.result.simulated[curve.targets[k]]});
  }
  if (!account.problem.sigmas_known) measured.detail = "";
  plot.series = {simulated, measured};
  return plot;
}

LinePlot residual_plot(const FitAccount& account, const FitCurve* curve) {
  LinePlot plot{.title = "Residuals" + (curve ? ": " + curve->name : std::string()),
                .subtitle = account.title};
  plot.plot_height = 200;
  plot.x = curve ? curve->x : Axis{.label = "target"};
  plot.y = {.label = "(simulated - measured)/sigma"};
  PlotSeries fitted{.name = "fitted", .line = false}, held_out{.name = "held out", .line = false};
  double farthest = 2.5;
  for (std::size_t t = 0, k = 0; t < account.problem.targets.size(); ++t) {
    double x = static_cast<double>(t + 1);
    if (curve) {
      const auto place = std::find(curve->targets.begin(), curve->targets.end(), t);
      if (place == curve->targets.end()) continue;
      x = curve->at[static_cast<std::size_t>(place - curve->targets.begin())];
    } else {
      const bool taken = std::any_of(account.curves.begin(), account.curves.end(), [t](const FitCurve& c) {
        return std::find(c.targets.begin(), c.targets.end(), t) != c.targets.end();
      });
      if (taken) continue;
      x = static_cast<double>(++k);
    }
    const FitTarget& target = account.problem.targets[t];
    const double residual = (account.result.simulated[t] - target.measured) / target.sigma;
    farthest = std::max(farthest, 1.1 * std::abs(residual));
    (target.held_out ? held_out : fitted).points.push_back({.x = x, .y = residual, .note = target.name});
  }
  plot.y.low = -farthest, plot.y.high = farthest;
  plot.series = {fitted};
  if (!held_out.points.empty()) plot.series.push_back(held_out);
  plot.lines = {{.at = 0, .label = ""}, {.at = 2, .label = "two sigmas"}, {.at = -2, .label = ""}};
  return plot;
}

}  // namespace cloth

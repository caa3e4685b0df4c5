// Horizontal bars with intervals, several for each category: Sobol' indices of parameters.
#pragma once

#include <string>
#include <vector>

#include "report/axis.h"
#include "report/svg.h"

namespace cloth {

struct IntervalBar {
  double value = 0;
  double low = 0, high = 0;  ///< not numbers: no interval
};

struct BarSeries {
  std::string name{};
  std::vector<IntervalBar> bars{};  ///< one for each category; a value that is no number has no bar
};

struct IntervalBars {
  std::string title{}, subtitle{};
  std::vector<std::string> caption{};
  std::vector<std::string> categories{};
  std::vector<BarSeries> series{};
  Axis x{};            ///< bars begin at 0
  double width = 960;  ///< [px]
};

double height_of(const IntervalBars& plot);
void draw(PlotCanvas& canvas, const IntervalBars& plot);

}  // namespace cloth

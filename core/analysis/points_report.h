// The page of a study over points: every run at a glance, what its outputs depend on.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "design/design.h"
#include "report/html_page.h"
#include "report/line_plot.h"
#include "report/points/parallel_coordinates.h"
#include "report/points/point_table.h"
#include "report/points/scatter_matrix.h"

namespace cloth {

struct PointsAccount {
  std::string title{};
  std::string command{};  ///< that makes it; empty: none
  PointTable table{};     ///< rows in the order of the design
  /// Of the design that the rows are the first ones of, where there is one; `saltelli` and `morris` have a
  /// section on what each output depends on.
  std::optional<Design> design{};
  std::size_t count = 0;
  std::uint64_t seed = 1;
};

/// Coloured by the first output.
ParallelCoordinates parallel_plot(const PointsAccount& account);
ScatterMatrix scatter_plot(const PointsAccount& account);
ScatterMatrix main_effects_plot(const PointsAccount& account);

/// Of a table with one parameter: an output (a column) against it, failed runs above.
LinePlot curve_of_output(const PointsAccount& account, std::size_t output);

/// One parameter: a curve of each output. Parallel coordinates with ranges to draw, main effects, scatter
/// matrix, sensitivity. What does not apply is not there.
std::string points_page(const PointsAccount& account);

/// The sections of that page, for another page to take in.
void add_points(const PointsAccount& account, HtmlPage& page);

/// The page's pictures, and the tables of its indices, as files:
///   parallel-coordinates.svg, main-effects.svg, scatter-matrix.svg, and for each output of a design for
///   sensitivity sobol-OUTPUT.svg and .csv, or morris-OUTPUT.svg and .csv
struct PointsFile {
  std::string name{}, text{};
};
std::vector<PointsFile> points_files(const PointsAccount& account);

/// prefix-NAME, in which letters and digits of the name stay and all else becomes "-"; where that is among
/// `taken`, "-2", "-3", ... follow. Adds it to `taken`.
std::string file_stem(const std::string& prefix, const std::string& name, std::vector<std::string>& taken);

}  // namespace cloth

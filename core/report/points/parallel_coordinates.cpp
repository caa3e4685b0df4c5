#include "report/points/parallel_coordinates.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "report/plot_parts.h"
#include "report/ramp.h"

namespace cloth {
namespace {

constexpr double title_line = 15, side = 70, bar_width = parallel_bar_width, legend_height = 34,
                 legend_width = 180;
constexpr double brushed_opacity = 0.45;
constexpr double bottom = 14;

const PageColour& failed_colour() {
  return run_classes()[static_cast<std::size_t>(RunClass::diverged)].colour;
}

struct ParallelLayout {
  explicit ParallelLayout(const ParallelCoordinates& all) : plot(all) {
    const std::size_t count = plot.table.columns.size();
    spacing = count > 1 ? (plot.width - 2 * side) / static_cast<double>(count - 1) : 0;
    std::size_t lines = 1;
    for (const PointColumn& column : plot.table.columns) {
      titles.push_back(column_title(column, std::max(spacing - 12, 60.0)));
      lines = std::max(lines, titles.back().size());
    }
    const double top = titles_height(plot.title, plot.subtitle, plot.width) + legend_height;
    frame = {side, top + title_line * static_cast<double>(lines) + 10, plot.width - side, 0};
    frame.bottom = frame.top + plot.plot_height;
    for (const PointColumn& column : plot.table.columns)
      maps.push_back(map_of(column, frame.bottom, frame.top));
    caption = plot.caption;
    if (const std::size_t rows = plot.table.rows(); rows > most_parallel_rows)
      caption.push_back(fmt::format("{} of {} runs are drawn, evenly picked.", most_parallel_rows, rows));
  }

  double x(std::size_t column) const { return frame.left + spacing * static_cast<double>(column); }
  double height() const { return frame.bottom + bottom + caption_height(caption, plot.width) + plot_margin; }

  const ParallelCoordinates& plot;
  double spacing = 0;
  Box frame;
  std::vector<AxisMap> maps;
  std::vector<std::vector<std::string>> titles;
  std::vector<std::string> caption;
};

/// As far as it has values, from the first column on.
std::string path_of(const ParallelLayout& layout, std::size_t row) {
  std::vector<SvgPoint> points;
  for (std::size_t c = 0; c < layout.maps.size(); ++c) {
    const double value = layout.plot.table.columns[c].values[row];
    if (!can_show(layout.maps[c].scale(), value)) break;
    points.push_back({layout.x(c), layout.maps[c].place(value)});
  }
  return points.size() < 2 ? "" : path_through(points);
}

/// Of a row whose value has a place between 0 and 1 on the axis that colours.
std::size_t class_of(const ParallelLayout& layout, std::size_t row) {
  const AxisMap& map = layout.maps[layout.plot.coloured_by];
  const double value = layout.plot.table.columns[layout.plot.coloured_by].values[row];
  return can_show(map.scale(), value) ? ramp_class(-map.place(value), -layout.frame.bottom, -layout.frame.top)
                                      : 0;
}

/// Runs that a brush leaves out: behind the others, and not there for the pointer. They are of a light
/// colour, not of a transparent one, which would become dark where many of them meet.
void draw_faint_rows(PlotCanvas& canvas, const ParallelLayout& layout, const std::vector<std::size_t>& rows) {
  canvas.begin_group("faint", {}, true);
  for (const std::size_t row : rows)
    canvas.path(path_of(layout, row), {.stroke = page_colours().grid, .stroke_width = 1.2});
  canvas.end_group();
}

void draw_rows(PlotCanvas& canvas, const ParallelLayout& layout) {
  const PointTable& table = layout.plot.table;
  std::vector<std::size_t> rows = table.some_rows(most_parallel_rows);
  const auto outside = std::stable_partition(
      rows.begin(), rows.end(), [&layout](std::size_t row) { return is_kept(layout.plot, row); });
  const std::vector<std::size_t> faint(outside, rows.end());
  rows.erase(outside, rows.end());
  const double opacity = std::clamp(9 / std::sqrt(static_cast<double>(rows.size()) + 1), 0.3, 0.9);
  canvas.begin_group("rows");
  if (!faint.empty()) draw_faint_rows(canvas, layout, faint);
  canvas.begin_group("failed", {.stroke = failed_colour(), .dash = Dash::dashed, .opacity = 0.6});
  for (const std::size_t row : rows)
    if (table.failed(row))
      canvas.path(path_of(layout, row), {.stroke = failed_colour(), .dash = Dash::dashed},
                  {table.text_of(row), table.tag_of(row)});
  canvas.end_group();
  for (std::size_t k = 0; k < ramp_colours().size(); ++k) {  // the highest on top
    canvas.begin_group("", {.opacity = opacity});
    for (const std::size_t row : rows)
      if (!table.failed(row) && class_of(layout, row) == k)
        canvas.path(path_of(layout, row), {.stroke = ramp_colours()[k], .stroke_width = 1.4},
                    {table.text_of(row), table.tag_of(row)});
    canvas.end_group();
  }
  canvas.end_group();
}

void draw_brushes(PlotCanvas& canvas, const ParallelLayout& layout) {
  canvas.begin_group("brushes", {}, true);
  for (const AxisBrush& brush : layout.plot.brushes) {
    const AxisMap& map = layout.maps[brush.column];
    const auto place = [&](double value) {
      return std::clamp(can_show(map.scale(), value) ? map.place(value) : layout.frame.bottom,
                        layout.frame.top, layout.frame.bottom);
    };
    const double top = place(brush.high), height = place(brush.low) - top;
    const double left = layout.x(brush.column) - bar_width / 2;
    const PageColour& colour = style_of_series(0).colour;
    canvas.rect({left, top}, bar_width, height, {.fill = colour, .opacity = brushed_opacity});
    canvas.rect({left, top}, bar_width, height, {.stroke = colour, .stroke_width = 1.5});
  }
  canvas.end_group();
}

void draw_parallel_axis(PlotCanvas& canvas, const ParallelLayout& layout, std::size_t c) {
  const double x = layout.x(c), top = layout.frame.top, end = layout.frame.bottom;
  const PageColours& page = page_colours();
  canvas.line({x, top}, {x, end}, {.stroke = page.ink, .stroke_width = 1.2});
  for (const Tick& tick : layout.maps[c].ticks(34)) {
    const double y = layout.maps[c].place(tick.value);
    canvas.line({x - (tick.major ? 5 : 3), y}, {x, y}, {.stroke = page.ink});
    if (tick.major)
      canvas.text({x - 8, y + 4}, {.text = tick.text,
                                   .size = tick_size,
                                   .anchor = Anchor::end,
                                   .colour = page.ink,
                                   .superscript = tick.superscript,
                                   .halo = true});
  }
  double y = top - 10 - title_line * static_cast<double>(layout.titles[c].size() - 1);
  for (const std::string& line : layout.titles[c]) {
    canvas.text({x, y}, {.text = line,
                         .size = small_size,
                         .anchor = Anchor::middle,
                         .bold = layout.plot.table.columns[c].is_output});
    y += title_line;
  }
}

void draw_ramp_legend(PlotCanvas& canvas, const ParallelLayout& layout) {
  const PointTable& table = layout.plot.table;
  double x = plot_margin;
  const double y = titles_height(layout.plot.title, layout.plot.subtitle, layout.plot.width);
  canvas.begin_group("legend");
  const std::string name = table.columns[layout.plot.coloured_by].axis.label + ": low";
  canvas.text({x, y + 11}, {.text = name, .size = small_size});
  x += text_width(name, small_size) + 8;
  const double step = legend_width / static_cast<double>(ramp_colours().size());
  for (const PageColour& colour : ramp_colours()) {
    canvas.rect({x, y + 2}, step - 2, 10, {.fill = colour});
    x += step;
  }
  canvas.text({x + 6, y + 11}, {.text = "high", .size = small_size});
  x += 60;
  if (const std::size_t failures = table.failures(); failures > 0) {
    canvas.line({x, y + 7}, {x + 30, y + 7},
                {.stroke = failed_colour(), .stroke_width = 1.5, .dash = Dash::dashed});
    canvas.text({x + 38, y + 11}, {.text = fmt::format("failed ({})", failures), .size = small_size});
  }
  canvas.end_group();
}

/// Of the runs that are kept, or what is said in its place: the page's script writes there, too.
void draw_count(PlotCanvas& canvas, const ParallelCoordinates& plot) {
  const bool counts = !plot.brushes.empty();
  const PageColours& page = page_colours();
  canvas.begin_group("count", {}, true);
  canvas.text({plot.width - plot_margin, titles_height(plot.title, plot.subtitle, plot.width) + 11},
              {.text = counts                    ? kept_words(plot)
                       : plot.invitation.empty() ? " "
                                                 : plot.invitation,
               .size = small_size,
               .anchor = Anchor::end,
               .bold = counts,
               .colour = counts ? page.ink : page.muted});
  canvas.end_group();
}

/// The parts of the drawing it finds by their names: lines in "rows", the bars of the axes in "bars".
constexpr const char* brush_script = R"(
(function () {
  const svg = document.currentScript.closest("svg"), part = name => svg.querySelector("[data-part=" + name + "]");
  const lines = [...part("rows").querySelectorAll("path")].map(path => ({
    path, at: new Map(path.getAttribute("d").slice(1).split("L").map(text => text.split(" ").map(Number)))}));
  const ranges = new Map(), count = part("count").firstElementChild;
  const make = (name, attributes) => {
    const element = document.createElementNS(svg.namespaceURI, name);
    for (const key in attributes) element.setAttribute(key, attributes[key]);
    return svg.appendChild(element);
  };
  const show = () => {
    let shown = 0;
    for (const line of lines) {
      let inside = true;
      for (const [x, range] of ranges)
        inside = inside && line.at.has(x) && line.at.get(x) >= range.from && line.at.get(x) <= range.to;
      line.path.style.opacity = inside ? "" : "0.04";
      line.path.style.pointerEvents = inside ? "" : "none";
      shown += inside ? 1 : 0;
    }
    count.textContent = ranges.size ? shown + " of " + lines.length + " runs" : "Draw along an axis to pick runs";
  };
  for (const bar of part("bars").querySelectorAll("rect")) {
    const number = name => Number(bar.getAttribute(name)), width = number("width");
    const x = Math.round(100 * (number("x") + width / 2)) / 100, top = number("y"), end = top + number("height");
    const brush = make("rect", {x: number("x"), width, y: top, height: 0, class: "f-blue", fill: "#0072b2", opacity: 0.55,
      "pointer-events": "none"});
    const place = event => {
      const at = new DOMPoint(event.clientX, event.clientY).matrixTransform(svg.getScreenCTM().inverse());
      return Math.min(end, Math.max(top, at.y));
    };
    let first = null;
    const grip = make("rect", {x: number("x") - 6, width: width + 12, y: top - 6, height: end - top + 12,
      fill: "transparent", style: "cursor: ns-resize; touch-action: none"});
    grip.onpointerdown = event => { first = place(event); grip.setPointerCapture(event.pointerId); };
    grip.onpointermove = event => {
      if (first === null) return;
      const now = place(event), range = {from: Math.min(first, now), to: Math.max(first, now)};
      if (range.to - range.from > 3) ranges.set(x, range); else ranges.delete(x);
      brush.setAttribute("y", range.from);
      brush.setAttribute("height", ranges.has(x) ? range.to - range.from : 0);
      show();
    };
    grip.onpointerup = event => {
      if (first !== null && Math.abs(place(event) - first) <= 3) {
        ranges.delete(x);
        brush.setAttribute("height", 0);
        show();
      }
      first = null;
    };
  }
  show();
})();
)";

}  // namespace

bool is_kept(const ParallelCoordinates& plot, std::size_t row) {
  return std::all_of(plot.brushes.begin(), plot.brushes.end(), [&](const AxisBrush& brush) {
    const double value = plot.table.columns[brush.column].values[row];
    return value >= brush.low && value <= brush.high;
  });
}

std::string kept_words(const ParallelCoordinates& plot) {
  std::size_t kept = 0;
  const std::size_t rows = plot.table.rows();
  for (std::size_t row = 0; row < rows; ++row) kept += is_kept(plot, row) ? 1 : 0;
  return fmt::format("{} of {} runs", kept, rows);
}

std::vector<ParallelAxis> axes_of(const ParallelCoordinates& plot) {
  const ParallelLayout layout(plot);
  std::vector<ParallelAxis> axes;
  for (std::size_t c = 0; c < layout.maps.size(); ++c)
    axes.push_back({layout.x(c), layout.frame.top, layout.frame.bottom, layout.maps[c]});
  return axes;
}

double height_of(const ParallelCoordinates& plot) {
  return ParallelLayout(plot).height();
}

void draw(PlotCanvas& canvas, const ParallelCoordinates& plot) {
  const ParallelLayout layout(plot);
  draw_titles(canvas, plot.title, plot.subtitle, plot.width);
  if (plot.table.columns.empty()) return;
  draw_ramp_legend(canvas, layout);
  canvas.begin_group("bars");
  for (std::size_t c = 0; c < layout.maps.size(); ++c)
    canvas.rect({layout.x(c) - bar_width / 2, layout.frame.top}, bar_width, layout.frame.height(),
                {.fill = page_colours().band});
  canvas.end_group();
  draw_rows(canvas, layout);
  if (!plot.brushes.empty()) draw_brushes(canvas, layout);
  canvas.begin_group("axes", {}, true);
  for (std::size_t c = 0; c < layout.maps.size(); ++c) draw_parallel_axis(canvas, layout, c);
  canvas.end_group();
  draw_count(canvas, plot);
  draw_caption(canvas, layout.caption, layout.frame.bottom + bottom, plot.width);
}

std::string to_brushed_svg(const ParallelCoordinates& plot) {
  std::string svg = to_svg(plot);
  if (plot.table.columns.empty()) return svg;
  svg.insert(svg.rfind("</svg>"), "<script>" + xml_escaped(brush_script) + "</script>\n");
  return svg;
}

}  // namespace cloth

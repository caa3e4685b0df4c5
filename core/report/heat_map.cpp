#include "report/heat_map.h"

#include <algorithm>
#include <cassert>
#include <cmath>

#include "report/plot_parts.h"

namespace cloth {
namespace {

constexpr double panel_gap = 18, panel_title = 24, axis_space = 34, title_space = 16;
constexpr double legend_row = 22, legend_swatch = 16;

/// The cells' edges: halfway between middles, in decades where logarithmic. Empty for values that cannot be
/// shown.
std::vector<double> edges_of(AxisScale scale, const std::vector<double>& middles) {
  std::vector<double> at;
  for (const double value : middles) {
    if (!can_show(scale, value)) return {};
    at.push_back(scale == AxisScale::logarithmic ? std::log10(value) : value);
    if (at.size() > 1 && at.back() <= at[at.size() - 2]) return {};
  }
  if (at.empty()) return {};
  const double first = at.size() > 1 ? at[1] - at[0] : 1,
               last = at.size() > 1 ? at.back() - at[at.size() - 2] : 1;
  std::vector<double> edges = {at.front() - first / 2};
  for (std::size_t i = 1; i < at.size(); ++i) edges.push_back((at[i - 1] + at[i]) / 2);
  edges.push_back(at.back() + last / 2);
  if (scale == AxisScale::logarithmic)
    for (double& edge : edges) edge = std::pow(10, edge);
  return edges;
}

AxisMap map_of(Axis axis, const std::vector<double>& edges) {
  axis.low.reset(), axis.high.reset();
  if (!edges.empty()) axis.low = edges.front(), axis.high = edges.back();
  return AxisMap(axis, edges, 0, 1);
}

std::string mark_path(CellMark mark, SvgPoint c, double r) {
  switch (mark) {
    case CellMark::none:
      return "";
    case CellMark::dot:
      return path_through({{c.x - 0.5 * r, c.y}, {c.x + 0.5 * r, c.y}});
    case CellMark::slash:
      return path_through({{c.x - r, c.y + r}, {c.x + r, c.y - r}});
    case CellMark::cross:
      return path_through({{c.x - r, c.y + r}, {c.x + r, c.y - r}}) +
             path_through({{c.x - r, c.y - r}, {c.x + r, c.y + r}});
    case CellMark::ring:
      return marker_path(Marker::circle, c, r);
  }
  return "";
}

/// Marks are ink on light cells and paper on dark ones, in either scheme.
SvgStyle mark_style(const ClassStyle& style, double width) {
  const bool dark_cell = contrast(style.colour.light, "#ffffff") > contrast(style.colour.light, "#000000");
  const PageColour colour = dark_cell ? page_colours().surface : page_colours().ink;
  return {.stroke = colour, .stroke_width = width, .opacity = 0.65};
}

struct LegendItem {
  std::string text{};
  const ClassStyle* cell = nullptr;  // one of the two
  const OverlayCurve* curve = nullptr;
  double left = 0, top = 0;
};

class Drawing {
 public:
  explicit Drawing(const HeatMap& map);
  double height() const { return height_; }
  void draw(PlotCanvas& svg);

 private:
  void lay_out_legend();
  Box frame_of(std::size_t panel) const;
  void draw_panel(PlotCanvas& svg, std::size_t index);
  void draw_cells(PlotCanvas& svg, const HeatPanel& panel) const;
  void draw_marks(PlotCanvas& svg, const HeatPanel& panel, int class_index) const;
  void draw_curves(PlotCanvas& svg, const HeatPanel& panel, const Box& frame) const;
  void draw_legend(PlotCanvas& svg) const;

  Box cell_box(std::size_t ix, std::size_t iy) const {
    return {x_.place(x_edges_[ix]), y_.place(y_edges_[iy + 1]), x_.place(x_edges_[ix + 1]),
            y_.place(y_edges_[iy])};
  }
  bool has_cells() const { return !x_edges_.empty() && !y_edges_.empty(); }

  const HeatMap& map_;
  std::vector<double> x_edges_, y_edges_;
  AxisMap x_, y_;
  std::size_t columns_ = 1, rows_ = 1;
  double left_ = 0, top_ = 0, side_ = 0, panel_height_ = 0, bottom_ = 0, height_ = 0;
  std::vector<LegendItem> legend_;
  double legend_height_ = 0;
};

Drawing::Drawing(const HeatMap& map)
    : map_(map),
      x_edges_(edges_of(map.x.scale, map.x_values)),
      y_edges_(edges_of(map.y.scale, map.y_values)),
      x_(map_of(map.x, x_edges_)),
      y_(map_of(map.y, y_edges_)) {
  const std::size_t count = std::max<std::size_t>(map.panels.size(), 1);
  columns_ = std::min(count, std::size_t(std::max(map.columns, 1)));
  rows_ = (count + columns_ - 1) / columns_;
  lay_out_legend();
  y_.set_places(260, 0);
  left_ = plot_margin + widest_tick(y_.ticks(y_tick_spacing)) + 34;
  side_ = (map.width - plot_margin - left_ - panel_gap * double(columns_ - 1)) / double(columns_);
  side_ = std::max(side_, 60.0);
  panel_height_ = std::min(side_, map.highest);
  top_ = titles_height(map.title, map.subtitle, map.width) + legend_height_;
  const double panel_row = panel_title + panel_height_ + axis_space;
  bottom_ = top_ + panel_row * double(rows_) + title_space;
  height_ = bottom_ + caption_height(map.caption, map.width) + 8;
}

void Drawing::lay_out_legend() {
  for (const ClassStyle& style : map_.classes) legend_.push_back({.text = style.name, .cell = &style});
  static const ClassStyle empty{"not computed", page_colours().surface, CellMark::none};
  const auto is_empty = [&](const HeatCell& cell) {
    return cell.class_index < 0 || cell.class_index >= int(map_.classes.size());
  };
  if (std::any_of(map_.panels.begin(), map_.panels.end(), [&](const HeatPanel& panel) {
        return std::any_of(panel.cells.begin(), panel.cells.end(), is_empty);
      }))
    legend_.push_back({.text = empty.name, .cell = &empty});
  const auto known = [&](const std::string& label) {
    return std::any_of(legend_.begin(), legend_.end(),
                       [&](const LegendItem& item) { return item.curve && item.text == label; });
  };
  for (const HeatPanel& panel : map_.panels)
    for (const OverlayCurve& curve : panel.curves)
      if (!curve.label.empty() && !known(curve.label))
        legend_.push_back({.text = curve.label, .curve = &curve});
  double x = plot_margin, y = 0;
  bool curves = false;
  for (LegendItem& item : legend_) {
    const double width = (item.curve ? 40 : 24) + text_width(item.text, small_size) + 18;
    if (x > plot_margin && (x + width > map_.width - plot_margin || (item.curve && !curves)))
      x = plot_margin, y += legend_row;
    curves = item.curve != nullptr;
    item.left = x, item.top = y;
    x += width;
  }
  legend_height_ = legend_.empty() ? 0 : y + legend_row + 6;
}

Box Drawing::frame_of(std::size_t panel) const {
  const double left = left_ + double(panel % columns_) * (side_ + panel_gap);
  const double top =
      top_ + panel_title + double(panel / columns_) * (panel_title + panel_height_ + axis_space);
  return {left, top, left + side_, top + panel_height_};
}

void Drawing::draw_cells(PlotCanvas& svg, const HeatPanel& panel) const {
  if (!has_cells()) return;
  const std::size_t nx = map_.x_values.size(), ny = map_.y_values.size();
  assert(panel.cells.size() == nx * ny);
  for (int c = 0; c < int(map_.classes.size()); ++c) {
    const ClassStyle& style = map_.classes[std::size_t(c)];
    svg.begin_group("class", {.fill = style.colour}, false, true);
    for (std::size_t i = 0; i < std::min(panel.cells.size(), nx * ny); ++i) {
      const HeatCell& cell = panel.cells[i];
      if (cell.class_index != c) continue;
      const Box box = cell_box(i % nx, i / nx);
      const std::string tooltip = value_line(map_.x, map_.x_values[i % nx]) + "\n" +
                                  value_line(map_.y, map_.y_values[i / nx]) + "\n" + style.name +
                                  (cell.note.empty() ? "" : "\n" + cell.note);
      // A hair wider and higher: no paper shines through between neighbours.
      svg.rect({box.left, box.top}, box.width() + 0.3, box.height() + 0.3, {},
               {(panel.title.empty() ? "" : panel.title + "\n") + tooltip, cell.tag});
    }
    svg.end_group();
    draw_marks(svg, panel, c);
  }
}

void Drawing::draw_marks(PlotCanvas& svg, const HeatPanel& panel, int class_index) const {
  const ClassStyle& style = map_.classes[std::size_t(class_index)];
  if (style.mark == CellMark::none) return;
  const std::size_t nx = map_.x_values.size(), ny = map_.y_values.size();
  std::string data;
  double side = 1e9;
  for (std::size_t i = 0; i < std::min(panel.cells.size(), nx * ny); ++i) {
    if (panel.cells[i].class_index != class_index) continue;
    const Box box = cell_box(i % nx, i / nx);
    const double size = std::min(box.width(), box.height());
    side = std::min(side, size);
    data += mark_path(style.mark, {(box.left + box.right) / 2, (box.top + box.bottom) / 2},
                      std::min(0.24 * size, 5.0));
  }
  svg.begin_group("marks", {}, true);
  svg.path(data, mark_style(style, std::clamp(0.11 * side, 0.5, 1.4)));
  svg.end_group();
}

void Drawing::draw_curves(PlotCanvas& svg, const HeatPanel& panel, const Box& frame) const {
  svg.begin_group("curves", {}, true);
  for (const OverlayCurve& curve : panel.curves) {
    std::string data;
    std::vector<SvgPoint> stroke;
    for (const auto& [x, y] : curve.points) {
      if (can_show(map_.x.scale, x) && can_show(map_.y.scale, y)) {
        stroke.push_back({x_.place(x), y_.place(y)});
      } else {
        data += clipped_path(stroke, frame);
        stroke.clear();
      }
    }
    data += clipped_path(stroke, frame);
    svg.path(data, {.stroke = page_colours().surface, .stroke_width = 4.6, .opacity = 0.8});
    svg.path(data, {.stroke = curve.colour, .stroke_width = 2.1, .dash = curve.dash}, curve.label);
  }
  svg.end_group();
}

void Drawing::draw_panel(PlotCanvas& svg, std::size_t index) {
  const HeatPanel& panel = map_.panels[index];
  const Box frame = frame_of(index);
  x_.set_places(frame.left, frame.right);
  y_.set_places(frame.bottom, frame.top);
  svg.begin_group("panel");
  svg.text({frame.left, frame.top - 8}, {.text = panel.title, .size = label_size, .bold = true});
  draw_cells(svg, panel);
  draw_curves(svg, panel, frame);
  svg.rect({frame.left, frame.top}, frame.width(), frame.height(), {.stroke = page_colours().muted});
  draw_x_axis(svg, x_, "", frame, false);
  if (index % columns_ == 0) draw_y_axis(svg, y_, axis_title(map_.y, y_.tick_exponent()), frame, false);
  svg.end_group();
}

void Drawing::draw_legend(PlotCanvas& svg) const {
  const double top = titles_height(map_.title, map_.subtitle, map_.width);
  svg.begin_group("legend");
  for (const LegendItem& item : legend_) {
    const double y = top + item.top;
    if (item.cell) {
      svg.rect({item.left, y}, legend_swatch, legend_swatch,
               {.fill = item.cell->colour, .stroke = page_colours().muted});
      svg.path(mark_path(item.cell->mark, {item.left + legend_swatch / 2, y + legend_swatch / 2}, 3.8),
               mark_style(*item.cell, 1.4));
    } else {
      svg.line({item.left, y + 8}, {item.left + 32, y + 8},
               {.stroke = item.curve->colour, .stroke_width = 2.1, .dash = item.curve->dash});
    }
    svg.text({item.left + (item.cell ? 23 : 39), y + 12}, {.text = item.text, .size = small_size});
  }
  svg.end_group();
}

void Drawing::draw(PlotCanvas& svg) {
  draw_titles(svg, map_.title, map_.subtitle, map_.width);
  draw_legend(svg);
  for (std::size_t i = 0; i < map_.panels.size(); ++i) draw_panel(svg, i);
  const double middle = (left_ + left_ + double(columns_) * (side_ + panel_gap) - panel_gap) / 2;
  svg.text({middle, bottom_ - 6},
           {.text = axis_title(map_.x, x_.tick_exponent()), .size = label_size, .anchor = Anchor::middle});
  draw_caption(svg, map_.caption, bottom_, map_.width);
}

}  // namespace

void draw_cell_mark(PlotCanvas& canvas, const ClassStyle& style, SvgPoint centre, double radius) {
  canvas.begin_group("marks", {}, true);
  canvas.path(mark_path(style.mark, centre, radius), mark_style(style, 1.4));
  canvas.end_group();
}

double height_of(const HeatMap& map) {
  return Drawing(map).height();
}

void draw(PlotCanvas& canvas, const HeatMap& map) {
  Drawing(map).draw(canvas);
}

}  // namespace cloth

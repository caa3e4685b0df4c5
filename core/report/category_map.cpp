#include "report/category_map.h"

#include <algorithm>
#include <cassert>

#include "report/heat_map.h"
#include "report/plot_parts.h"

namespace cloth {
namespace {

constexpr double row_height = 22, legend_height = 30, swatch = 16, label_gap = 8, name_size = 12;

double widest_name(const std::vector<std::string>& names) {
  double widest = 0;
  for (const std::string& name : names) widest = std::max(widest, text_width(name, name_size));
  return widest;
}

struct Layout {
  explicit Layout(const CategoryMap& map)
      : top(titles_height(map.title, map.subtitle, map.width)),
        left(plot_margin + widest_name(map.rows) + label_gap),
        cells_top(top + legend_height + widest_name(map.columns) + label_gap),
        column_width((map.width - plot_margin - left) /
                     static_cast<double>(std::max<std::size_t>(1, map.columns.size()))),
        height(cells_top + row_height * static_cast<double>(map.rows.size()) + plot_margin) {}

  Box cell(std::size_t row, std::size_t column) const {
    const double x = left + column_width * static_cast<double>(column);
    const double y = cells_top + row_height * static_cast<double>(row);
    return {x, y, x + column_width, y + row_height};
  }

  double top, left, cells_top, column_width, height;
};

void draw_legend(PlotCanvas& canvas, const CategoryMap& map, double top) {
  double x = plot_margin;
  canvas.begin_group("legend");
  for (const ClassStyle& style : map.classes) {
    canvas.rect({x, top}, swatch, swatch, {.fill = style.colour, .stroke = page_colours().muted});
    draw_cell_mark(canvas, style, {x + swatch / 2, top + swatch / 2}, 3.8);
    canvas.text({x + swatch + 7, top + 12}, {.text = style.name, .size = small_size});
    x += swatch + 7 + text_width(style.name, small_size) + 18;
  }
  canvas.end_group();
}

void draw_names(PlotCanvas& canvas, const CategoryMap& map, const Layout& layout) {
  canvas.begin_group("names");
  for (std::size_t row = 0; row < map.rows.size(); ++row)
    canvas.text({layout.left - label_gap, layout.cell(row, 0).bottom - row_height / 2 + 4},
                {.text = map.rows[row], .size = name_size, .anchor = Anchor::end});
  for (std::size_t column = 0; column < map.columns.size(); ++column) {
    const Box box = layout.cell(0, column);
    canvas.text({(box.left + box.right) / 2 + 4, layout.cells_top - label_gap},
                {.text = map.columns[column], .size = name_size, .turn = -90});
  }
  canvas.end_group();
}

}  // namespace

double height_of(const CategoryMap& map) {
  return Layout(map).height;
}

void draw(PlotCanvas& canvas, const CategoryMap& map) {
  assert(map.cells.size() == map.rows.size() * map.columns.size());
  const Layout layout(map);
  draw_titles(canvas, map.title, map.subtitle, map.width);
  draw_legend(canvas, map, layout.top);
  draw_names(canvas, map, layout);
  canvas.begin_group("cells");
  for (std::size_t row = 0; row < map.rows.size(); ++row)
    for (std::size_t column = 0; column < map.columns.size(); ++column) {
      const CategoryCell& cell = map.cells[row * map.columns.size() + column];
      const Box box = layout.cell(row, column);
      SvgStyle look{.stroke = page_colours().surface, .stroke_width = 1.5};
      const bool known = cell.class_index >= 0 && cell.class_index < static_cast<int>(map.classes.size());
      if (!known) {
        canvas.rect({box.left, box.top}, box.width(), box.height(), {.stroke = page_colours().grid});
        continue;
      }
      const ClassStyle& style = map.classes[static_cast<std::size_t>(cell.class_index)];
      look.fill = style.colour;
      const std::string tip = map.rows[row] + ", " + map.columns[column] + "\n" + style.name +
                              (cell.note.empty() ? "" : "\n" + cell.note);
      canvas.rect({box.left, box.top}, box.width(), box.height(), look, {tip, cell.tag});
      draw_cell_mark(canvas, style, {(box.left + box.right) / 2, (box.top + box.bottom) / 2}, 4);
    }
  canvas.end_group();
}

}  // namespace cloth

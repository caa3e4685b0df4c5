#include "report/svg.h"

#include <fmt/format.h>

#include <cassert>
#include <cmath>
#include <map>
#include <numbers>

#include "io/printable.h"

namespace cloth {
namespace {

using std::numbers::pi;

constexpr std::string_view replacement = "\xEF\xBF\xBD";  // U+FFFD

/// Bytes of the UTF-8 character at the beginning, 0 if there is none that XML allows.
std::size_t character_length(std::string_view text) {
  const Utf8Character character = first_character(text);
  const bool is_control = character.code < 0x20 && character.code != '\n' && character.code != '\t';
  return is_control || character.code == 0xFFFE || character.code == 0xFFFF ? 0 : character.length;
}

/// Of an em, after the groups of equal width in Helvetica's metrics.
double character_width(char c) {
  static constexpr std::string_view thin = "ijl|'", narrow = "ftI!.,:;/\\[]()- r", wide = "mMW%@",
                                    capital = "ABCDEFGHKLNOPQRSTUVXYZ&wT+=<>~";
  if (thin.find(c) != std::string_view::npos) return 0.23;
  if (narrow.find(c) != std::string_view::npos) return 0.31;
  if (wide.find(c) != std::string_view::npos) return 0.87;
  if (capital.find(c) != std::string_view::npos) return 0.69;
  return 0.56;
}

std::string dash_array(Dash dash, double width) {
  static const std::vector<double> lengths[] = {{}, {4, 2.5}, {1, 2}, {5, 2, 1, 2}};  // in widths
  std::string text;
  for (const double length : lengths[static_cast<std::size_t>(dash)])
    text += (text.empty() ? "" : " ") + svg_number(length * std::max(width, 1.0));
  return text;
}

std::string attribute(std::string_view name, std::string_view value) {
  return fmt::format(" {}=\"{}\"", name, xml_escaped(value));
}

std::string number_attribute(std::string_view name, double value) {
  return fmt::format(" {}=\"{}\"", name, svg_number(value));
}

/// The light colour as an attribute, which any reader knows, and a class by which a page's style overrides
/// it.
std::string attributes_of(const SvgStyle& style) {
  std::string names, text;
  if (style.fill) names += "f-" + style.fill->name, text += attribute("fill", style.fill->light);
  if (style.stroke) {
    names += (names.empty() ? "s-" : " s-") + style.stroke->name;
    text += attribute("stroke", style.stroke->light);
    if (style.stroke_width != 1) text += number_attribute("stroke-width", style.stroke_width);
    const std::string dashes = dash_array(style.dash, style.stroke_width);
    if (!dashes.empty()) text += attribute("stroke-dasharray", dashes);
  }
  if (style.opacity != 1) text += number_attribute("opacity", style.opacity);
  return (names.empty() ? "" : attribute("class", names)) + text;
}

/// Markers with corners, lengths in radii of the marker.
struct Polygon {
  Marker marker;
  int count;
  double first, radius, below = 0, inner = 0;  ///< see corners(); `below` the marker's place
};
constexpr Polygon polygons[] = {{Marker::square, 4, 45, 1.25},      {Marker::triangle_up, 3, -90, 1.4, 0.2},
                                {Marker::diamond, 4, 0, 1.35},      {Marker::triangle_down, 3, 90, 1.4, -0.2},
                                {Marker::pentagon, 5, -90, 1.2},    {Marker::hexagon, 6, 0, 1.15},
                                {Marker::star, 5, -90, 1.5, 0, 0.6}};

/// A polygon's corners, from `first` degrees (0: right, -90: up) on; with `inner` a star.
std::vector<SvgPoint> corners(SvgPoint centre, int count, double first, double radius, double inner = 0) {
  std::vector<SvgPoint> points;
  const int all = inner > 0 ? 2 * count : count;
  for (int i = 0; i < all; ++i) {
    const double angle = (first + 360.0 * i / all) * pi / 180, r = inner > 0 && i % 2 ? inner : radius;
    points.push_back({centre.x + r * std::cos(angle), centre.y + r * std::sin(angle)});
  }
  return points;
}

}  // namespace

std::string svg_number(double value) {
  if (!std::isfinite(value)) return "0";
  std::string text = fmt::format("{:.2f}", value);
  text.erase(text.find_last_not_of('0') + 1);
  if (text.back() == '.') text.pop_back();
  return text == "-0" ? "0" : text;
}

std::string short_number(double value, int digits) {
  return std::isfinite(value) ? fmt::format("{:.{}g}", value, digits) : "not finite";
}

std::string xml_escaped(std::string_view text) {
  static const std::map<char, const char*> entities{
      {'&', "&amp;"}, {'<', "&lt;"}, {'>', "&gt;"}, {'"', "&quot;"}, {'\'', "&#39;"}};
  std::string out;
  while (!text.empty()) {
    const std::size_t length = character_length(text);
    const auto entity = entities.find(text[0]);
    if (length == 0)
      out += replacement;
    else
      out += entity == entities.end() ? text.substr(0, length) : entity->second;
    text.remove_prefix(std::max<std::size_t>(length, 1));
  }
  return out;
}

double text_width(std::string_view text, double size, bool bold) {
  double ems = 0;
  for (const char c : text)
    if ((static_cast<unsigned char>(c) & 0xC0) != 0x80) ems += character_width(c);
  return ems * size * (bold ? 1.08 : 1.0) * 1.03;
}

std::vector<std::string> wrapped(const std::string& text, double size, double width) {
  std::vector<std::string> lines;
  std::string line;
  std::size_t at = 0;
  while (at < text.size()) {
    const std::size_t end = std::min(text.find_first_of(" \n", at), text.size());
    const std::string word = text.substr(at, end - at);
    at = end + 1;
    if (word.empty()) continue;
    const std::string longer = line.empty() ? word : line + " " + word;
    if (!line.empty() && text_width(longer, size) > width) {
      lines.push_back(std::move(line));
      line = word;
    } else {
      line = longer;
    }
  }
  if (!line.empty()) lines.push_back(std::move(line));
  return lines;
}

std::string path_through(const std::vector<SvgPoint>& points, bool closed) {
  std::string data;
  for (const SvgPoint& p : points)
    data += (data.empty() ? "M" : "L") + svg_number(p.x) + " " + svg_number(p.y);
  return data + (closed && !data.empty() ? "Z" : "");
}

bool is_stroke_only(Marker marker) {
  return marker == Marker::plus || marker == Marker::cross;
}

std::string marker_path(Marker marker, SvgPoint c, double r) {
  const auto strokes = [&](double dx, double dy) {
    return path_through({{c.x - dx, c.y - dy}, {c.x + dx, c.y + dy}}) +
           path_through({{c.x - dy, c.y + dx}, {c.x + dy, c.y - dx}});
  };
  if (marker == Marker::circle)
    return fmt::format("M{0} {1}a{2} {2} 0 1 0 {3} 0a{2} {2} 0 1 0 -{3} 0Z", svg_number(c.x - r),
                       svg_number(c.y), svg_number(r), svg_number(2 * r));
  for (const Polygon& polygon : polygons)
    if (polygon.marker == marker)
      return path_through(corners({c.x, c.y + polygon.below * r}, polygon.count, polygon.first,
                                  polygon.radius * r, polygon.inner * r),
                          true);
  return marker == Marker::plus ? strokes(1.2 * r, 0) : strokes(0.95 * r, 0.95 * r);
}

SvgWriter::SvgWriter(double width, double height, const std::string& description) {
  const std::string w = svg_number(width), h = svg_number(height);
  out_ = fmt::format(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{0}\" height=\"{1}\" viewBox=\"0 0 {0} {1}\" "
      "role=\"img\" "
      "aria-label=\"{2}\" font-family=\"Helvetica, Arial, 'Liberation Sans', 'Nimbus Sans', sans-serif\">\n",
      w, h, xml_escaped(description));
  rect({0, 0}, width, height, {.fill = page_colours().surface});
}

void SvgWriter::element(std::string_view name, const std::string& attributes, const std::string& tooltip) {
  out_ += fmt::format("<{}{}", name, attributes);
  if (tooltip.empty())
    out_ += "/>\n";
  else
    out_ += fmt::format("><title>{}</title></{}>\n", xml_escaped(tooltip), name);
}

void SvgWriter::path(const std::string& data, const SvgStyle& style, const SvgTip& tip) {
  if (data.empty()) return;
  const bool open = !style.fill && style.stroke;
  element("path", attribute("d", data) + (open ? attribute("fill", "none") : "") + attributes_of(style),
          tip.text);
}

void SvgWriter::rect(SvgPoint corner, double width, double height, const SvgStyle& style, const SvgTip& tip) {
  element("rect",
          number_attribute("x", corner.x) + number_attribute("y", corner.y) +
              number_attribute("width", width) + number_attribute("height", height) +
              (style.fill || !style.stroke ? "" : attribute("fill", "none")) + attributes_of(style),
          tip.text);
}

void SvgWriter::text(SvgPoint baseline, const SvgText& text) {
  std::string attributes = number_attribute("x", baseline.x) + number_attribute("y", baseline.y) +
                           number_attribute("font-size", text.size);
  if (text.anchor != Anchor::start)
    attributes += attribute("text-anchor", text.anchor == Anchor::middle ? "middle" : "end");
  if (text.bold) attributes += attribute("font-weight", "bold");
  if (text.turn != 0)
    attributes += fmt::format(" transform=\"rotate({} {} {})\"", svg_number(text.turn),
                              svg_number(baseline.x), svg_number(baseline.y));
  SvgStyle style{.fill = text.colour};
  if (text.halo) {
    style.stroke = page_colours().surface, style.stroke_width = 3.5;
    attributes += " paint-order=\"stroke\" stroke-linejoin=\"round\"";
  }
  std::string content = xml_escaped(text.text);
  if (!text.superscript.empty())
    content += fmt::format("<tspan dy=\"{}\" font-size=\"{}\">{}</tspan>", svg_number(-0.4 * text.size),
                           svg_number(0.75 * text.size), xml_escaped(text.superscript));
  out_ += fmt::format("<text{}{}>{}</text>\n", attributes, attributes_of(style), content);
}

void SvgWriter::marker(Marker marker, SvgPoint centre, double radius, const SvgStyle& style,
                       const SvgTip& tip) {
  path(marker_path(marker, centre, radius), style, tip);
}

void SvgWriter::begin_group(const std::string& name, const SvgStyle& style, bool untouchable, bool crisp) {
  ++depth_;
  out_ += "<g" + (name.empty() ? "" : attribute("data-part", name)) + attributes_of(style) +
          (untouchable ? " pointer-events=\"none\"" : "") + (crisp ? " shape-rendering=\"crispEdges\"" : "") +
          ">\n";
}

void SvgWriter::end_group() {
  assert(depth_ > 0);
  --depth_;
  out_ += "</g>\n";
}

std::string SvgWriter::finish() {
  assert(depth_ == 0);
  return out_ + "</svg>\n";
}

}  // namespace cloth

#include "report/html_page.h"

#include <fmt/format.h>

#include <cassert>
#include <cmath>
#include <nlohmann/json.hpp>

#include "io/machine.h"
#include "report/svg.h"

namespace cloth {
namespace {

constexpr const char* light = R"(:root {
  color-scheme: light dark;
  --surface: #ffffff; --ink: #1f2328; --muted: #596069; --line: #d9dde2; --soft: #f4f5f7; --accent: #005a8c;
  --good: #dcecf8; --warn: #fbecc0; --bad: #fadbc8;
}
)";

constexpr const char* dark = R"(  :root {
    --surface: #14171c; --ink: #e6e9ed; --muted: #a2abb6; --line: #343b45; --soft: #1c2128; --accent: #7cc4f5;
    --good: #16364f; --warn: #4a3c10; --bad: #552a12;
  }
)";

constexpr const char* rules = R"(* { box-sizing: border-box; }
html { -webkit-text-size-adjust: 100%; }
body {
  margin: 0; background: var(--surface); color: var(--ink);
  font: 16px/1.6 -apple-system, "Segoe UI", Roboto, "Helvetica Neue", Arial, "Liberation Sans", sans-serif;
}
main { max-width: 1024px; margin: 0 auto; padding: 40px 32px 80px; }
p, ul, .notice, h1, h2, h3, nav, summary { max-width: 46rem; }
h1 { font-size: 2rem; line-height: 1.2; margin: 0 0 .5rem; letter-spacing: -.01em; }
h2 { font-size: 1.4rem; line-height: 1.3; margin: 3rem 0 .75rem; padding-top: .9rem; border-top: 1px solid var(--line); max-width: none; }
h3 { font-size: 1.1rem; line-height: 1.35; margin: 2rem 0 .5rem; }
p, ul { margin: 0 0 1rem; }
ul { padding-left: 1.4rem; }
li { margin: .25rem 0; }
.lead { font-size: 1.1rem; color: var(--muted); }
sup { font-size: .75em; line-height: 0; }
a { color: var(--accent); text-underline-offset: .15em; }
nav { margin: 1.75rem 0 0; padding: .9rem 1.2rem; background: var(--soft); border-radius: 8px; font-size: .94rem; }
nav ol { list-style: none; margin: 0; padding: 0; }
nav .level-3 { padding-left: 1.2rem; }
code, pre { font-family: ui-monospace, "SF Mono", Consolas, "Liberation Mono", "DejaVu Sans Mono", monospace; font-size: .88em; }
code { background: var(--soft); padding: .1em .32em; border-radius: 4px; overflow-wrap: anywhere; box-decoration-break: clone; -webkit-box-decoration-break: clone; }
pre { background: var(--soft); padding: .8rem 1rem; border-radius: 8px; overflow-x: auto; line-height: 1.45; margin: 0 0 1rem; }
pre code { background: none; padding: 0; overflow-wrap: normal; }
.notice { margin: 0 0 1rem; padding: .7rem 1rem; border-left: 4px solid var(--muted); background: var(--soft); border-radius: 0 8px 8px 0; }
.scroll { overflow-x: auto; margin: 0 0 1.5rem; }
table { border-collapse: collapse; font-size: .9rem; line-height: 1.4; font-variant-numeric: tabular-nums; }
caption { text-align: left; color: var(--muted); padding: 0 0 .5rem; }
th, td { padding: .38rem .8rem; text-align: left; vertical-align: top; border-bottom: 1px solid var(--line); }
thead th { border-bottom: 2px solid var(--muted); vertical-align: bottom; }
.right { text-align: right; white-space: nowrap; }
.centre { text-align: center; }
.good { background: var(--good); } .warn { background: var(--warn); } .bad { background: var(--bad); }
.notice.good, .notice.warn, .notice.bad { border-left-color: var(--ink); }
.facts th { font-weight: 600; white-space: nowrap; padding-left: 0; color: var(--muted); }
.facts td { overflow-wrap: anywhere; }
figure { margin: 1.5rem 0 2rem; }
figure svg, figure img { display: block; max-width: 100%; height: auto; }
figure .drawing { overflow-x: auto; margin: 0 -16px; }
figcaption { max-width: 46rem; margin-top: .6rem; font-size: .92rem; color: var(--muted); }
figcaption b { color: var(--ink); }
.command { display: block; margin-top: .3rem; }
details { margin: 0 0 1rem; border: 1px solid var(--line); border-radius: 8px; padding: .5rem 1rem; }
summary { cursor: pointer; font-weight: 600; }
details[open] > summary { margin-bottom: .6rem; }
@media (max-width: 640px) { main { padding: 20px 16px 48px; } figure svg { min-width: 640px; } }
@media print {
  body { font-size: 10.5pt; }
  main { max-width: none; padding: 0; }
  figure, tr, .notice { break-inside: avoid; }
  h2, h3 { break-after: avoid; }
  .scroll, pre, figure .drawing { overflow: visible; }
  figure .drawing { margin: 0; }
  pre { white-space: pre-wrap; }
  .good, .warn, .bad, svg * { -webkit-print-color-adjust: exact; print-color-adjust: exact; }
}
)";

/// Light and dark, screen and paper; with the dark colours of inline drawings.
std::string html_style() {
  std::string drawings;
  for (const PageColour& colour : all_colours())
    drawings +=
        fmt::format("  .f-{0} {{ fill: {1}; }} .s-{0} {{ stroke: {1}; }}\n", colour.name, colour.dark);
  return std::string(light) + "@media screen and (prefers-color-scheme: dark) {\n" + dark + drawings + "}\n" +
         rules;
}

std::string verdict_class(Verdict verdict) {
  constexpr const char* names[] = {"", "good", "warn", "bad"};
  return names[static_cast<std::size_t>(verdict)];
}

std::string align_class(Align align) {
  return align == Align::right ? "right" : align == Align::centre ? "centre" : "";
}

/// ` class="one two"`, nothing if both are empty.
std::string class_attribute(const std::string& one, const std::string& two = {}) {
  if (one.empty() && two.empty()) return "";
  return fmt::format(" class=\"{}{}{}\"", one, one.empty() || two.empty() ? "" : " ", two);
}

std::string anchor_of(const std::string& heading, std::size_t number) {
  std::string anchor = fmt::format("s{}", number);
  for (const char c : heading) {
    const char lower = c >= 'A' && c <= 'Z' ? char(c - 'A' + 'a') : c;
    if ((lower >= 'a' && lower <= 'z') || (lower >= '0' && lower <= '9'))
      anchor += anchor.size() == 1 + fmt::format("{}", number).size() ? std::string("-") + lower
                                                                      : std::string(1, lower);
    else if (anchor.back() != '-')
      anchor += '-';
  }
  while (anchor.back() == '-') anchor.pop_back();
  return anchor;
}

/// HTML knows the name space of svg by itself, and a page then names no address at all.
std::string inlined(std::string svg) {
  const std::string name_space = " xmlns=\"http://www.w3.org/2000/svg\"";
  if (const std::size_t at = svg.find(name_space); at != std::string::npos) svg.erase(at, name_space.size());
  if (svg.rfind("<?xml", 0) == 0) svg.erase(0, svg.find("?>") + 2);
  return svg;
}

}  // namespace

HtmlText html_element(const char* element, const std::string& plain) {
  HtmlText text;
  text.html_ = fmt::format("<{0}>{1}</{0}>", element, xml_escaped(plain));
  return text;
}

HtmlText::HtmlText(const std::string& plain) : html_(xml_escaped(plain)) {}

HtmlText html_code(const std::string& plain) {
  return html_element("code", plain);
}

HtmlText html_emphasis(const std::string& plain) {
  return html_element("em", plain);
}

HtmlText html_strong(const std::string& plain) {
  return html_element("strong", plain);
}

HtmlText html_number(double value, int digits) {
  if (!std::isfinite(value)) return "no value";
  const std::string text = fmt::format("{:.{}g}", value, digits);
  const std::size_t e = text.find('e');
  const auto signed_text = [](const std::string& number) {
    return number[0] == '-' ? "−" + number.substr(1) : number;
  };
  if (e == std::string::npos) return signed_text(text);
  const int exponent = std::stoi(text.substr(e + 1));
  return HtmlText(signed_text(text.substr(0, e)) + "×10") +
         html_element("sup", signed_text(fmt::format("{}", exponent)));
}

HtmlPage::HtmlPage(const std::string& title, const HtmlText& lead) : title_(title), lead_(lead) {}

void HtmlPage::heading(const std::string& text, int level) {
  assert(level == 2 || level == 3);
  const std::string anchor = anchor_of(text, contents_.size() + 1);
  contents_.push_back({anchor, text, level});
  body_ += fmt::format("<h{0} id=\"{1}\">{2}</h{0}>\n", level, anchor, xml_escaped(text));
}

void HtmlPage::paragraph(const HtmlText& text) {
  body_ += "<p>" + text.html() + "</p>\n";
}

void HtmlPage::list(const std::vector<HtmlText>& items) {
  body_ += "<ul>\n";
  for (const HtmlText& item : items) body_ += "<li>" + item.html() + "</li>\n";
  body_ += "</ul>\n";
}

void HtmlPage::notice(const HtmlText& text, Verdict verdict) {
  body_ += fmt::format("<div{}>{}</div>\n", class_attribute("notice", verdict_class(verdict)), text.html());
}

void HtmlPage::preformatted(const std::string& text) {
  body_ += "<pre tabindex=\"0\"><code>" + xml_escaped(text) + "</code></pre>\n";
}

void HtmlPage::table(const HtmlTable& table) {
  body_ += "<div class=\"scroll\" tabindex=\"0\"><table>\n";
  if (!table.caption.empty())
    body_ += fmt::format("<caption><b>Table {}.</b> {}</caption>\n", ++tables_, table.caption.html());
  body_ += "<thead><tr>";
  for (const HtmlColumn& column : table.columns)
    body_ += fmt::format("<th scope=\"col\"{}>{}</th>", class_attribute(align_class(column.align)),
                         column.header.html());
  body_ += "</tr></thead>\n<tbody>\n";
  for (const HtmlRow& row : table.rows) {
    assert(row.cells.size() <= table.columns.size());
    body_ += fmt::format("<tr{}>", class_attribute(verdict_class(row.verdict)));
    for (std::size_t i = 0; i < table.columns.size(); ++i) {
      const HtmlCell cell = i < row.cells.size() ? row.cells[i] : HtmlCell("");
      const std::string tip =
          cell.tooltip.empty() ? "" : fmt::format(" title=\"{}\"", xml_escaped(cell.tooltip));
      body_ += fmt::format("<td{}{}>{}</td>",
                           class_attribute(align_class(table.columns[i].align), verdict_class(cell.verdict)),
                           tip, cell.text.html());
    }
    body_ += "</tr>\n";
  }
  body_ += "</tbody></table></div>\n";
}

void HtmlPage::facts(const std::vector<std::pair<std::string, HtmlText>>& rows) {
  body_ += "<div class=\"scroll\" tabindex=\"0\"><table class=\"facts\"><tbody>\n";
  for (const auto& [name, value] : rows)
    body_ += fmt::format("<tr><th scope=\"row\">{}</th><td>{}</td></tr>\n", xml_escaped(name), value.html());
  body_ += "</tbody></table></div>\n";
}

void HtmlPage::machine_facts() {
  heading("Machine", 3);
  const auto rows = fact_rows(cloth::machine_facts());
  facts({rows.begin(), rows.end()});
}

void HtmlPage::folded(const std::string& summary, const std::string& text) {
  begin_details(summary);
  preformatted(text);
  end_details();
}

void HtmlPage::add_figure(const std::string& content, const HtmlText& caption, const std::string& command) {
  ++figures_;
  body_ += fmt::format(
      "<figure id=\"figure-{0}\"><div class=\"drawing\" tabindex=\"0\">{1}</div>\n<figcaption><b>Figure "
      "{0}.</b> {2}",
      figures_, content, caption.html());
  if (!command.empty()) body_ += "<span class=\"command\">Made by " + html_code(command).html() + "</span>";
  body_ += "</figcaption></figure>\n";
}

void HtmlPage::figure(const std::string& svg, const HtmlText& caption, const std::string& command) {
  add_figure(inlined(svg), caption, command);
}

void HtmlPage::picture(std::span<const unsigned char> png, const std::string& text, const HtmlText& caption,
                       const std::string& command) {
  add_figure(fmt::format("<img alt=\"{}\" src=\"data:image/png;base64,{}\">", xml_escaped(text), base64(png)),
             caption, command);
}

void HtmlPage::begin_details(const HtmlText& summary, bool open) {
  ++open_details_;
  body_ += fmt::format("<details{}><summary>{}</summary>\n", open ? " open" : "", summary.html());
}

void HtmlPage::end_details() {
  assert(open_details_ > 0);
  --open_details_;
  body_ += "</details>\n";
}

std::string HtmlPage::saved() const {
  nlohmann::ordered_json state{{"body", body_},
                               {"figures", figures_},
                               {"tables", tables_},
                               {"open_details", open_details_},
                               {"contents", nlohmann::ordered_json::array()}};
  for (const Entry& entry : contents_) state["contents"].push_back({entry.anchor, entry.text, entry.level});
  return state.dump(-1, ' ', false, nlohmann::ordered_json::error_handler_t::replace);
}

bool HtmlPage::restore(const std::string& saved) {
  try {
    const auto state = nlohmann::ordered_json::parse(saved);
    std::vector<Entry> contents;
    for (const auto& entry : state.at("contents"))
      contents.push_back(
          {entry.at(0).get<std::string>(), entry.at(1).get<std::string>(), entry.at(2).get<int>()});
    const int figures = state.at("figures").get<int>(), tables = state.at("tables").get<int>();
    open_details_ = state.at("open_details").get<int>();
    body_ = state.at("body").get<std::string>();
    figures_ = figures;
    tables_ = tables;
    contents_ = std::move(contents);
    return true;
  } catch (const nlohmann::ordered_json::exception&) {
    return false;
  }
}

std::string HtmlPage::to_html() const {
  const std::string title = xml_escaped(title_);
  std::string html =
      "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
      "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n<title>" +
      title + "</title>\n<style>\n" + html_style() + "</style>\n</head>\n<body>\n<main>\n<header>\n<h1>" +
      title + "</h1>\n";
  if (!lead_.empty()) html += "<p class=\"lead\">" + lead_.html() + "</p>\n";
  html += "</header>\n";
  if (contents_.size() > 1) {
    html += "<nav aria-label=\"Contents\"><ol>\n";
    for (const Entry& entry : contents_)
      html += fmt::format("<li class=\"level-{}\"><a href=\"#{}\">{}</a></li>\n", entry.level, entry.anchor,
                          xml_escaped(entry.text));
    html += "</ol></nav>\n";
  }
  html += body_;
  for (int i = 0; i < open_details_; ++i) html += "</details>\n";
  return html + "</main>\n</body>\n</html>\n";
}

std::string base64(std::span<const unsigned char> bytes) {
  constexpr const char* letters = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  text.reserve((bytes.size() + 2) / 3 * 4);
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    const std::size_t left = bytes.size() - i;
    const unsigned group = unsigned(bytes[i]) << 16 | (left > 1 ? unsigned(bytes[i + 1]) << 8 : 0u) |
                           (left > 2 ? unsigned(bytes[i + 2]) : 0u);
    text += letters[group >> 18 & 63];
    text += letters[group >> 12 & 63];
    text += left > 1 ? letters[group >> 6 & 63] : '=';
    text += left > 2 ? letters[group & 63] : '=';
  }
  return text;
}

}  // namespace cloth

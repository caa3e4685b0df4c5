#include "report/html_page.h"

#include <fmt/format.h>

#include <cassert>
#include <cmath>
#include <nlohmann/json.hpp>

#include "io/machine.h"
#include "report/html_style.h"
#include "report/svg.h"

namespace cloth {
namespace {

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

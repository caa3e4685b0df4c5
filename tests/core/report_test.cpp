#include <gtest/gtest.h>
#include <unistd.h>

#include <array>
#include <cmath>
#include <limits>
#include <set>
#include <tuple>

#include "report/html_page.h"
#include "report/line_plot.h"
#include "io/machine.h"
#include "report/palette.h"
#include "report/svg.h"
#include "support/xml.h"

namespace cloth::test::report_test {
namespace {

TEST(Palette, SeriesCanBeToldApart) {
  std::set<std::tuple<std::string, Marker>> pairs;
  std::set<std::tuple<std::string, Marker, Dash>> all;
  for (int i = 0; i < 160; ++i) {
    const SeriesStyle style = style_of_series(i);
    if (i < 40) pairs.insert({style.colour.name, style.marker});
    all.insert({style.colour.name, style.marker, style.dash});
  }
  EXPECT_EQ(pairs.size(), 40u);
  EXPECT_EQ(all.size(), 160u);
}

TEST(Palette, LinesAndTextStandOutOnBothPapers) {
  const PageColours& page = page_colours();
  for (int i = 0; i < 10; ++i) {
    const PageColour colour = style_of_series(i).colour;
    EXPECT_GE(contrast(colour.light, page.surface.light), 3) << colour.name;
    EXPECT_GE(contrast(colour.dark, page.surface.dark), 3) << colour.name;
  }
  for (const PageColour& colour : {page.ink, page.muted}) {
    EXPECT_GE(contrast(colour.light, page.surface.light), 4.5) << colour.name;
    EXPECT_GE(contrast(colour.dark, page.surface.dark), 4.5) << colour.name;
    EXPECT_GE(contrast(colour.light, page.band.light), 4.5) << colour.name;
    EXPECT_GE(contrast(colour.dark, page.band.dark), 4.5) << colour.name;
  }
}

TEST(Palette, ClassesDifferWithoutColour) {
  std::set<CellMark> marks;
  for (const ClassStyle& style : run_classes()) marks.insert(style.mark);
  EXPECT_EQ(marks.size(), 5u);
}

TEST(Palette, NamesOfColoursAreUnique) {
  std::set<std::string> names;
  for (const PageColour& colour : all_colours()) names.insert(colour.name);
  EXPECT_EQ(names.size(), all_colours().size());
}

TEST(SvgNumber, IsShortAndPlain) {
  EXPECT_EQ(svg_number(12), "12");
  EXPECT_EQ(svg_number(0.5), "0.5");
  EXPECT_EQ(svg_number(1.0 / 3), "0.33");
  EXPECT_EQ(svg_number(-0.001), "0");
  EXPECT_EQ(svg_number(-1.5), "-1.5");
  EXPECT_EQ(svg_number(100), "100");
  EXPECT_EQ(svg_number(std::nan("")), "0");
  EXPECT_EQ(svg_number(-std::numeric_limits<double>::infinity()), "0");
}

TEST(XmlEscaped, LeavesValidTextAndReplacesTheRest) {
  EXPECT_EQ(xml_escaped("<a href=\"x\">'&'"), "&lt;a href=&quot;x&quot;&gt;&#39;&amp;&#39;");
  EXPECT_EQ(xml_escaped("10⁻³ µm 𝛼"), "10⁻³ µm 𝛼");
  const std::string bad = "\xEF\xBF\xBD";
  EXPECT_EQ(xml_escaped("a\x01z"), "a" + bad + "z");
  EXPECT_EQ(xml_escaped("\xC3"), bad);                      // cut off
  EXPECT_EQ(xml_escaped("\xC0\xAF"), bad + bad);            // too long a form of /
  EXPECT_EQ(xml_escaped("\xED\xA0\x80"), bad + bad + bad);  // a surrogate
  EXPECT_EQ(xml_escaped("\xEF\xBF\xBF"), bad + bad + bad);  // U+FFFF
}

TEST(Wrapped, LosesNoWordAndKeepsTheWidth) {
  const std::string text = "The quick brown fox jumps over a remarkablyunbreakablelongword and on";
  std::string joined;
  for (const std::string& line : wrapped(text, 12, 90)) {
    joined += (joined.empty() ? "" : " ") + line;
    EXPECT_TRUE(text_width(line, 12) <= 90 || line.find(' ') == std::string::npos) << line;
  }
  EXPECT_EQ(joined, text);
  EXPECT_TRUE(wrapped("", 12, 90).empty());
}

TEST(Base64, FollowsTheExamplesOfRfc4648) {
  const auto encoded = [](const std::string& text) {
    return base64({reinterpret_cast<const unsigned char*>(text.data()), text.size()});
  };
  EXPECT_EQ(encoded(""), "");
  EXPECT_EQ(encoded("f"), "Zg==");
  EXPECT_EQ(encoded("fo"), "Zm8=");
  EXPECT_EQ(encoded("foo"), "Zm9v");
  EXPECT_EQ(encoded("foob"), "Zm9vYg==");
  EXPECT_EQ(encoded("fooba"), "Zm9vYmE=");
  EXPECT_EQ(encoded("foobar"), "Zm9vYmFy");
  EXPECT_EQ(encoded("\xff\xfe\xfd"), "//79");
}

HtmlPage sample_page() {
  HtmlPage page("Error & time", "For " + html_emphasis("your") + " scene.");
  page.heading("What came out");
  page.paragraph("Use " + html_code("--set a<b") + " & see <here>.");
  page.heading("What came out", 3);
  page.list({"one", html_strong("two")});
  page.notice("Mind the gap", Verdict::warn);
  LinePlot plot;
  plot.title = "A plot";
  plot.series = {{.name = "a", .points = {{1, 2}, {2, 3}}}};
  page.figure(to_svg(plot), "A caption", "clothlab-cli plot --x '<y>'");
  const std::array<unsigned char, 4> png = {0x89, 'P', 'N', 'G'};
  page.picture(png, "A \"flag\"", "Another");
  HtmlTable table{.caption = "Numbers", .columns = {{"Method"}, {"Error", Align::right}}};
  table.rows = {{{"a", {html_number(1.25e-7), Verdict::bad, "why \"so\""}}, Verdict::good}, {{"only one"}}};
  page.table(table);
  page.facts({{"Processor", "x < y"}});
  page.begin_details("More");
  page.begin_details("Even more", true);
  page.preformatted("{\n  \"a\": 1\n}");
  return page;
}

/// The page as XML: its few elements without an end are closed first.
XmlDocument as_xml(std::string html) {
  const std::string doctype = "<!DOCTYPE html>\n";
  EXPECT_EQ(html.rfind(doctype, 0), 0u);
  html.erase(0, doctype.size());
  for (const std::string start : {"<meta", "<img"})
    for (std::size_t at = html.find(start); at != std::string::npos; at = html.find(start, at + 1))
      html.insert(html.find('>', at), "/");
  const std::string open = " open>";
  if (const std::size_t at = html.find(open); at != std::string::npos)
    html.replace(at, open.size(), " open=\"\">");
  const std::size_t style = html.find("<style>") + 7;  // its text is no markup
  html.erase(style, html.find("</style>") - style);
  return read_xml(html);
}

TEST(HtmlPage, IsWellFormedWithItsTextEscaped) {
  const std::string html = sample_page().to_html();
  const XmlDocument document = as_xml(html);
  ASSERT_EQ(document.error, "");
  EXPECT_NE(html.find("<code>--set a&lt;b</code> &amp; see &lt;here&gt;."), std::string::npos);
  EXPECT_NE(html.find("Made by <code>clothlab-cli plot --x &#39;&lt;y&gt;&#39;</code>"), std::string::npos);
  EXPECT_NE(html.find("1.25×10<sup>−7</sup>"), std::string::npos);
}

TEST(HtmlPage, NamesNothingOutsideItself) {
  const std::string html = sample_page().to_html();
  for (const char* word : {"http", "//", "url(", "@import", "<script", "<link", "<iframe"})
    EXPECT_EQ(html.find(word), std::string::npos) << word;
  const XmlDocument document = as_xml(html);
  ASSERT_EQ(document.error, "");
  for (const XmlElement* element : all_elements(document.root))
    for (const auto& [key, value] : element->attributes) {
      EXPECT_TRUE(key != "href" || value.front() == '#') << value;
      EXPECT_TRUE(key != "src" || value.rfind("data:image/png;base64,", 0) == 0) << value;
    }
}

TEST(HtmlPage, ContentsLeadToTheHeadings) {
  const XmlDocument document = as_xml(sample_page().to_html());
  std::set<std::string> targets, links;
  for (const XmlElement* element : all_elements(document.root)) {
    const auto id = element->attributes.find("id");
    if (id != element->attributes.end()) {
      EXPECT_TRUE(targets.insert(id->second).second) << "id twice: " << id->second;
    }
    if (element->name == "a") links.insert(element->attributes.at("href").substr(1));
  }
  EXPECT_EQ(links.size(), 2u);
  for (const std::string& link : links) EXPECT_TRUE(targets.count(link)) << link;
}

TEST(HtmlPage, HasTheDarkColourOfEverythingThatADrawingUses) {
  const std::string html = sample_page().to_html();
  for (const PageColour& colour : all_colours()) {
    EXPECT_NE(html.find(".f-" + colour.name + " { fill: " + colour.dark), std::string::npos);
    EXPECT_NE(html.find(".s-" + colour.name + " { stroke: " + colour.dark), std::string::npos);
  }
}

TEST(HtmlNumber, ReadsAsPeopleWriteIt) {
  EXPECT_EQ(html_number(1234.5, 3).html(), "1.23×10<sup>3</sup>");
  EXPECT_EQ(html_number(-0.25).html(), "−0.25");
  EXPECT_EQ(html_number(0).html(), "0");
  EXPECT_EQ(html_number(std::nan("")).html(), "no value");
}

TEST(MachineFacts, NameTheBuildAndNeitherMachineNorUser) {
  const MachineFacts facts = machine_facts();
  EXPECT_FALSE(facts.processor.empty());
  EXPECT_FALSE(facts.compiler.empty());
  EXPECT_NE(facts.flags.find("-ffp-contract=off"), std::string::npos);
  ASSERT_EQ(facts.date.size(), 20u);
  EXPECT_EQ(facts.date[10], 'T');
  EXPECT_EQ(facts.date.back(), 'Z');
  std::array<char, 256> host{};
  if (gethostname(host.data(), host.size() - 1) != 0 || std::string(host.data()).size() < 6) return;
  for (const auto& [name, value] : fact_rows(facts))
    EXPECT_EQ(value.find(host.data()), std::string::npos) << name;
}

}  // namespace
}  // namespace cloth::test::report_test

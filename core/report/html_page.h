// Reports: one page of HTML that opens from disk and needs nothing else. Light or dark as the reader's system
// is; printable.
#pragma once

#include <span>
#include <string>
#include <utility>
#include <vector>

namespace cloth {

/// Text of a page. From a string: plain, escaped. Put together with +:
/// "Use " + html_code("--set") + " for " + html_emphasis("every") + " parameter."
class HtmlText {
 public:
  HtmlText(const char* plain) : HtmlText(std::string(plain)) {}
  HtmlText(const std::string& plain);
  HtmlText() = default;

  const std::string& html() const { return html_; }
  bool empty() const { return html_.empty(); }
  friend HtmlText operator+(HtmlText left, const HtmlText& right) {
    left.html_ += right.html_;
    return left;
  }

 private:
  friend HtmlText html_element(const char* element, const std::string& plain);
  std::string html_;
};
HtmlText html_code(const std::string& plain);
HtmlText html_emphasis(const std::string& plain);
HtmlText html_strong(const std::string& plain);
/// A number with a power of ten as a reader writes it: 1.2×10⁻³; "no value" where it is not finite.
HtmlText html_number(double value, int digits = 3);

enum class Align { left, centre, right };
enum class Verdict { none, good, warn, bad };

struct HtmlColumn {
  HtmlText header{};
  Align align = Align::left;  // numbers: right, with figures of one width
};
struct HtmlCell {
  HtmlCell(const char* plain) : text(plain) {}
  HtmlCell(const std::string& plain) : text(plain) {}
  HtmlCell(HtmlText content, Verdict value = Verdict::none, std::string tip = {})
      : text(std::move(content)), verdict(value), tooltip(std::move(tip)) {}

  HtmlText text{};
  Verdict verdict = Verdict::none;
  std::string tooltip{};
};
struct HtmlRow {
  std::vector<HtmlCell> cells{};  // at most one for each column; missing ones are empty
  Verdict verdict = Verdict::none;
};
struct HtmlTable {
  HtmlText caption{};
  std::vector<HtmlColumn> columns{};
  std::vector<HtmlRow> rows{};
};

class HtmlPage {
 public:
  explicit HtmlPage(const std::string& title, const HtmlText& lead = {});

  /// Level 2 or 3; both appear in the table of contents.
  void heading(const std::string& text, int level = 2);
  void paragraph(const HtmlText& text);
  void list(const std::vector<HtmlText>& items);
  /// A paragraph set apart, for what a reader must not miss.
  void notice(const HtmlText& text, Verdict verdict = Verdict::none);
  void preformatted(const std::string& text);
  void table(const HtmlTable& table);
  /// Two columns, name and value: how it was measured.
  void facts(const std::vector<std::pair<std::string, HtmlText>>& rows);

  /// What the measurements were made on, under a heading of its own.
  void machine_facts();
  /// A text that can be unfolded.
  void folded(const std::string& summary, const std::string& text);

  /// Numbered. `svg` is what to_svg made; `command` makes the figure, empty: none.
  void figure(const std::string& svg, const HtmlText& caption, const std::string& command = {});
  /// `text` tells what the picture shows to who cannot see it.
  void picture(std::span<const unsigned char> png, const std::string& text, const HtmlText& caption,
               const std::string& command = {});

  /// What follows until end_details can be folded away. They can be nested.
  void begin_details(const HtmlText& summary, bool open = false);
  void end_details();

  /// The whole page. Open details are closed.
  std::string to_html() const;

  /// What has been put on it, as text that another page can begin with.
  std::string saved() const;
  /// False where the text is not one that saved() gave.
  bool restore(const std::string& saved);

 private:
  struct Entry {
    std::string anchor, text;
    int level;
  };
  void add_figure(const std::string& content, const HtmlText& caption, const std::string& command);

  std::string title_;
  HtmlText lead_;
  std::string body_;
  std::vector<Entry> contents_;
  int figures_ = 0, tables_ = 0, open_details_ = 0;
};

/// RFC 4648, without line ends.
std::string base64(std::span<const unsigned char> bytes);

}  // namespace cloth

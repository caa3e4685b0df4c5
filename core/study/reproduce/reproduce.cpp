#include "study/reproduce.h"

#include <algorithm>
#include <array>

#include "io/csv.h"
#include "io/machine.h"
#include "study/reproduce/reproduction_index.h"
#include "study/reproduce/study_page.h"

namespace cloth {
namespace {

struct Part {
  const char* name;
  double cost;  ///< some seconds; only their ratios matter, for the progress
  void (*run)(StudyPage&);
};
constexpr std::array<Part, 8> parts{{
    {"fig1", 0.3, reproduce_springs},
    {"fig2", 4, reproduce_deformation},
    {"fig3", 3, reproduce_wind},
    {"fig4", 3, reproduce_methods},
    {"fig5", 10, reproduce_obstacles},
    {"table1", 10, reproduce_table},
    {"equal-error", 25, reproduce_equal_error},
    {"errata", 3, reproduce_errata},
}};

bool is_wanted(const ReproduceOptions& options, const Part& part) {
  return options.only.empty() ||
         std::find(options.only.begin(), options.only.end(), part.name) != options.only.end();
}

HtmlText lead() {
  return HtmlText("The results of ") + html_emphasis("Cloth Simulation") +
         " (course project in computer graphics, 2024, after Provot 1995), measured here with Clothlab: its "
         "figures, its Table 1 with what the table leaves out, and its misprints shown by experiment. Under "
         "each figure stands the command that makes it again.";
}

void add_machine(HtmlPage& page) {
  page.heading("Machine and measurement");
  std::vector<std::pair<std::string, HtmlText>> rows;
  for (const auto& [name, value] : fact_rows(machine_facts())) rows.emplace_back(name, value);
  rows.emplace_back("Clock", "steady clock, around the stepping loop only: no pictures, files or set-up");
  rows.emplace_back("Repeats",
                    "the methods in turn, again and again, after one untimed round; the minimum "
                    "counts, the spread from minimum to maximum stands beside it");
  rows.emplace_back("Threads", "one");
  rows.emplace_back("Errors",
                    "root mean square distance of the particles from a reference at the same time, in "
                    "metres; the reference is checked by halving its step");
  page.facts(rows);
  page.paragraph("Times depend on the machine; ratios far less. Everything else repeats to the last bit.");
}

std::string numbers_csv(const std::vector<Measured>& numbers) {
  CsvTable table{{"part", "name", "unit", "value", "expected"}, {}};
  for (const Measured& number : numbers)
    table.rows.push_back({number.part, number.name, number.unit, csv_number(number.value),
                          number.expected ? csv_number(*number.expected) : ""});
  return csv_text(table, "\r\n");
}

}  // namespace

std::vector<std::string> reproduce_parts() {
  std::vector<std::string> names;
  for (const Part& part : parts) names.emplace_back(part.name);
  return names;
}

ReproduceResult reproduce(const ReproduceOptions& options) {
  ReproduceResult result;
  HtmlPage page("The report's results, measured here", lead());
  ReproductionIndex index;
  ResultFolder& folder = index.folder();
  result.io_error = index.begin(options, page, result);
  if (result.io_error) return result;

  double total = 0, done = 0;
  for (const Part& part : parts) total += is_wanted(options, part) ? part.cost : 0;
  StudyPage study(options, folder, page, result);
  for (const Part& part : parts) {
    if (!is_wanted(options, part)) continue;
    if (index.has(part.name)) {
      done += part.cost;
      continue;
    }
    study.begin_part(part.name, done / total, part.cost / total);
    if (!study.go_on(0)) break;
    part.run(study);
    done += part.cost;
    if (study.go_on(1)) result.io_error = index.keep(part.name, page, result);
    if (result.io_error) return result;
  }
  if (result.stopped)
    page.notice("Stopped before the end: what follows the last figure here was not measured.", Verdict::warn);
  add_machine(page);
  study.write("numbers.csv", numbers_csv(result.numbers));
  study.write("report.html", page.to_html());
  if (!result.io_error) result.io_error = index.end(result);
  return result;
}

}  // namespace cloth

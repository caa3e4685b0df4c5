#include "study/reproduce/reproduction_index.h"

#include <algorithm>

#include "io/json_entry.h"
#include "io/machine.h"
#include "io/text_file.h"
#include "kernels/instruction_set.h"

namespace cloth {
namespace {

using IndexJson = nlohmann::ordered_json;
const char* const index_name = "reproduce.json";

IndexJson inputs_of(const ReproduceOptions& options) {
  IndexJson wanted = IndexJson::array();
  for (const std::string& part : reproduce_parts())
    if (options.only.empty() ||
        std::find(options.only.begin(), options.only.end(), part) != options.only.end())
      wanted.push_back(part);
  return {{"parts", wanted},
          {"version", version()},
          {"instruction_set", name_of(active_instruction_set())},
          {"processor", machine_facts().processor}};
}

IndexJson numbers_of(const ReproduceResult& result) {
  IndexJson numbers = IndexJson::array();
  for (const Measured& number : result.numbers)
    numbers.push_back({number.part, number.name, number.unit, csv_number(number.value),
                       number.expected ? IndexJson(csv_number(*number.expected)) : IndexJson()});
  return numbers;
}

std::vector<Measured> numbers_from(const IndexJson& numbers) {
  std::vector<Measured> measured;
  for (const auto& number : numbers) {
    Measured entry{number.at(0).get<std::string>(),
                   number.at(1).get<std::string>(),
                   number.at(2).get<std::string>(),
                   std::stod(number.at(3).get<std::string>()),
                   {}};
    if (!number.at(4).is_null()) entry.expected = std::stod(number.at(4).get<std::string>());
    measured.push_back(std::move(entry));
  }
  return measured;
}

}  // namespace

std::optional<IoError> ReproductionIndex::begin(const ReproduceOptions& options, HtmlPage& page,
                                                ReproduceResult& result) {
  inputs_ = inputs_of(options);
  const FolderUse use{.kind = "reproduce", .files = {"report.html", "numbers.csv", index_name}};
  if (auto error = folder_.lock(options.folder, use)) return error;
  if (auto error = look_at_earlier(options, page, result)) {
    folder_.release();
    return error;
  }
  if (parts_.empty()) return folder_.begin_anew();
  if (options.goes_on) options.goes_on(static_cast<int>(parts_.size()));
  return folder_.go_on();
}

std::optional<IoError> ReproductionIndex::look_at_earlier(const ReproduceOptions& options, HtmlPage& page,
                                                          ReproduceResult& result) {
  std::string text;
  std::error_code ignored;
  if (options.overwrite || !std::filesystem::exists(folder_ / index_name, ignored)) return std::nullopt;
  if (auto error = read_text_file(folder_ / index_name, text)) return error;
  try {
    const IndexJson root = IndexJson::parse(text);
    if (root.at("complete").get<bool>() || root.at("finished").empty()) return std::nullopt;
    if (root.at("inputs") != inputs_)
      return IoError{
          options.folder,
          "holds an unfinished reproduction of other parts, or of another version or machine: give "
          "another folder, or --overwrite to begin anew",
          true};
    state_ = root.at("state");
    auto numbers = numbers_from(state_.at("numbers"));
    auto files = state_.at("files").get<std::vector<std::string>>();
    const auto digests = digests_of(JsonEntry(state_.at("digests")));
    if (!agree(digests)) return std::nullopt;
    auto parts = root.at("finished").get<std::vector<std::string>>();
    if (!page.restore(state_.at("page").get<std::string>())) return std::nullopt;
    result.numbers = std::move(numbers);
    result.files = std::move(files);
    parts_ = std::move(parts);
    for (const FileDigest& digest : digests) folder_.note(digest);
  } catch (...) {  // it was changed since: nothing of it can be used
    result = {};
    parts_.clear();
  }
  return std::nullopt;
}

/// Whether the files of the finished parts are still those that were written.
bool ReproductionIndex::agree(const std::vector<FileDigest>& digests) const {
  std::string text;
  for (const FileDigest& expected : digests) {
    if (read_text_file(folder_ / expected.name, text)) return false;
    if (!disagreement(expected, digest_of(expected.name, text, expected.rows.has_value())).empty())
      return false;
  }
  return true;
}

bool ReproductionIndex::has(const std::string& part) const {
  return std::find(parts_.begin(), parts_.end(), part) != parts_.end();
}

std::optional<IoError> ReproductionIndex::keep(const std::string& part, const HtmlPage& page,
                                               const ReproduceResult& result) {
  parts_.push_back(part);
  state_ = {{"page", page.saved()},
            {"numbers", numbers_of(result)},
            {"files", result.files},
            {"digests", digests_json(folder_.digests())}};
  const IndexJson root{{"program", "clothlab"}, {"kind", "reproduce"}, {"complete", false},
                       {"inputs", inputs_},     {"finished", parts_},  {"state", state_}};
  if (auto error = folder_.add(index_name)) return error;
  return write_text_file(folder_ / index_name,
                         root.dump(-1, ' ', false, IndexJson::error_handler_t::replace) + "\n");
}

std::optional<IoError> ReproductionIndex::end(const ReproduceResult& result) {
  IndexJson root{{"program", "clothlab"}, {"kind", "reproduce"}, {"complete", !result.stopped},
                 {"inputs", inputs_},     {"finished", parts_},  {"files", digests_json(folder_.digests())}};
  if (result.stopped) root["state"] = state_;
  return folder_.finish(index_name, root.dump(2, ' ', false, IndexJson::error_handler_t::replace) + "\n");
}

}  // namespace cloth

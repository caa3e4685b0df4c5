#include "study/identify/fit_runs.h"

#include <cmath>
#include <nlohmann/json.hpp>

#include "io/json_entry.h"
#include "io/machine.h"
#include "io/text_file.h"
#include "kernels/instruction_set.h"

namespace cloth {
namespace {

using json = nlohmann::ordered_json;

constexpr const char* runs_format = "clothlab/fit-runs/1";

/// JSON has no numbers that are not finite; a fit takes all of them for no value.
json json_of(const std::vector<double>& numbers) {
  json list = json::array();
  for (const double number : numbers) list.push_back(std::isfinite(number) ? json(number) : json(nullptr));
  return list;
}

std::vector<double> numbers_of(const JsonEntry& list) {
  std::vector<double> numbers;
  for (const JsonEntry& entry : list.entries())
    numbers.push_back(entry.is_null() ? std::numeric_limits<double>::quiet_NaN() : entry.number());
  return numbers;
}

std::string line_of_run(const std::vector<double>& values, const std::vector<double>& outputs) {
  return json{{"values", json_of(values)}, {"outputs", json_of(outputs)}}.dump();
}

}  // namespace

std::string FitRuns::first_line() const {
  return json{{"format", runs_format},
              {"model", model_},
              {"version", version()},
              {"instruction_set", name_of(active_instruction_set())}}
      .dump();
}

bool FitRuns::read(const std::filesystem::path& path) {
  std::string text;
  if (read_text_file(path, text)) return false;
  std::size_t end = text.find('\n');
  if (end == std::string::npos || text.substr(0, end) != first_line()) return false;
  for (std::size_t begin = end + 1; (end = text.find('\n', begin)) != std::string::npos; begin = end + 1) {
    try {
      const json line = json::parse(text.substr(begin, end - begin), nullptr, false);
      const JsonEntry run(line);
      runs_[numbers_of(run.at("values"))] = numbers_of(run.at("outputs"));
    } catch (const BadJsonEntry&) {
      // A line that a loss of power left: its run is made again.
    }
  }
  read_ = runs_.size();
  return true;
}

std::optional<IoError> FitRuns::open(const std::filesystem::path& path) {
  std::string text = first_line() + "\n";
  for (const auto& [values, outputs] : runs_) text += line_of_run(values, outputs) + "\n";
  if (auto error = write_text_file(path, text)) return error;
  return file_.open_at_end(path);
}

std::optional<std::vector<double>> FitRuns::find(const std::vector<double>& values) const {
  const std::lock_guard lock(mutex_);
  const auto found = runs_.find(values);
  if (found == runs_.end()) return std::nullopt;
  return found->second;
}

void FitRuns::add(const std::vector<double>& values, const std::vector<double>& outputs) {
  const std::lock_guard lock(mutex_);
  runs_[values] = outputs;
  if (!file_.is_open() || error_) return;
  error_ = file_.add(line_of_run(values, outputs));
  if (!error_) error_ = file_.flush();
}

std::optional<IoError> FitRuns::error() const {
  const std::lock_guard lock(mutex_);
  return error_;
}

}  // namespace cloth

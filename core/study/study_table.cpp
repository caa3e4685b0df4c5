#include "study/study_table.h"

#include <algorithm>
#include <charconv>
#include <cmath>

#include "io/text_file.h"

namespace cloth {

Rows::Rows(const std::filesystem::path& folder, const char* name, const JsonEntry& root) : name_(name) {
  std::string text;
  const bool grows = !root.has("files") && !root.at("complete").flag();
  if (grows && !std::filesystem::exists(folder / name)) return;
  if (const auto error = read_text_file(folder / name, text))
    throw BadFolder{fmt::format("{}: {}", name, error->message), true};
  if (grows) text.resize(text.rfind('\n') + 1);  // npos + 1 is 0
  table_ = parse_csv(text);
  for (std::size_t k = 0; k < table_.header.size(); ++k) columns_[table_.header[k]] = k;
}

std::string Rows::text(std::size_t row, const char* column) const {
  const auto at = columns_.find(column);
  if (at == columns_.end()) throw BadFolder{fmt::format("{}: has no column \"{}\"", name_, column)};
  const auto& fields = table_.rows[row];
  if (at->second >= fields.size()) throw bad(row, column, "", "is missing");
  return fields[at->second];
}

double Rows::number(std::size_t row, const char* column, std::optional<double> empty) const {
  const std::string field = text(row, column);
  if (field.empty() && empty) return *empty;
  double value = 0;
  const char* end = field.data() + field.size();
  const auto [last, error] = std::from_chars(field.data(), end, value);
  if (error != std::errc() || last != end || field.empty()) throw bad(row, column, field, "must be a number");
  return value;
}

std::int64_t Rows::whole(std::size_t row, const char* column, std::int64_t least, std::int64_t most) const {
  const double value = number(row, column, 0.0);
  if (!(std::abs(value) < 1e18)) throw bad(row, column, text(row, column), "must be a whole number");
  const auto whole = static_cast<std::int64_t>(value);
  if (whole < least || whole > most)
    throw bad(row, column, text(row, column), fmt::format("must be from {} to {}", least, most));
  return whole;
}

BadFolder Rows::bad(std::size_t row, const char* column, const std::string& value,
                    const std::string& rule) const {
  return {fmt::format("{}, line {}, {}: \"{}\" {}", name_, row + 2, column, value, rule)};
}

bool CsvFields::add(const char* name, const std::string& value) {
  if (rows_) return true;
  names.emplace_back(name);
  texts.push_back(value);
  is_derived_.push_back(false);
  return false;
}

std::vector<std::pair<std::string, std::string>> CsvFields::results() const {
  std::vector<std::pair<std::string, std::string>> found;
  for (std::size_t k = 0; k < names.size(); ++k)
    if (!is_derived_[k] && names[k] != "wall_s") found.emplace_back(names[k], texts[k]);
  return found;
}

void CsvFields::text(const char* name, std::string& value) {
  if (add(name, value)) value = rows_->text(row_, name);
}

void CsvFields::choice(const char* name, std::size_t& index, std::span<const char* const> known) {
  if (!add(name, known[index])) return;
  const std::string found = rows_->text(row_, name);
  index = static_cast<std::size_t>(std::find(known.begin(), known.end(), found) - known.begin());
  if (index == known.size()) throw rows_->bad(row_, name, found, "is not a status");
}

void CsvFields::number(const char* name, double& value, bool present, std::optional<double> empty) {
  const std::string shown = std::isinf(value) ? "infinity" : csv_number(value);
  if (add(name, present ? shown : "")) value = rows_->number(row_, name, empty);
}

void CsvFields::finite(const char* name, double& value) {
  number(name, value, std::isfinite(value), std::numeric_limits<double>::quiet_NaN());
}

}  // namespace cloth

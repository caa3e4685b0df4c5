// The columns of a study's tables, each named once: visit_fields(CsvFields&, Record&, context...) lists the
// fields of a record in their order, and its rows are written and read by it.
#pragma once

#include <limits>
#include <map>
#include <span>

#include "io/csv.h"
#include "io/json_entry.h"

namespace cloth {

/// What is wrong with a folder, on its way to the reader's caller.
struct BadFolder {
  std::string problem;
  bool is_lost = false;  ///< see StudyReading
};

/// A CSV file of the folder, by row and column name.
class Rows {
 public:
  /// Of a study that is being made, or was killed, a table may not be there yet, and a loss of power may have
  /// cut its last line. `root` is study.json.
  Rows(const std::filesystem::path& folder, const char* name, const JsonEntry& root);

  std::size_t size() const { return table_.rows.size(); }
  bool has(const char* column) const { return columns_.contains(column); }
  std::string text(std::size_t row, const char* column) const;
  /// `empty`: the value of an empty field; none: it may not be empty.
  double number(std::size_t row, const char* column, std::optional<double> empty = {}) const;
  std::int64_t whole(std::size_t row, const char* column, std::int64_t least, std::int64_t most) const;
  BadFolder bad(std::size_t row, const char* column, const std::string& value, const std::string& rule) const;

 private:
  std::string name_;
  CsvTable table_;
  std::map<std::string, std::size_t> columns_;
};

/// The fields of one row: written, or read where there are rows to read from.
class CsvFields {
 public:
  CsvFields() = default;
  CsvFields(const Rows& rows, std::size_t row) : rows_(&rows), row_(row) {}

  void text(const char* name, std::string& value);
  void choice(const char* name, std::size_t& index, std::span<const char* const> known);
  template <class Status>
  void status(Status& status, std::span<const char* const> known) {
    auto index = static_cast<std::size_t>(status);
    choice("status", index, known);
    status = static_cast<Status>(index);
  }
  /// Left empty unless `present`, infinity as a word; `empty` as in Rows.
  void number(const char* name, double& value, bool present = true, std::optional<double> empty = {});
  /// Left empty where it is not finite.
  void finite(const char* name, double& value);
  template <class Integer>
  void whole(const char* name, Integer& value, bool present = true,
             std::int64_t least = std::numeric_limits<std::int64_t>::min(),
             std::int64_t most = std::numeric_limits<std::int64_t>::max()) {
    if (add(name, present ? std::to_string(value) : ""))
      value = static_cast<Integer>(rows_->whole(row_, name, least, most));
  }
  /// What follows from other fields is not read.
  void derived(const char* name, const std::string& value) {
    if (!add(name, value)) is_derived_.back() = true;
  }

  bool has(const char* name) const { return !rows_ || rows_->has(name); }

  std::vector<std::string> names, texts;  ///< as written

  /// Names and texts of what another process must come to as well: neither derived from what may be missing
  /// there, nor measured on the clock.
  std::vector<std::pair<std::string, std::string>> results() const;

 private:
  /// Whether the field is to be read; otherwise it has been written.
  bool add(const char* name, const std::string& value);

  const Rows* rows_ = nullptr;
  std::size_t row_ = 0;
  std::vector<bool> is_derived_;  ///< of what was written
};

template <class Record, class... Context>
CsvFields written(Record record, const Context&... context) {
  CsvFields fields;
  visit_fields(fields, record, context...);
  return fields;
}

template <class Record, class... Context>
void read_row(const Rows& rows, std::size_t row, Record& record, const Context&... context) {
  CsvFields fields(rows, row);
  visit_fields(fields, record, context...);
}

}  // namespace cloth

// A value of a JSON file with its path, for readers of files that this program writes itself: whatever is not
// as it should be is thrown as a problem that names it.
//
//     const JsonEntry options = JsonEntry(root).at("options");
//     const int repeats = options.at("repeats").whole<int>(1, 1000);
#pragma once

#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "io/json_reader.h"

namespace cloth {

/// Thrown; its line and column are for who has the text.
struct BadJsonEntry {
  Problem problem;
};

class JsonEntry {
 public:
  explicit JsonEntry(const nlohmann::ordered_json& value, std::string path = {})
      : value_(&value), path_(std::move(path)) {}

  const nlohmann::ordered_json& value() const { return *value_; }

  bool has(const std::string& key) const { return value_->is_object() && value_->contains(key); }
  bool is_null() const { return value_->is_null(); }

  JsonEntry at(const std::string& key) const {
    const std::string path = joined_path(path_, key);
    if (!value_->is_object()) throw bad("must be an object");
    const auto found = value_->find(key);
    if (found == value_->end()) throw BadJsonEntry{{path, "", "is missing", "", 0, 0}};
    return JsonEntry(*found, path);
  }

  /// The entries of a list.
  std::vector<JsonEntry> entries() const {
    if (!value_->is_array()) throw bad("must be a list");
    std::vector<JsonEntry> all;
    for (std::size_t k = 0; k < value_->size(); ++k)
      all.emplace_back((*value_)[k], joined_path(path_, std::to_string(k)));
    return all;
  }

  /// The names of an object's members.
  std::vector<std::string> keys() const {
    if (!value_->is_object()) throw bad("must be an object");
    std::vector<std::string> all;
    for (const auto& [key, ignored] : value_->items()) all.push_back(key);
    return all;
  }

  double number() const {
    if (!value_->is_number()) throw bad("must be a number");
    return value_->get<double>();
  }

  /// Looked at as a double first: a conversion of one that the type cannot hold has no defined result.
  template <class Integer>
  Integer whole(double least, double most) const {
    const double number = value_->is_number() ? value_->get<double>() : NAN;
    if (!(number >= least && number <= most && std::floor(number) == number))
      throw bad(fmt::format("must be a whole number, >= {:.15g} and <= {:.15g}", least, most));
    return static_cast<Integer>(number);
  }

  bool flag() const {
    if (!value_->is_boolean()) throw bad("must be true or false");
    return value_->get<bool>();
  }

  std::string text() const {
    if (!value_->is_string()) throw bad("must be a text in quotes");
    return value_->get<std::string>();
  }

  std::vector<std::string> texts() const {
    std::vector<std::string> all;
    for (const JsonEntry& entry : entries()) all.push_back(entry.text());
    return all;
  }

  BadJsonEntry bad(const std::string& rule) const {
    return {{path_, value_->is_structured() ? "" : shown_json(*value_), rule, "", 0, 0}};
  }

 private:
  const nlohmann::ordered_json* value_;
  std::string path_;
};

/// Whole numbers up to here are doubles exactly.
inline constexpr double largest_whole = 9007199254740992.0;

}  // namespace cloth

// What readers of a JSON document share that answer with every problem at once. A document that the program
// wrote itself ends at its first problem: io/json_entry.h.
#pragma once

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "io/json_locator.h"
#include "params/parameter.h"
#include "params/problem.h"

namespace cloth {

/// A value as a message shows it, cut after 60 characters.
template <class Json>
std::string shown_json(const Json& value) {
  constexpr std::size_t longest = 60;
  std::string text = value.is_number_float() ? fmt::format("{}", value.template get<double>())
                                             : value.dump(-1, ' ', false, Json::error_handler_t::replace);
  if (text.size() > longest) text = text.substr(0, longest - 3) + "...";
  return text;
}

/// Base of a reader. Paths are dotted; places are for who has the text (JsonLocations).
template <class Json>
class JsonReader {
 public:
  std::vector<Problem> problems;

 protected:
  /// Of the value at `path`.
  void problem(const std::string& path, const Json& value, const std::string& rule) {
    problems.push_back({path, shown_json(value), rule, "", 0, 0});
  }

  /// Of something that has no value, or none to show.
  void add_problem(const std::string& path, const std::string& rule) {
    problems.push_back({path, "", rule, "", 0, 0});
  }

  /// Those of a part that was read by another reader, which lies at `path`.
  void add_problems(const std::string& path, std::vector<Problem> found) {
    for (Problem& one : found) {
      one.path = one.path.empty() ? path : joined_path(path, one.path);
      problems.push_back(std::move(one));
    }
  }

  static const Json* member(const Json& from, const std::string& key) {
    const auto found = from.find(key);
    return found == from.end() ? nullptr : &*found;
  }

  /// A member that must be there.
  const Json* required(const Json& from, const std::string& path, const std::string& key,
                       const std::string& rule = "must be given") {
    const Json* const value = member(from, key);
    if (!value) add_problem(joined_path(path, key), rule);
    return value;
  }

  bool object(const Json& value, const std::string& path,
              const std::string& rule = "must be an object in braces") {
    if (!value.is_object()) problem(path, value, rule);
    return value.is_object();
  }

  bool list(const Json& value, const std::string& path, const std::string& rule = "must be a list") {
    if (!value.is_array()) problem(path, value, rule);
    return value.is_array();
  }

  /// The format may be left out.
  void format(const Json& root, const char* expected) {
    if (const Json* value = member(root, "format"); value && *value != expected)
      problem("format", *value, fmt::format("must be \"{}\"", expected));
  }

  /// What is not there stays as it is.
  void text(const Json& from, const std::string& path, const std::string& key, std::string& into) {
    const Json* const value = member(from, key);
    if (value && value->is_string())
      into = value->template get<std::string>();
    else if (value)
      problem(joined_path(path, key), *value, "must be a text in quotes");
  }

  void number(const Json& from, const std::string& path, const std::string& key, double& into) {
    const Json* const value = member(from, key);
    if (value && value->is_number())
      into = value->template get<double>();
    else if (value)
      problem(joined_path(path, key), *value, "must be a number");
  }

  template <class Names = std::vector<std::string>>
  void known_keys(const Json& from, const std::string& path, const Names& known) {
    for (const auto& [key, value] : from.items())
      if (std::find(known.begin(), known.end(), key) == known.end())
        add_problem(joined_path(path, key),
                    fmt::format("is not a known key; known here: {}", fmt::join(known, ", ")));
  }
};

}  // namespace cloth

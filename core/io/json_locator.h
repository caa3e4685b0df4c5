// Where the values of a JSON text stand. The JSON library checks the text; this only finds lines and columns
// in it.
#pragma once

#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "params/problem.h"

namespace cloth {

struct TextPosition {
  int line = 1, column = 1;  ///< from 1; columns count bytes
};

/// The position of byte `offset` of `text`.
TextPosition position_of(std::string_view text, std::size_t offset);

struct JsonLocations {
  std::map<std::string, TextPosition> values;  ///< by dotted path; "" is the root
  std::map<std::string, TextPosition> keys;    ///< by dotted path, where the key itself stands
  std::vector<std::string> repeated;           ///< paths that an object has more than once

  /// The most precise place that the text has for `path`: its value, or its key if `of_key`; for what is not
  /// in the text, that which would hold it.
  TextPosition place_of(std::string path, bool of_key) const;

  /// Sets place, line and column of a problem in this text, which `place` names.
  void put_in_place(Problem& problem, const std::string& place) const;

  /// That a path is given more than once, for each such path; not yet put in place.
  std::vector<Problem> repetitions() const;
};

/// Into the order of the text; problems without a line come first.
void sort_by_place(std::vector<Problem>& problems);

/// Precondition: `text` is one valid JSON value.
JsonLocations locate_json(std::string_view text);

}  // namespace cloth

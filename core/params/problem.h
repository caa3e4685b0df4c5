// What is wrong with a scene: place, value, rule. Bad input is answered with all problems at once.
#pragma once

#include <string>

namespace cloth {

struct Problem {
  std::string path;          ///< dotted path of the parameter, empty for the file as a whole
  std::string value;         ///< as given, with its unit; empty where there is none
  std::string rule;          ///< what it breaks
  std::string place{};       ///< file name, or the option that set the value
  int line = 0, column = 0;  ///< from 1; 0 where the place has no lines

  /// `flag.scene.json:7:21: springs.structural = -3 N/m: must be >= 0`
  std::string text() const;
};

}  // namespace cloth

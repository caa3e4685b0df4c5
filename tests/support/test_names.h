// Names of parametrised tests.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <string>

namespace cloth::test {

/// A word of the program, as "semi-implicit-euler", in the letters that GoogleTest allows.
inline std::string test_word(std::string word) {
  std::replace(word.begin(), word.end(), '-', '_');
  return word;
}

/// Of a test whose parameter is such a word.
inline std::string test_name(const ::testing::TestParamInfo<std::string>& info) {
  return test_word(info.param);
}

}  // namespace cloth::test

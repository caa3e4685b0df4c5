// These laws run once with each instruction set: here that the one asked for is in use.
#include "kernels/instruction_set.h"

#include <gtest/gtest.h>

#include <cstdlib>

namespace cloth::test::instruction_set_test {
namespace {

/// Ends the program before its first test where the processor lacks the instruction set that is asked for, and
/// where the tests without a named set, which ctest lists one by one, use it.
class Processor : public ::testing::Environment {
  void SetUp() override {
    if (const std::string problem = instruction_set_problem(); !problem.empty()) GTEST_SKIP() << problem;
    const char* wish = std::getenv(instruction_set_variable);
    if (wish && std::string(wish) == name_of(supported_instruction_sets().back()))
      GTEST_SKIP() << "the tests without a named instruction set use it";
  }
};

[[maybe_unused]] const auto* const processor = ::testing::AddGlobalTestEnvironment(new Processor);

}  // namespace

TEST(InstructionSets, TheOneThatTheEnvironmentNamesIsUsed) {
  if (const char* wish = std::getenv(instruction_set_variable)) {
    EXPECT_STREQ(name_of(active_instruction_set()), wish);
  } else {
    EXPECT_EQ(active_instruction_set(), supported_instruction_sets().back());
  }
}

}  // namespace cloth::test::instruction_set_test

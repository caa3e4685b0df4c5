// clothlab_window_tests NAME [OPTION]...: runs the tests of one file; QtTest's options follow.
#include <cstdio>

#include "listed_test.h"

int main(int argc, char** argv) {
  const auto& tests = clothlab::test::listed_tests();
  const auto found = argc > 1 ? tests.find(argv[1]) : tests.end();
  if (found != tests.end()) return found->second(argc - 1, argv + 1);
  std::fprintf(stderr, "usage: clothlab_window_tests NAME [OPTION]..., where NAME is one of\n");
  for (const auto& [name, run] : tests) std::fprintf(stderr, "  %s\n", name.c_str());
  return 2;
}

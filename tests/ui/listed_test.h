// One program holds the tests of the window; each file puts its own on the list under its name.
#pragma once

#include <QApplication>
#include <QtTest>
#include <map>
#include <string>

namespace clothlab::test {

using TestMain = int (*)(int argc, char** argv);

inline std::map<std::string, TestMain>& listed_tests() {
  static std::map<std::string, TestMain> tests;
  return tests;
}

struct Listed {
  Listed(const char* name, TestMain run) { listed_tests()[name] = run; }
};

template <class Test, class Application = QApplication>
int test_main(int argc, char** argv) {
  Application application(argc, argv);
  application.setAttribute(Qt::AA_Use96Dpi, true);
  Test test;
  return QTest::qExec(&test, argc, argv);
}

}  // namespace clothlab::test

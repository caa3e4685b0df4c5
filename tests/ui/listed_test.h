// One program holds the tests of the window; each file puts its own on the list under its name.
#pragma once

#include <QApplication>
#include <QTemporaryDir>
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

/// Runs the tests of one file. Settings and what is kept aside begin empty and are gone afterwards: what an
/// earlier run remembered changes no test.
template <class Test, class Application = QApplication>
int test_main(int argc, char** argv) {
  const QTemporaryDir home;
  if (!home.isValid()) qFatal("no folder for the settings: %s", qPrintable(home.errorString()));
  qputenv("XDG_CONFIG_HOME", home.filePath("config").toUtf8());
  qputenv("XDG_DATA_HOME", home.filePath("data").toUtf8());
  Application application(argc, argv);
  application.setOrganizationName("Clothlab");
  application.setApplicationName("clothlab");
  application.setAttribute(Qt::AA_Use96Dpi, true);
  Test test;
  return QTest::qExec(&test, argc, argv);
}

}  // namespace clothlab::test

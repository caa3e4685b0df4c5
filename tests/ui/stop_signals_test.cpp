// A window that is told to end from outside finishes what it records.
#include "main_window/stop_signals.h"

#include <QProcess>
#include <csignal>
#include <nlohmann/json.hpp>

#include "listed_test.h"
#include "patience.h"
#include "support/files.h"
#include "window_bench.h"

namespace clothlab::test::stop_signals_test {
namespace {

/// Whether the process has a handler for the signal by now: proc(5).
bool catches(qint64 process, int signal) {
  QFile status(QString("/proc/%1/status").arg(process));
  if (!status.open(QIODevice::ReadOnly)) return false;
  for (const QByteArray& line : status.readAll().split('\n'))
    if (line.startsWith("SigCgt:"))
      return (line.mid(7).trimmed().toULongLong(nullptr, 16) >> (signal - 1)) & 1;
  return false;
}

}  // namespace

class StopSignalsTest : public QObject {
  Q_OBJECT

 private Q_SLOTS:
  void initTestCase() { apply_theme(*qApp, false); }

  void each_signal_calls_stop_once_from_the_event_loop() {
    for (const int signal : {SIGINT, SIGTERM, SIGHUP}) {
      int calls = 0;
      const StopSignals signals([&] { ++calls; });
      std::raise(signal);
      QCOMPARE(calls, 0);
      QTRY_COMPARE_WITH_TIMEOUT(calls, 1, patience);
    }
  }

  void a_recording_is_finished() {
    const cloth::test::TemporaryFolder folder;
    const std::filesystem::path record = folder / "record";
    {
      WindowBench bench("corners-free");
      QEventLoop loop;
      const StopSignals signals([&] { loop.exit(130); });
      bench.window.startRecording(QString::fromStdString(record.string()));
      bench.play_until(0.1);
      std::raise(SIGTERM);
      QCOMPARE(loop.exec(), 130);
    }  // as main() ends
    const auto summary = nlohmann::json::parse(cloth::test::content_of(record / "summary.json"));
    QCOMPARE(summary["status"].get<std::string>(), std::string("stopped"));
    QVERIFY(summary["files"].contains("record.csv"));
    QVERIFY(!std::filesystem::exists(record / ".clothlab"));
  }

  void the_program_ends_as_an_interrupted_command_does() {
    QProcess program;
    program.start(CLOTHLAB_PROGRAM, {"corners-free"});
    QVERIFY(program.waitForStarted());
    QTRY_VERIFY_WITH_TIMEOUT(catches(program.processId(), SIGTERM), 60000);
    ::kill(static_cast<pid_t>(program.processId()), SIGTERM);
    QVERIFY(program.waitForFinished(30000));
    QCOMPARE(program.exitStatus(), QProcess::NormalExit);
    QCOMPARE(program.exitCode(), 130);
  }
};

const Listed listed{"stop_signals_test", test_main<StopSignalsTest>};

}  // namespace clothlab::test::stop_signals_test

#include "stop_signals_test.moc"

// The charts as files: CSV to the bit, pictures at their size, errors in words.
#include <QDir>
#include <QFile>
#include <QImage>
#include <QLocale>
#include <QTemporaryDir>
#include <bit>
#include <charconv>
#include <clocale>
#include <cstdint>
#include <limits>

#include "chart_bench.h"
#include "listed_test.h"
#include "theme/theme.h"

#ifdef Q_OS_UNIX
#include <sys/resource.h>

#include <csignal>
#endif

namespace clothlab::test::chart_export_test {

namespace {

constexpr double missing = std::numeric_limits<double>::quiet_NaN();

std::vector<QByteArrayList> read_csv(const QString& path) {
  QFile file(path);
  if (!file.open(QIODevice::ReadOnly)) return {};
  std::vector<QByteArrayList> rows;
  for (const QByteArray& line : file.readAll().split('\n'))
    if (!line.isEmpty()) rows.push_back(line.trimmed().split(','));
  return rows;
}

double number(const QByteArray& field) {
  double value = missing;
  std::from_chars(field.constData(), field.constData() + field.size(), value);
  return value;
}

bool same_bits(double a, double b) {
  return std::bit_cast<std::uint64_t>(a) == std::bit_cast<std::uint64_t>(b);
}

}  // namespace

class ChartExportTest : public QObject {
  Q_OBJECT

 private Q_SLOTS:
  void csv_reads_back_to_the_same_bits();
  void csv_holds_the_times_shown();
  void csv_has_decimal_points_under_a_german_locale();
  void pictures_have_the_size_asked_for();
  void svg_is_drawn_in_lines_not_pixels();
  void a_file_that_cannot_be_written_is_an_error_message();
  void a_full_disk_leaves_the_old_file_alone();
};

void ChartExportTest::csv_reads_back_to_the_same_bits() {
  Bench bench;
  std::vector<ChartSample> samples = run_of(7, 1.0 / 30);
  samples[3].step_ms = missing;
  samples[4].kinetic_J = 1e-310;
  samples[5].gravity_J = -0.1;
  bench.panel.append(samples);
  bench.panel.appendDrawTime(samples[2].time_s, 1.0 / 3);
  bench.panel.appendDrawTime(samples[6].time_s + 1e-3, 16.7);
  QTemporaryDir folder;
  QCOMPARE(bench.panel.exportCsv(folder.filePath("charts.csv")), QString());
  const auto rows = read_csv(folder.filePath("charts.csv"));
  QCOMPARE(rows.front().join(','),
           QByteArray("time_s,kinetic_J,elastic_J,gravity_J,total_J,max_strain,step_ms,draw_ms"));
  QCOMPARE(rows.size(), samples.size() + 2);  // the header, and the drawing between two samples
  std::size_t row = 1;
  for (std::size_t i = 0; i < samples.size(); ++i, ++row) {
    const QByteArrayList& fields = rows[row];
    QCOMPARE(fields.size(), 8);
    const ChartSample& s = samples[i];
    const std::array expected{s.time_s,  s.kinetic_J,  s.elastic_J, s.gravity_J,
                              s.total_J, s.max_strain, s.step_ms};
    for (int c = 0; c < 7; ++c)
      QVERIFY(std::isnan(expected[static_cast<std::size_t>(c)])
                  ? fields[c].isEmpty()
                  : same_bits(number(fields[c]), expected[static_cast<std::size_t>(c)]));
    QVERIFY(i == 2 ? same_bits(number(fields[7]), 1.0 / 3) : fields[7].isEmpty());
    if (i == 6) {
      ++row;
      QVERIFY(rows[row][1].isEmpty() && same_bits(number(rows[row][7]), 16.7));
    }
  }
}

void ChartExportTest::csv_holds_the_times_shown() {
  Bench bench;
  bench.fill(100);
  bench.drag("energy", bench.middle("energy"), bench.middle("energy") + QPoint(60, 0));
  const auto [low, high] = bench.panel.shownTimes();
  QTemporaryDir folder;
  QVERIFY(bench.panel.exportCsv(folder.filePath("part.csv")).isEmpty());
  std::size_t expected = 1;
  for (const ChartSample& s : run_of(100)) expected += low <= s.time_s && s.time_s <= high;
  const auto rows = read_csv(folder.filePath("part.csv"));
  QCOMPARE(rows.size(), expected);
  QVERIFY(number(rows[1][0]) >= low && number(rows.back()[0]) <= high);
}

void ChartExportTest::csv_has_decimal_points_under_a_german_locale() {
  const QByteArray old = std::setlocale(LC_ALL, nullptr);
  const bool has_commas =
      std::setlocale(LC_ALL, "de_DE.UTF-8") != nullptr;  // Qt's own locale has, in any case
  QLocale::setDefault(QLocale(QLocale::German, QLocale::Germany));
  {
    Bench bench;
    bench.fill(3);
    QTemporaryDir folder;
    QVERIFY(bench.panel.exportCsv(folder.filePath("german.csv")).isEmpty());
    const auto rows = read_csv(folder.filePath("german.csv"));
    for (const QByteArrayList& row : rows) QCOMPARE(row.size(), 8);
    QCOMPARE(number(rows[6][0]), 0.5);
    QCOMPARE(tick_label(0.25, 0.05), QString("0,25"));
  }
  QLocale::setDefault(QLocale::c());
  std::setlocale(LC_ALL, old.constData());
  if (!has_commas) QSKIP("the C library has no German locale here: only Qt's was tried");
}

void ChartExportTest::pictures_have_the_size_asked_for() {
  Bench bench;
  bench.fill(50);
  QTemporaryDir folder;
  QCOMPARE(bench.panel.exportPng(folder.filePath("a.png"), {900, 700}), QString());
  QCOMPARE(bench.panel.exportPng(folder.filePath("b.png")), QString());
  QCOMPARE(QImage(folder.filePath("a.png")).size(), QSize(900, 700));
  const QImage picture(folder.filePath("b.png"));
  QCOMPARE(picture.size(), QSize(1600, 1200));
  int energy_pixels = 0;
  for (int y = 0; y < picture.height(); ++y)
    for (int x = 0; x < picture.width(); ++x) energy_pixels += picture.pixelColor(x, y) == theme().kinetic;
  QVERIFY(energy_pixels > 200);
}

void ChartExportTest::svg_is_drawn_in_lines_not_pixels() {
  Bench bench;
  bench.fill(50);
  QTemporaryDir folder;
  QCOMPARE(bench.panel.exportSvg(folder.filePath("a.svg")), QString());
  QFile file(folder.filePath("a.svg"));
  QVERIFY(file.open(QIODevice::ReadOnly));
  const QByteArray svg = file.readAll();
  QVERIFY(svg.contains("viewBox=\"0 0 1600 1200\""));
  QVERIFY(!svg.contains("<image"));
  QVERIFY(svg.contains("Energy (J)") && svg.contains("Simulated time (s)") && svg.contains("Kinetic"));
  QVERIFY(svg.contains(theme().kinetic.name().toLatin1()));
}

void ChartExportTest::a_file_that_cannot_be_written_is_an_error_message() {
  Bench bench;
  bench.fill(5);
  QTemporaryDir folder;
  const QString nowhere = folder.filePath("no/such/folder/charts");
  QVERIFY(bench.panel.exportCsv(nowhere).contains(nowhere));
  QVERIFY(bench.panel.exportPng(nowhere).contains(nowhere));
  QVERIFY(bench.panel.exportSvg(nowhere).contains(nowhere));
  QVERIFY(bench.panel.exportCsv(folder.path()).contains("is a folder"));
  QVERIFY(!bench.panel.exportPng(folder.filePath("zero.png"), {0, 10}).isEmpty());
  QVERIFY(!QFile::exists(folder.filePath("zero.png")));
}

void ChartExportTest::a_full_disk_leaves_the_old_file_alone() {
#ifdef Q_OS_UNIX
  Bench bench;
  bench.fill(500);
  bench.panel.setTimeSpan(Panel::TimeSpan::whole_run);
  QTemporaryDir folder;
  const QString path = folder.filePath("charts.csv");
  QFile old(path);
  QVERIFY(old.open(QIODevice::WriteOnly) && old.write("old") == 3);
  old.close();
  // A limit on the size of files stands for the full disk.
  rlimit before{};
  getrlimit(RLIMIT_FSIZE, &before);
  const auto old_handler = std::signal(SIGXFSZ, SIG_IGN);
  rlimit small = before;
  small.rlim_cur = 100'000;
  setrlimit(RLIMIT_FSIZE, &small);
  const QString message = bench.panel.exportCsv(path);
  setrlimit(RLIMIT_FSIZE, &before);
  std::signal(SIGXFSZ, old_handler);
  QVERIFY(message.contains(path));
  QVERIFY(old.open(QIODevice::ReadOnly));
  QCOMPARE(old.readAll(), QByteArray("old"));
  QCOMPARE(QDir(folder.path()).entryList(QDir::Files).size(), 1);
#else
  QSKIP("needs a limit on the size of files");
#endif
}

const Listed listed{"chart_export_test", test_main<ChartExportTest>};

}  // namespace clothlab::test::chart_export_test

#include "chart_export_test.moc"

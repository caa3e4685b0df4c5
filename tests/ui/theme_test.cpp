// Laws of the look: what is written can be read, what is drawn can be told apart, and it follows the choice.
#include "theme/theme.h"

#include <QApplication>
#include <QDialogButtonBox>
#include <QDir>
#include <QDirIterator>
#include <QEvent>
#include <QFile>
#include <QFileDialog>
#include <QFileIconProvider>
#include <QImage>
#include <QPainter>
#include <QPixmap>
#include <QRegularExpression>
#include <QTest>
#include <QWidget>
#include <QtGlobal>
#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "listed_test.h"
#include "patience.h"

namespace clothlab::test::theme_test {
namespace {

using Triple = std::array<double, 3>;

Triple linear_rgb(const QColor& colour) {
  const auto linear = [](double c) { return c <= 0.04045 ? c / 12.92 : std::pow((c + 0.055) / 1.055, 2.4); };
  return {linear(colour.redF()), linear(colour.greenF()), linear(colour.blueF())};
}

/// WCAG 2.1: relative luminance and contrast ratio.
double luminance(const QColor& colour) {
  const Triple c = linear_rgb(colour);
  return 0.2126 * c[0] + 0.7152 * c[1] + 0.0722 * c[2];
}

double contrast(const QColor& a, const QColor& b) {
  const double of_a = luminance(a);
  const double of_b = luminance(b);
  return (std::max(of_a, of_b) + 0.05) / (std::min(of_a, of_b) + 0.05);
}

/// How an eye sees linear RGB (Machado et al. 2009, full severity).
using Eye = std::array<Triple, 3>;
constexpr Eye ordinary_eye = {{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
constexpr Eye deuteranope = {
    {{0.367322, 0.860646, -0.227968}, {0.280085, 0.672501, 0.047413}, {-0.011820, 0.042940, 0.968881}}};
constexpr Eye protanope = {
    {{0.152286, 1.052583, -0.204868}, {0.114503, 0.786281, 0.099216}, {-0.003882, -0.048116, 1.051998}}};

/// CIE L*a*b* (D65) of a colour as `eye` sees it.
Triple lab(const QColor& colour, const Eye& eye) {
  const Triple rgb = linear_rgb(colour);
  Triple seen;
  for (std::size_t i = 0; i < 3; ++i)
    seen[i] = std::clamp(eye[i][0] * rgb[0] + eye[i][1] * rgb[1] + eye[i][2] * rgb[2], 0.0, 1.0);
  const auto f = [](double t) { return t > 0.008856 ? std::cbrt(t) : 7.787 * t + 16.0 / 116.0; };
  const double x = f((0.4124564 * seen[0] + 0.3575761 * seen[1] + 0.1804375 * seen[2]) / 0.95047);
  const double y = f(0.2126729 * seen[0] + 0.7151522 * seen[1] + 0.0721750 * seen[2]);
  const double z = f((0.0193339 * seen[0] + 0.1191920 * seen[1] + 0.9503041 * seen[2]) / 1.08883);
  return {116 * y - 16, 500 * (x - y), 200 * (y - z)};
}

double difference(const QColor& a, const QColor& b, const Eye& eye) {
  const Triple p = lab(a, eye);
  const Triple q = lab(b, eye);
  return std::hypot(p[0] - q[0], p[1] - q[1], p[2] - q[2]);
}

struct NamedColour {
  const char* name;
  QColor colour;
};

std::vector<NamedColour> curves(const Theme& t) {
  return {{"kinetic", t.kinetic},     {"elastic", t.elastic},    {"gravity", t.gravity},
          {"total", t.total},         {"strain", t.strain},      {"limit", t.limit},
          {"step_time", t.step_time}, {"draw_time", t.draw_time}};
}

QByteArray sentence(const char* a, const char* b, double value) {
  return QByteArray(a) + " and " + b + ": " + QByteArray::number(value, 'f', 2);
}

QImage picture(const QIcon& of, int size, QIcon::Mode mode = QIcon::Normal, QIcon::State state = QIcon::Off) {
  return of.pixmap(QSize(size, size), 1.0, mode, state).toImage().convertToFormat(QImage::Format_ARGB32);
}

int inked_pixels(const QImage& image) {
  int count = 0;
  for (int y = 0; y < image.height(); ++y)
    for (int x = 0; x < image.width(); ++x) count += qAlpha(image.pixel(x, y)) > 128 ? 1 : 0;
  return count;
}

/// The colour of the pixels that the icon covers wholly; icons in one colour have only one.
QColor ink(const QImage& image) {
  for (int y = 0; y < image.height(); ++y)
    for (int x = 0; x < image.width(); ++x)
      if (qAlpha(image.pixel(x, y)) == 255) return image.pixelColor(x, y);
  return {};
}

QString repository() {
  return QDir::cleanPath(QFileInfo(__FILE__).absolutePath() + "/../..");
}

}  // namespace

class ThemeTest : public QObject {
  Q_OBJECT

 private Q_SLOTS:
  void init() { qunsetenv("CLOTHLAB_THEME"); }
  void cleanupTestCase() { apply_theme(*qApp, false); }

  void file_dialogs_are_in_the_theme_data() { both_themes(); }
  void file_dialogs_are_in_the_theme() {
    QFETCH(bool, dark);
    apply_theme(*qApp, dark);
    QVERIFY(QApplication::testAttribute(Qt::AA_DontUseNativeDialogs));
    QFileDialog dialog;
    dialog.setAcceptMode(QFileDialog::AcceptSave);
    dialog.show();
    for (const char* name : {"backButton", "toParentButton", "newFolderButton", "listModeButton"}) {
      const auto* button = dialog.findChild<QAbstractButton*>(QLatin1String(name));
      QVERIFY2(button, name);
      QCOMPARE(ink(picture(button->icon(), 24)), theme().text);
    }
    QCOMPARE(ink(picture(dialog.iconProvider()->icon(QFileIconProvider::Folder), 24)), theme().text);
    for (const QAbstractButton* button : dialog.findChild<QDialogButtonBox*>()->buttons())
      QVERIFY2(button->icon().isNull(), qPrintable(button->text()));
  }

  void an_icon_without_room_is_drawn_without_a_warning() {
    QTest::failOnWarning(QRegularExpression(".*"));
    QVERIFY(icon("play").pixmap(QSize(0, 16)).isNull());
    QPixmap paper(16, 16);
    QPainter painter(&paper);
    icon("play").paint(&painter, QRect(0, 0, 0, 0));
  }

  void text_reads_on_every_surface_data() { both_themes(); }
  void text_reads_on_every_surface() {
    QFETCH(bool, dark);
    const Theme& t = dark ? dark_theme() : light_theme();
    const std::vector<NamedColour> surfaces = {{"window", t.window}, {"panel", t.panel}, {"field", t.field}};
    const std::vector<NamedColour> texts = {{"text", t.text},     {"muted_text", t.muted_text},
                                            {"accent", t.accent}, {"warning", t.warning},
                                            {"error", t.error},   {"good", t.good}};
    for (const auto& surface : surfaces) {
      for (const auto& text : texts) {
        const double ratio = contrast(text.colour, surface.colour);
        QVERIFY2(ratio >= 4.5, sentence(text.name, surface.name, ratio));
      }
      // WCAG asks nothing of a disabled control's text; ours can still be read.
      const double disabled = contrast(t.disabled_text, surface.colour);
      QVERIFY2(disabled >= 2.8, sentence("disabled_text", surface.name, disabled));
    }
    QVERIFY(contrast(t.accent_text, t.accent) >= 4.5);
  }

  void curves_stand_out_from_the_panel_data() { both_themes(); }
  void curves_stand_out_from_the_panel() {
    QFETCH(bool, dark);
    const Theme& t = dark ? dark_theme() : light_theme();
    for (const auto& curve : curves(t)) {
      const double ratio = contrast(curve.colour, t.panel);
      QVERIFY2(ratio >= 3.0, sentence(curve.name, "panel", ratio));
    }
  }

  void curves_can_be_told_apart_by_every_eye_data() { both_themes(); }
  void curves_can_be_told_apart_by_every_eye() {
    QFETCH(bool, dark);
    const auto all = curves(dark ? dark_theme() : light_theme());
    for (std::size_t i = 0; i < all.size(); ++i)
      for (std::size_t j = i + 1; j < all.size(); ++j) {
        // Some 2 is a just noticeable difference of large patches; thin lines need a multiple of it.
        const double seen = difference(all[i].colour, all[j].colour, ordinary_eye);
        QVERIFY2(seen >= 30, sentence(all[i].name, all[j].name, seen));
        const double blind = std::min(difference(all[i].colour, all[j].colour, deuteranope),
                                      difference(all[i].colour, all[j].colour, protanope));
        QVERIFY2(blind >= 14, sentence(all[i].name, all[j].name, blind));
      }
  }

  void the_palette_follows_the_choice() {
    apply_theme(*qApp, true);
    QVERIFY(theme().dark);
    QCOMPARE(QApplication::palette().color(QPalette::Window), dark_theme().window);
    QCOMPARE(QApplication::palette().color(QPalette::Disabled, QPalette::Text), dark_theme().disabled_text);
    QWidget widget;
    widget.ensurePolished();
    QCOMPARE(widget.palette().color(QPalette::Text), dark_theme().text);

    apply_theme(*qApp, false);
    QVERIFY(!theme().dark);
    QCOMPARE(QApplication::palette().color(QPalette::Window), light_theme().window);
    QCOMPARE(widget.palette().color(QPalette::Text), light_theme().text);
  }

  void the_environment_overrides_the_desktop() {
    for (const bool dark : {true, false}) {
      qputenv("CLOTHLAB_THEME", dark ? "dark" : "light");
      apply_theme(*qApp);
      QCOMPARE(theme().dark, dark);
    }
  }

  void our_palette_does_not_hide_what_the_desktop_wants() {
    apply_theme(*qApp);
    const bool desktop = theme().dark;
    apply_theme(*qApp, !desktop);
    apply_theme(*qApp);
    QCOMPARE(theme().dark, desktop);
  }

  void news_from_the_desktop_is_followed_unless_there_was_a_choice() {
    QWidget window;
    window.show();
    QEvent news(QEvent::ThemeChange);

    apply_theme(*qApp);
    const bool desktop = theme().dark;
    qputenv("CLOTHLAB_THEME", desktop ? "light" : "dark");  // stands for a desktop that has changed its mind
    QApplication::sendEvent(&window, &news);
    QTRY_COMPARE_WITH_TIMEOUT(theme().dark, !desktop, patience);

    qunsetenv("CLOTHLAB_THEME");
    apply_theme(*qApp, !desktop);
    QApplication::sendEvent(&window, &news);
    QTest::qWait(50);
    QCOMPARE(theme().dark, !desktop);
  }

  void the_style_sheet_is_complete_data() { both_themes(); }
  void the_style_sheet_is_complete() {
    QFETCH(bool, dark);
    const QString sheet = style_sheet(dark ? dark_theme() : light_theme());
    QVERIFY(sheet.size() > 1000);
    static const QRegularExpression comments("/\\*.*?\\*/", QRegularExpression::DotMatchesEverythingOption);
    QVERIFY(!QString(sheet).remove(comments).contains('@'));
    static const QRegularExpression address("url\\(([^)]*)\\)");
    for (auto it = address.globalMatch(sheet); it.hasNext();) {
      const QString file = it.next().captured(1);
      QVERIFY2(QFile::exists(file), qPrintable(file));
    }
  }

  void every_icon_draws_something_data() { every_icon(); }
  void every_icon_draws_something() {
    QFETCH(QString, name);
    for (const int size : {16, 24, 48}) {
      const int inked = inked_pixels(picture(icon(name), size));
      QVERIFY2(inked > size * size / 60,
               qPrintable(QString("%1 of %2 px: %3").arg(name).arg(size).arg(inked)));
      QVERIFY(inked < size * size);
    }
  }

  void every_icon_shows_its_state_data() { every_icon(); }
  void every_icon_shows_its_state() {
    QFETCH(QString, name);
    const QImage normal = picture(icon(name), 24);
    QVERIFY(picture(icon(name), 24, QIcon::Disabled) != normal);
    QFile file(":/clothlab/icons/" + name + ".svg");
    QVERIFY(file.open(QIODevice::ReadOnly));
    const bool tinted = file.readAll().contains("currentColor");
    if (tinted && name != "info") QVERIFY(picture(icon(name), 24, QIcon::Normal, QIcon::On) != normal);
  }

  void an_icon_in_use_changes_with_the_theme() {
    apply_theme(*qApp, false);
    const QIcon kept = icon("play");
    QCOMPARE(ink(picture(kept, 24)), light_theme().text);
    QCOMPARE(ink(picture(kept, 24, QIcon::Disabled)), light_theme().disabled_text);
    QCOMPARE(ink(picture(kept, 24, QIcon::Normal, QIcon::On)), light_theme().accent);
    apply_theme(*qApp, true);
    QCOMPARE(ink(picture(kept, 24)), dark_theme().text);
  }

  void an_icon_is_sharp_on_a_dense_screen() {
    const QPixmap dense = icon("play").pixmap(QSize(24, 24), 2.0);
    QCOMPARE(dense.size(), QSize(48, 48));
    QCOMPARE(dense.devicePixelRatio(), 2.0);
  }

  void an_unknown_icon_is_null_and_says_so() {
    QTest::ignoreMessage(QtWarningMsg, "there is no icon named 'no-such-icon'");
    QVERIFY(icon("no-such-icon").isNull());
  }

  void every_icon_that_the_code_names_exists() {
    static const QRegularExpression use("\\bicon\\(\\s*\"([^\"]+)\"");
    int uses = 0;
    for (const QString& folder : {repository() + "/ui", repository() + "/app"}) {
      QDirIterator sources(folder, {"*.cpp", "*.h"}, QDir::Files, QDirIterator::Subdirectories);
      while (sources.hasNext()) {
        QFile file(sources.next());
        QVERIFY(file.open(QIODevice::ReadOnly));
        const QString code = QString::fromUtf8(file.readAll());
        for (auto it = use.globalMatch(code); it.hasNext(); ++uses) {
          const QString name = it.next().captured(1);
          QVERIFY2(QFile::exists(":/clothlab/icons/" + name + ".svg"),
                   qPrintable(file.fileName() + ": " + name));
        }
      }
    }
    if (uses == 0) QSKIP("the sources are not beside this test, so the names they use cannot be read");
  }

 private:
  static void both_themes() {
    QTest::addColumn<bool>("dark");
    QTest::newRow("light") << false;
    QTest::newRow("dark") << true;
  }

  static void every_icon() {
    ensure_resources();
    QTest::addColumn<QString>("name");
    const QStringList files = QDir(":/clothlab/icons").entryList({"*.svg"});
    QVERIFY(files.size() >= 42);
    for (const QString& file : files) QTest::newRow(qPrintable(file)) << file.chopped(4);
  }
};

const Listed listed{"theme_test", test_main<ThemeTest>};

}  // namespace clothlab::test::theme_test

#include "theme_test.moc"

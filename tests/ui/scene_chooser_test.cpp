// The chooser of built-in scenes, by clicks and keys, and its pictures in resources/gallery.
// CLOTHLAB_WRITE_PICTURES=1 makes these anew: the command line draws them, and panes of a comparison are put
// side by side.
#include "scenes/scene_chooser.h"

#include <QJsonArray>
#include <QJsonDocument>
#include <QJsonObject>
#include <QLineEdit>
#include <QListWidget>
#include <QPainter>
#include <QProcess>

#include "compare/builtin_comparisons.h"
#include "listed_test.h"
#include "patience.h"
#include "scene/builtin_scenes.h"
#include "scenes/scene_gallery.h"
#include "window_bench.h"

namespace clothlab::test::scene_chooser_test {

constexpr QSize picture_size{192, 120};  // px
constexpr int picture_bytes = 10000;

/// A run of `scene` with `own` values up to the entry's time.
QImage run_picture(const QString& scene, const GalleryEntry& entry, const QJsonObject& own, QSize size,
                   bool dark) {
  const QTemporaryDir folder;
  const QString file = folder.filePath("picture.png");
  QStringList arguments{"run", scene, "--picture", file, "--view", entry.view};
  arguments << "--theme" << (dark ? "dark" : "light");
  arguments << "--size" << QString("%1x%2").arg(size.width()).arg(size.height());
  arguments << "--set" << QString("duration=%1").arg(entry.time);
  for (auto value = own.begin(); value != own.end(); ++value)
    arguments << "--set" << value.key() + "=" + value.value().toVariant().toString();
  QProcess program;
  program.start(CLOTHLAB_CLI, arguments);
  program.waitForFinished(-1);
  return QImage(file);
}

/// Of a comparison that of each pane, side by side or two by two.
QImage picture_of(const GalleryEntry& entry, bool dark) {
  const auto* comparison = cloth::find_builtin_comparison(entry.name);
  if (!comparison) return run_picture(entry.name, entry, {}, picture_size, dark);
  const QJsonObject file = QJsonDocument::fromJson(QByteArray::fromStdString(comparison->text)).object();
  const QJsonArray panes = file["panes"].toArray();
  const int columns = panes.size() == 4 ? 2 : static_cast<int>(panes.size());
  const QSize size(picture_size.width() / columns, picture_size.height() / (panes.size() == 4 ? 2 : 1));
  QImage whole(picture_size, QImage::Format_RGB32);
  QPainter painter(&whole);
  for (int pane = 0; pane < panes.size(); ++pane) {
    const QRect place({pane % columns * size.width(), pane / columns * size.height()}, size);
    painter.drawImage(place, run_picture(file["scene"].toString(), entry,
                                         panes[pane].toObject()["own"].toObject(), size, dark));
    painter.setPen(theme().border);
    painter.drawRect(place);
  }
  return whole;
}

class SceneChooserTest : public QObject {
  Q_OBJECT

 private Q_SLOTS:
  void initTestCase() {
    apply_theme(*qApp, false);
    if (qEnvironmentVariableIntValue("CLOTHLAB_WRITE_PICTURES") == 0) return;
    for (const bool dark : {false, true})
      for (const GalleryGroup& group : scene_gallery())
        for (const GalleryEntry& entry : group.entries)
          QVERIFY(picture_of(entry, dark).save(source_of(entry, dark), "JPG", 85));
  }

  void every_built_in_scene_and_comparison_is_there_once_with_small_pictures() {
    QStringList names, expected;
    for (const GalleryGroup& group : scene_gallery())
      for (const GalleryEntry& entry : group.entries) {
        names << entry.name;
        for (const bool dark : {false, true}) {
          QVERIFY2(QFileInfo(source_of(entry, dark)).size() < picture_bytes, entry.name);
          QCOMPARE(QImage(gallery_picture(entry.name, dark)).size(), picture_size);
        }
      }
    for (const auto& scene : cloth::builtin_scenes()) expected << QString::fromStdString(scene.name);
    for (const auto& one : cloth::builtin_comparisons()) expected << QString::fromStdString(one.name);
    names.sort();
    expected.sort();
    QCOMPARE(names, expected);
  }

  void a_click_on_a_card_opens_its_scene() {
    WindowBench bench;
    bench.click("scenesButton");
    click(*chooser_of(bench), "cube");
    bench.settle();
    QCOMPARE(bench.window.document().title(), gallery_title("cube"));
    QTRY_VERIFY_WITH_TIMEOUT(!bench.window.findChild<SceneChooser*>(), patience);
  }

  void a_click_on_a_heading_does_nothing_and_escape_leaves_the_scene() {
    WindowBench bench;
    bench.click("scenesButton");
    SceneChooser* chooser = chooser_of(bench);
    const QListWidget& list = *list_of(*chooser);
    QTest::mouseClick(list.viewport(), Qt::LeftButton, {}, list.visualItemRect(list.item(0)).center());
    QVERIFY(chooser->isVisible());
    QTest::keyClick(chooser->focusWidget(), Qt::Key_Escape);
    QTRY_VERIFY_WITH_TIMEOUT(!bench.window.findChild<SceneChooser*>(), patience);
    QCOMPARE(bench.window.document().title(), gallery_title("corners-shear"));
  }

  void arrows_go_from_card_to_card_over_headings_and_enter_opens() {
    WindowBench bench;
    QTest::keyClick(&bench.window, Qt::Key_B, Qt::ControlModifier);
    SceneChooser* chooser = chooser_of(bench);
    QStringList seen{selected(*chooser)};
    for (int n = 0; n < 40; ++n) {
      press(*chooser, Qt::Key_Down);
      if (selected(*chooser) != seen.last()) seen << selected(*chooser);
    }
    QVERIFY2(seen.size() > 8, qPrintable(seen.join(' ')));
    QVERIFY(!seen.contains(QString()));
    const QListWidget& list = *list_of(*chooser);
    QVERIFY(list.viewport()->rect().contains(list.visualItemRect(list.currentItem())));
    while (selected(*chooser) != "flag") {
      const QString before = selected(*chooser);
      press(*chooser, Qt::Key_Up);
      if (selected(*chooser) == before) break;
    }
    QCOMPARE(selected(*chooser), QString("flag"));
    press(*chooser, Qt::Key_Right);
    QCOMPARE(selected(*chooser), QString("tablecloth"));
    press(*chooser, Qt::Key_Return);
    bench.settle();
    QCOMPARE(bench.window.document().title(), gallery_title("tablecloth"));
  }

  void typing_finds_by_any_word_and_arrows_and_enter_go_on_from_there() {
    WindowBench bench;
    QTest::keyClick(&bench.window, Qt::Key_B, Qt::ControlModifier);
    SceneChooser* chooser = chooser_of(bench);
    type(*chooser, "falls");
    QCOMPARE(selected(*chooser), QString("tablecloth"));
    press(*chooser, Qt::Key_Down);
    QVERIFY(selected(*chooser) != "tablecloth");
    type(*chooser, " rabbit");
    QCOMPARE(selected(*chooser), QString());
    press(*chooser, Qt::Key_Return);
    QVERIFY(chooser->isVisible());
    for (int n = 0; n < 6; ++n) press(*chooser, Qt::Key_Backspace);
    type(*chooser, "bunny");
    QCOMPARE(selected(*chooser), QString("bunny"));
    press(*chooser, Qt::Key_Return);
    bench.settle();
    QCOMPARE(bench.window.document().title(), gallery_title("bunny"));
  }

  void the_compare_menu_leads_to_the_comparisons() {
    WindowBench bench;
    bench.action("builtinComparisons")->trigger();
    SceneChooser* chooser = chooser_of(bench);
    QCOMPARE(selected(*chooser), QString("report-methods"));
    const QListWidget& list = *list_of(*chooser);
    QVERIFY(list.viewport()->rect().contains(list.visualItemRect(list.currentItem())));
    press(*chooser, Qt::Key_Return);
    bench.settle();
    QCOMPARE(bench.window.panes().paneCount(), 3u);
  }

  void cards_stay_within_a_small_chooser_in_either_direction() {
    for (const Qt::LayoutDirection direction : {Qt::LeftToRight, Qt::RightToLeft}) {
      QApplication::setLayoutDirection(direction);
      WindowBench bench;
      bench.window.resize(1000, 650);
      bench.click("scenesButton");
      const QListWidget& list = *list_of(*chooser_of(bench));
      QVERIFY(chooser_of(bench)->width() <= 1000 && chooser_of(bench)->height() <= 650);
      const QRect first = list.visualItemRect(list.item(1)), second = list.visualItemRect(list.item(2));
      for (int row = 0; row < list.count() - 1; ++row) {
        const QRect place = list.visualItemRect(list.item(row));
        QVERIFY2(place.left() >= 0 && place.right() <= list.viewport()->width(),
                 qPrintable(list.item(row)->text()));
      }
      QCOMPARE(first.top(), second.top());
      QCOMPARE(first.left() < second.left(), direction == Qt::LeftToRight);
    }
    QApplication::setLayoutDirection(Qt::LeftToRight);
  }

 private:
  static QString source_of(const GalleryEntry& entry, bool dark) {
    return CLOTHLAB_SOURCE_DIR "/resources/gallery" +
           gallery_picture(entry.name, dark).mid(QString(":/clothlab/gallery").size());
  }

  static SceneChooser* chooser_of(WindowBench& bench) {
    auto* chooser = bench.window.findChild<SceneChooser*>();
    if (!chooser || !QTest::qWaitForWindowActive(chooser, patience)) qFatal("no chooser came");
    return chooser;
  }
  static QListWidget* list_of(const SceneChooser& chooser) {
    return chooser.findChild<QListWidget*>("sceneList");
  }
  /// Empty where none is.
  static QString selected(const SceneChooser& chooser) {
    const QListWidgetItem* item = list_of(chooser)->currentItem();
    return item && item->isSelected() ? item->data(Qt::UserRole).toString() : QString();
  }
  static void press(SceneChooser& chooser, Qt::Key key) { QTest::keyClick(chooser.focusWidget(), key); }
  static void type(SceneChooser& chooser, const QString& words) {
    for (const QChar letter : words) QTest::keyClick(chooser.focusWidget(), letter.toLatin1());
  }
  static void click(SceneChooser& chooser, const QString& name) {
    QListWidget& list = *list_of(chooser);
    for (int row = 0; row < list.count(); ++row)
      if (list.item(row)->data(Qt::UserRole) == name) {
        list.scrollToItem(list.item(row));
        QTest::mouseClick(list.viewport(), Qt::LeftButton, {}, list.visualItemRect(list.item(row)).center());
        return;
      }
    QFAIL("no such card");
  }
};

const Listed listed{"scene_chooser_test", test_main<SceneChooserTest>};

}  // namespace clothlab::test::scene_chooser_test

#include "scene_chooser_test.moc"

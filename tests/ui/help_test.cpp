// The help window, as a user reads it.
#include <QLineEdit>
#include <QListWidget>
#include <QMenuBar>

#include "help/help_browser.h"
#include "help/help_window.h"
#include "io/machine.h"
#include "kernels/instruction_set.h"
#include "listed_test.h"
#include "patience.h"
#include "window_bench.h"

namespace clothlab::test::help_test {

class HelpTest : public QObject {
  Q_OBJECT

 private Q_SLOTS:
  void initTestCase() { apply_theme(*qApp, false); }

  void f1_shows_the_guide_and_a_second_time_the_same_window() {
    WindowBench bench;
    QTest::keyClick(&bench.window, Qt::Key_F1);
    HelpWindow* help = help_of(bench);
    QVERIFY(help);
    QTRY_COMPARE_WITH_TIMEOUT(QApplication::activeWindow(), help, patience);
    QVERIFY(help->browser().toPlainText().startsWith("The window"));
    QVERIFY(!help->browser().toPlainText().contains("pictures/"));
    QTest::keyClick(&help->browser(), Qt::Key_Escape);
    QVERIFY(!help->isVisible());
    bench.window.activateWindow();
    QVERIFY(QTest::qWaitForWindowActive(&bench.window, patience));
    QTest::keyClick(&bench.window, Qt::Key_F1);
    QCOMPARE(help_of(bench), help);
    QVERIFY(help->isVisible());
    QCOMPARE(bench.window.findChildren<HelpWindow*>().size(), 1);
  }

  void every_page_of_the_list_has_text_and_every_link_leads_somewhere() {
    WindowBench bench;
    HelpWindow& help = shown(bench, "helpGuide");
    auto* list = help.findChild<QListWidget*>("helpPages");
    QMap<QString, QUrl> links;
    for (int row = 0; row < list->count(); ++row) {
      QTest::mouseClick(list->viewport(), Qt::LeftButton, {}, list->visualItemRect(list->item(row)).center());
      QVERIFY2(help.browser().toPlainText().size() > 200, qPrintable(list->item(row)->text()));
      QVERIFY(help.windowTitle().startsWith(list->item(row)->text()));
      QCOMPARE(list->currentRow(), row);
      add_links(help.browser(), links);
    }
    QVERIFY(links.size() > 40);
    for (const QUrl& link : links) {  // those of a page one after another: it is read once
      help.browser().setSource(link);
      QVERIFY2(help.browser().toPlainText().size() > 200, qPrintable(link.toString()));
      if (link.hasFragment())
        QVERIFY2(help.browser().showHeading(link.fragment()), qPrintable(link.toString()));
    }
  }

  void a_link_leads_to_its_heading_and_back() {
    WindowBench bench;
    HelpWindow& help = shown(bench, "helpGuide");
    const QUrl source = help.browser().source();
    Q_EMIT help.browser().anchorClicked(QUrl("sessions.md"));
    QCOMPARE(HelpBrowser::pageOf(help.browser().source()), QString("sessions.md"));
    QTest::mouseClick(help.findChild<QToolButton*>("helpBackButton"), Qt::LeftButton);
    QCOMPARE(help.browser().source(), source);
    Q_EMIT help.browser().anchorClicked(QUrl("#back-and-forth-in-time"));
    QCOMPARE(help.browser().cursorForPosition({40, 8}).block().text(), QString("Back and forth in time"));
  }

  void words_are_found_and_found_again_from_the_start() {
    WindowBench bench;
    HelpWindow& help = shown(bench, "helpGlossary");
    QTRY_COMPARE_WITH_TIMEOUT(QApplication::activeWindow(), &help, patience);
    QTest::keyClick(&help.browser(), Qt::Key_F, Qt::ControlModifier);
    auto* words = help.findChild<QLineEdit*>("helpFind");
    QCOMPARE(help.focusWidget(), words);
    QTest::keyClicks(words, "shear spring");
    const int first = help.browser().textCursor().position();
    QCOMPARE(help.browser().textCursor().selectedText().toLower(), QString("shear spring"));
    for (int n = 0; n < 50; ++n) {
      QTest::keyClick(words, Qt::Key_Return);
      if (help.browser().textCursor().position() == first) return;
    }
    QFAIL("never came back to the first one");
  }

  void shortcuts_are_those_of_the_windows_actions() {
    WindowBench bench;
    bench.action("record")->setShortcut(QKeySequence("Ctrl+Alt+9"));
    const QString text = shown(bench, "helpShortcuts").browser().toPlainText();
    QVERIFY2(text.contains("Ctrl+Alt+9"), qPrintable(text));
    for (const QAction* menu : bench.window.menuBar()->actions())
      for (const QAction* action : menu->menu()->actions())
        if (!action->shortcut().isEmpty())
          QVERIFY2(text.contains(action->shortcut().toString(QKeySequence::NativeText)),
                   qPrintable(action->text()));
  }

  void about_names_versions_processor_and_instruction_set() {
    WindowBench bench;
    const QString text = shown(bench, "helpAbout").browser().toPlainText();
    const QStringList facts{QString::fromStdString(cloth::version()), qVersion(), "OpenGL",
                            QString::fromStdString(cloth::processor_name()),
                            name_of(cloth::active_instruction_set())};
    for (const QString& fact : facts) QVERIFY2(text.contains(fact), qPrintable(fact));
  }

 private:
  static HelpWindow* help_of(WindowBench& bench) { return bench.window.findChild<HelpWindow*>(); }
  static HelpWindow& shown(WindowBench& bench, const char* action) {
    bench.action(action)->trigger();
    return *help_of(bench);
  }

  static void add_links(const HelpBrowser& browser, QMap<QString, QUrl>& links) {
    for (QTextBlock block = browser.document()->begin(); block.isValid(); block = block.next())
      for (auto part = block.begin(); !part.atEnd(); ++part)
        if (const QString href = part.fragment().charFormat().anchorHref(); !href.isEmpty()) {
          const QUrl link = browser.source().resolved(QUrl(href));
          if (link.scheme() == "qrc") links[link.toString()] = link;
        }
  }
};

const Listed listed{"help_test", test_main<HelpTest>};

}  // namespace clothlab::test::help_test

#include "help_test.moc"

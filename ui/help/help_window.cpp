#include "help/help_window.h"

#include <QAction>
#include <QKeyEvent>
#include <QLineEdit>
#include <QListWidget>
#include <QMainWindow>
#include <QMenu>
#include <QSplitter>
#include <QToolButton>
#include <QVBoxLayout>

#include "help/about.h"
#include "help/help_browser.h"
#include "help/shortcut_list.h"
#include "theme/theme.h"
#include "widgets/building.h"

namespace clothlab {
namespace {

constexpr QSize pleasant_size{900, 640};
constexpr int list_width = 190;  // px

struct Page {
  const char* name;
  QString title;
};

std::vector<Page> pages() {
  return {{"guide.md", HelpWindow::tr("Guide")},
          {"shortcuts", HelpWindow::tr("Shortcuts")},
          {"vocabulary.md", HelpWindow::tr("Glossary")},
          {"compare.md", HelpWindow::tr("Comparisons")},
          {"contact.md", HelpWindow::tr("Contact")},
          {"methods/index.md", HelpWindow::tr("Methods")},
          {"studies/work-precision.md", HelpWindow::tr("Study: error and time")},
          {"studies/stability.md", HelpWindow::tr("Study: stability")},
          {"studies/extremes.md", HelpWindow::tr("Study: extreme cases")},
          {"studies/convergence.md", HelpWindow::tr("Study: grid convergence")},
          {"studies/iterations.md", HelpWindow::tr("Study: iterations")},
          {"studies/sweep.md", HelpWindow::tr("Study: sweeps")},
          {"studies/cluster.md", HelpWindow::tr("Sweeps and studies on a cluster")},
          {"studies/sensitivity.md", HelpWindow::tr("Sensitivity")},
          {"studies/identify.md", HelpWindow::tr("Parameters from measurements")},
          {"parameters.md", HelpWindow::tr("Parameters")},
          {"scene-format.md", HelpWindow::tr("Scene files")},
          {"materials.md", HelpWindow::tr("Materials")},
          {"sessions.md", HelpWindow::tr("Sessions")},
          {"model.md", HelpWindow::tr("The model")},
          {"command-line.md", HelpWindow::tr("Command line")},
          {"about", HelpWindow::tr("About")}};
}

}  // namespace

HelpWindow::HelpWindow(QMainWindow& window)
    : QWidget(&window, Qt::Window),
      browser_(named("helpText", new HelpBrowser(this))),
      pages_(named("helpPages", new QListWidget(this))),
      words_(named("helpFind", new QLineEdit(this))) {
  setObjectName("helpWindow");
  resize(pleasant_size);
  browser_->setAccessibleName(tr("Page of the help"));
  browser_->addPage("shortcuts", [&window] { return shortcut_page(window); });
  browser_->addPage("about", [] { return about_page(); });
  pages_->setAccessibleName(tr("Pages"));
  pages_->setFrameShape(QFrame::NoFrame);
  for (const Page& page : pages()) {
    auto* entry = new QListWidgetItem(page.title, pages_);
    entry->setData(Qt::UserRole, QString::fromLatin1(page.name));
    entry->setSizeHint({0, pages_->fontMetrics().height() + spacing});
  }
  auto* column = spaced(new QVBoxLayout(this), 0);
  makeBar(*column);
  auto* both = new QSplitter(this);
  both->addWidget(pages_);
  both->addWidget(browser_);
  both->setStretchFactor(1, 1);
  both->setChildrenCollapsible(false);
  both->setSizes({list_width, pleasant_size.width() - list_width});
  column->addWidget(both, 1);
  connect(pages_, &QListWidget::currentItemChanged, this, [this](const QListWidgetItem* entry) {
    if (entry) browser_->showPage(entry->data(Qt::UserRole).toString());
  });
  connect(browser_, &QTextBrowser::sourceChanged, this, &HelpWindow::followPage);
}

void HelpWindow::makeBar(QBoxLayout& column) {
  auto* bar = spaced(new QHBoxLayout, spacing / 2, {spacing, spacing, spacing, spacing});
  const auto add = [&](const char* name, const char* icon_name, const QString& text, QKeySequence key,
                       auto act) {
    auto* action = named(name, new QAction(icon(icon_name), text, this));
    action->setShortcut(key);
    action->setEnabled(false);
    connect(action, &QAction::triggered, browser_, act);
    bar->addWidget(make_action_button(action, this));
    return action;
  };
  connect(browser_, &QTextBrowser::backwardAvailable,
          add("helpBack", "arrow-left", tr("Back"), QKeySequence::Back, &QTextBrowser::backward),
          &QAction::setEnabled);
  connect(browser_, &QTextBrowser::forwardAvailable,
          add("helpForward", "arrow-right", tr("Forward"), QKeySequence::Forward, &QTextBrowser::forward),
          &QAction::setEnabled);
  bar->addStretch(1);
  words_->setPlaceholderText(tr("Find in this page (Ctrl+F)"));
  words_->setAccessibleName(tr("Find in this page"));
  words_->setClearButtonEnabled(true);
  words_->setMinimumWidth(list_width + list_width / 2);
  bar->addWidget(words_);
  column.addLayout(bar);
  connect(words_, &QLineEdit::returnPressed, this, [this] { find(false); });
  connect(words_, &QLineEdit::textEdited, this, [this] {
    browser_->moveCursor(QTextCursor::Start);
    find(false);
  });
  const auto on = [this](const QKeySequence& key, auto act) {
    auto* action = new QAction(this);
    action->setShortcut(key);
    addAction(action);
    connect(action, &QAction::triggered, this, act);
  };
  on(QKeySequence::Find, [this] {
    words_->setFocus();
    words_->selectAll();
  });
  on(QKeySequence::FindNext, [this] { find(false); });
  on(QKeySequence::FindPrevious, [this] { find(true); });
}

void HelpWindow::showPage(const QString& page) {
  browser_->showPage(page);
  show();
  raise();
  activateWindow();
  browser_->setFocus();
}

/// The list and the title follow links.
void HelpWindow::followPage(const QUrl& shown) {
  QListWidgetItem* entry = nullptr;
  for (int row = 0; row < pages_->count(); ++row)
    if (pages_->item(row)->data(Qt::UserRole).toString() == HelpBrowser::pageOf(shown))
      entry = pages_->item(row);
  const QSignalBlocker quiet(pages_);
  if (entry != pages_->currentItem()) pages_->setCurrentItem(entry);
  setWindowTitle(tr("%1 - Clothlab Help").arg(entry ? entry->text() : HelpBrowser::pageOf(shown)));
}

/// Goes on at the other end where there is no more.
void HelpWindow::find(bool backward) {
  const QTextDocument::FindFlags flags = backward ? QTextDocument::FindBackward : QTextDocument::FindFlags();
  if (words_->text().isEmpty() || browser_->find(words_->text(), flags)) return;
  const QTextCursor before = browser_->textCursor();
  browser_->moveCursor(backward ? QTextCursor::End : QTextCursor::Start);
  if (!browser_->find(words_->text(), flags)) browser_->setTextCursor(before);
}

void HelpWindow::keyPressEvent(QKeyEvent* event) {
  if (event->key() == Qt::Key_Escape) close();
}

void fill_help_menu(QMenu& menu, QMainWindow& window) {
  const auto add = [&](const char* name, const QString& text, const QString& page, QKeySequence key = {}) {
    auto* action = named(name, menu.addAction(text));
    action->setShortcut(key);
    QObject::connect(action, &QAction::triggered, &window, [&window, page] {
      auto* help = window.findChild<HelpWindow*>(QString(), Qt::FindDirectChildrenOnly);
      (help ? help : new HelpWindow(window))->showPage(page);
    });
  };
  add("helpGuide", HelpWindow::tr("Guide"), "guide.md", QKeySequence::HelpContents);
  add("helpShortcuts", HelpWindow::tr("Shortcuts"), "shortcuts");
  add("helpGlossary", HelpWindow::tr("Glossary"), "vocabulary.md");
  menu.addSeparator();
  add("helpAbout", HelpWindow::tr("About Clothlab"), "about");
}

}  // namespace clothlab

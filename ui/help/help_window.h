// The help of a window: the manual's pages, the window's shortcuts, a glossary and what the program is.
// Beside the text is the list of pages; a field finds words in the page shown.
#pragma once

#include <QUrl>
#include <QWidget>

class QBoxLayout;
class QLineEdit;
class QListWidget;
class QMainWindow;
class QMenu;

namespace clothlab {

class HelpBrowser;

class HelpWindow : public QWidget {
  Q_OBJECT

 public:
  /// Of this window, over which it stays.
  explicit HelpWindow(QMainWindow& window);

  /// "guide.md", a page of the manual with or without a heading, "shortcuts" or "about".
  void showPage(const QString& page);
  HelpBrowser& browser() { return *browser_; }

 protected:
  void keyPressEvent(QKeyEvent* event) override;

 private:
  void makeBar(QBoxLayout& column);
  void followPage(const QUrl& shown);
  void find(bool backward);

  HelpBrowser* browser_;
  QListWidget* pages_;
  QLineEdit* words_;
};

/// Fills the Help menu: guide (F1), shortcuts, glossary, about. There is one help window for each window.
void fill_help_menu(QMenu& menu, QMainWindow& window);

}  // namespace clothlab

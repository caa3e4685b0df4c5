// Shows pages of the manual (docs/*.md), with links between them and to their headings, and pages that the
// program writes itself.
#pragma once

#include <QHash>
#include <QTextBrowser>
#include <functional>

namespace clothlab {

class HelpBrowser : public QTextBrowser {
  Q_OBJECT

 public:
  explicit HelpBrowser(QWidget* parent = nullptr);

  /// A page of this name, made anew each time it is shown.
  void addPage(const QString& name, std::function<QString()> html) { pages_[name] = std::move(html); }
  /// "guide.md", "guide.md#the-view", or the name of a page added.
  void showPage(const QString& name);
  /// The file's or page's name: "guide.md", "methods/verlet.md".
  static QString pageOf(const QUrl& source);
  /// Goes to a heading of the page shown, by the name that links have for it; false if there is none.
  bool showHeading(const QString& slug);

  QVariant loadResource(int type, const QUrl& name) override;

 protected:
  void doSetSource(const QUrl& name, QTextDocument::ResourceType type) override;
  void changeEvent(QEvent* event) override;

 private:
  void follow(const QUrl& link);
  void dressTables();

  QHash<QString, std::function<QString()>> pages_;
};

}  // namespace clothlab

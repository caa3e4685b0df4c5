#include "help/help_browser.h"

#include <QAbstractTextDocumentLayout>
#include <QDesktopServices>
#include <QFile>
#include <QRegularExpression>
#include <QScrollBar>
#include <QTextBlock>
#include <QTextTable>

#include "theme/theme.h"

namespace clothlab {
namespace {

const QString root = QStringLiteral("qrc:/clothlab/help/");

/// As the links of the manual name a heading: "Back and forth in time" -> "back-and-forth-in-time".
QString slug_of(const QString& heading) {
  static const QRegularExpression marks(QStringLiteral(R"([^\w\- ])"),
                                        QRegularExpression::UseUnicodePropertiesOption);
  return heading.toLower().remove(marks).replace(' ', '-');
}

/// The window that they show is at hand.
QByteArray without_pictures(const QByteArray& markdown) {
  static const QRegularExpression picture(QStringLiteral(R"(^!\[.*$\n?)"),
                                          QRegularExpression::MultilineOption);
  return QString::fromUtf8(markdown).remove(picture).toUtf8();
}

}  // namespace

HelpBrowser::HelpBrowser(QWidget* parent) : QTextBrowser(parent) {
  setOpenLinks(false);
  setFrameShape(NoFrame);
  document()->setDocumentMargin(2 * spacing);
  connect(this, &QTextBrowser::anchorClicked, this, &HelpBrowser::follow);
}

void HelpBrowser::showPage(const QString& name) {
  setSource(QUrl(root + name));
}

QString HelpBrowser::pageOf(const QUrl& source) {
  return source.path().mid(QUrl(root).path().size());
}

/// Links out of the manual open in the desktop's browser.
void HelpBrowser::follow(const QUrl& link) {
  if (link.scheme() == "http" || link.scheme() == "https")
    QDesktopServices::openUrl(link);
  else
    setSource(source().resolved(link));
}

QVariant HelpBrowser::loadResource(int type, const QUrl& name) {
  if (const auto made = pages_.constFind(pageOf(name)); made != pages_.constEnd()) return (*made)();
  QFile file(":" + name.path());
  if (!name.path().endsWith(".md") || !file.open(QIODevice::ReadOnly))
    return QTextBrowser::loadResource(type, name);
  return without_pictures(file.readAll());
}

void HelpBrowser::doSetSource(const QUrl& name, QTextDocument::ResourceType type) {
  const bool is_made = pages_.contains(pageOf(name));
  document()->setLayoutEnabled(false);  // laid out once, when all is in it: tables cost a seventh
  QTextBrowser::doSetSource(name, is_made ? QTextDocument::HtmlResource : type);
  if (!is_made) dressTables();
  document()->setLayoutEnabled(true);
  document()->markContentsDirty(0, document()->characterCount());
  if (name.hasFragment()) showHeading(name.fragment());
}

/// Single thin lines, and room around the text.
void HelpBrowser::dressTables() {
  QTextCursor edit(document());
  for (QTextFrame* frame : document()->rootFrame()->childFrames()) {
    auto* table = qobject_cast<QTextTable*>(frame);
    if (!table) continue;
    QTextTableFormat format = table->format();
    format.setCellSpacing(0);
    format.setCellPadding(spacing / 2);
    format.setBorderCollapse(true);
    format.setBorder(1);
    format.setBorderStyle(QTextFrameFormat::BorderStyle_Solid);
    format.setBorderBrush(theme().border);
    table->setFormat(format);
  }
}

bool HelpBrowser::showHeading(const QString& slug) {
  for (QTextBlock block = document()->begin(); block.isValid(); block = block.next()) {
    if (block.blockFormat().headingLevel() == 0 || slug_of(block.text()) != slug) continue;
    const QRectF place = document()->documentLayout()->blockBoundingRect(block);
    verticalScrollBar()->setValue(static_cast<int>(place.top()));
    return true;
  }
  return false;
}

/// Links keep the colour that the document was made with.
void HelpBrowser::changeEvent(QEvent* event) {
  QTextBrowser::changeEvent(event);
  if (event->type() != QEvent::PaletteChange || source().isEmpty()) return;
  const int place = verticalScrollBar()->value();
  reload();
  verticalScrollBar()->setValue(place);
}

}  // namespace clothlab

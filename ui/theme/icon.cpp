// Icons are drawn from their SVG when they are needed, in the colours that the theme has at that moment: an
// action keeps its QIcon and still changes with the theme.
#include <QFile>
#include <QIconEngine>
#include <QPainter>
#include <QPixmap>
#include <QPixmapCache>
#include <QSvgRenderer>

#include "theme/theme.h"

namespace clothlab {
namespace {

/// Icons of a state have its colour; all others have the text colour.
QColor resting_colour(const QString& name, const Theme& t) {
  if (name == "warning") return t.warning;
  if (name == "info") return t.accent;
  return t.text;
}

QColor tint(const QString& name, QIcon::Mode mode, QIcon::State state, const Theme& t) {
  if (mode == QIcon::Disabled) return t.disabled_text;
  if (mode == QIcon::Selected) return t.accent_text;
  if (state == QIcon::On) return name == "record" || name == "stop-record" ? t.error : t.accent;
  return resting_colour(name, t);
}

class ThemedIcon : public QIconEngine {
 public:
  explicit ThemedIcon(const QString& name, bool on_accent) : name_(name), on_accent_(on_accent) {
    QFile file(":/clothlab/icons/" + name + ".svg");
    if (file.open(QIODevice::ReadOnly))
      svg_ = file.readAll();
    else
      qWarning("there is no icon named '%s'", qPrintable(name));
  }

  void paint(QPainter* painter, const QRect& rect, QIcon::Mode mode, QIcon::State state) override {
    const qreal ratio = painter->device() ? painter->device()->devicePixelRatioF() : 1.0;
    QPixmap image = pixmap((QSizeF(rect.size()) * ratio).toSize(), mode, state);
    image.setDevicePixelRatio(ratio);
    painter->drawPixmap(rect.topLeft(), image);
  }

  /// `size` counts device pixels: QIcon multiplies by the screen's ratio before it asks.
  QPixmap pixmap(const QSize& size, QIcon::Mode mode, QIcon::State state) override {
    if (size.isEmpty()) return {};
    if (on_accent_ && mode != QIcon::Disabled) mode = QIcon::Selected;
    const QColor colour = tint(name_, mode, state, theme());
    const QString key = QString("clothlab/%1/%2x%3/%4%5")
                            .arg(name_)
                            .arg(size.width())
                            .arg(size.height())
                            .arg(colour.name(), mode == QIcon::Disabled ? "/faint" : "");
    QPixmap image;
    if (QPixmapCache::find(key, &image)) return image;

    image = QPixmap(size);
    image.fill(Qt::transparent);
    QByteArray tinted = svg_;
    QSvgRenderer renderer(tinted.replace("currentColor", colour.name().toLatin1()));
    if (renderer.isValid()) {
      renderer.setAspectRatioMode(Qt::KeepAspectRatio);
      QPainter painter(&image);
      painter.setRenderHint(QPainter::Antialiasing);
      // A picture with colours of its own cannot be tinted, so being disabled shows in its strength.
      if (mode == QIcon::Disabled && !svg_.contains("currentColor")) painter.setOpacity(0.4);
      renderer.render(&painter, QRectF(QPointF(0, 0), QSizeF(size)));
    }
    QPixmapCache::insert(key, image);
    return image;
  }

  QIconEngine* clone() const override { return new ThemedIcon(*this); }
  QString key() const override { return "clothlab"; }
  QString iconName() override { return name_; }
  bool isNull() override { return svg_.isEmpty(); }

 private:
  QString name_;
  bool on_accent_;
  QByteArray svg_;
};

}  // namespace

QIcon icon(const QString& name) {
  ensure_resources();
  return QIcon(new ThemedIcon(name, false));
}

QIcon icon_on_accent(const QString& name) {
  ensure_resources();
  return QIcon(new ThemedIcon(name, true));
}

}  // namespace clothlab

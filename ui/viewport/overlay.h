// Overlays of the picture: colour bar, mode, brush circle, rings, lines, messages. Painted smoothly into
// small images by the processor, which are then laid over the view: so they are as crisp without
// multisampling as with it, and those that do not change are painted once.
#pragma once

#include <QCoreApplication>
#include <QImage>
#include <QPainter>
#include <QPolygonF>
#include <QString>
#include <array>
#include <functional>
#include <vector>

#include "viewport/probe_text.h"
#include "viewport/view_mode.h"

namespace clothlab {

struct Theme;

/// An image that is painted anew only when its key changes.
class PaintedLayer {
 public:
  using Key = std::array<double, 6>;

  /// Lays the layer over `area` (device-independent px) of the view, painting it first if needed; the painter
  /// that `paint` gets is in the view's coordinates.
  void lay(QPainter& view, const QRectF& area, const Key& key, const std::function<void(QPainter&)>& paint);
  void forget() { image_ = QImage(); }

 private:
  QImage image_;
  QRect area_;
  Key key_{};
};

class Overlay {
  Q_DECLARE_TR_FUNCTIONS(ClothView)

 public:
  struct Brush {
    QPointF cursor, start;  ///< px
    double radius = 0;      ///< px
    double speed = 0;       ///< m/s
    bool blowing = false;
  };
  enum class Ring { highlight, add, remove };

  /// Discards all cached images, so that they are painted again, as after a change of theme.
  void forget();

  /// What colours stand for: strains, pure numbers, or differences from a reference, m.
  enum class Quantity { strain, difference };

  void colour_bar(QPainter& view, QSizeF size, const Theme& theme, double maximum, double deformation_rate);
  void mode_name(QPainter& view, const Theme& theme, ViewMode mode, Quantity quantity);
  void brush(QPainter& view, const Theme& theme, const Brush& brush);
  void ring(QPainter& view, const Theme& theme, QPointF at, Ring ring);
  void pull_line(QPainter& view, const Theme& theme, QPointF particle, QPointF cursor);
  /// How many places touch: in the corner, or under the mode's name where that is shown.
  void contact_note(QPainter& view, const Theme& theme, int touches, bool below_mode);
  /// A ring with arrows along x, y and z; `active`: 0 the ring, 1 to 3 an arrow, else none.
  void handle(QPainter& view, const Theme& theme, QPointF at, const std::array<QPointF, 3>& tips, int active);
  /// The way that keyframes lead, from key to key, and beside the handle at `at` what a drag of it moves.
  void motion(QPainter& view, QSizeF size, const Theme& theme, const QPolygonF& keys, QPointF at);
  /// Labels of probes keep clear of those laid since.
  void begin_labels() { labels_.clear(); }
  const std::vector<QRectF>& labels() const { return labels_; }  ///< px
  /// Particles and the lines between them; with a label beside them, or without as what a click would choose.
  void probe(QPainter& view, QSizeF size, const Theme& theme, const QPolygonF& particles,
             const ProbeLabel* label);
  /// A probe of the whole shape: a line of the list at the left edge, below what was laid last. They come
  /// before those at particles.
  void shape_probe(QPainter& view, const Theme& theme, const ProbeLabel& label);
  /// What is read off under the cursor.
  void reading(QPainter& view, QSizeF size, const Theme& theme, QPointF at, const QStringList& lines);
  /// One line at the lower edge.
  void hint(QPainter& view, QSizeF size, const Theme& theme, const QString& text);
  void message(QPainter& view, QSizeF size, const Theme& theme, const QString& title, const QString& text);

 private:
  std::vector<QRectF> labels_;  ///< px, of this picture
  PaintedLayer bar_, mode_, contact_, brush_, ring_, line_, hint_, message_;
};

}  // namespace clothlab

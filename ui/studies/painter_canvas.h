// The engine's plots on a QPainter: the same drawing as its SVG, in the theme's colours, with a list of the
// shapes that have a tooltip.
#pragma once

#include <QColor>
#include <QFont>
#include <QPainter>
#include <QPainterPath>
#include <QRectF>
#include <limits>
#include <string>
#include <vector>

#include "report/svg.h"

namespace clothlab {

/// A shape with a tooltip, in px of the drawing.
struct PlotTouch {
  QRectF box;
  std::string words;    ///< of the engine; text() is as people read it, and costs more than the drawing
  int tag = -1;         ///< the run's number; -1: none
  QPainterPath line{};  ///< of a shape without a fill, which is where its line is; else empty
  QString text() const;
};

class PainterCanvas : public cloth::PlotCanvas {
 public:
  enum class Look { light_paper, dark_paper, theme };

  /// The painter must outlive the canvas. `font` gives the family of all text.
  PainterCanvas(QPainter& painter, const QFont& font, Look look);

  QColor colour(const cloth::PageColour& colour) const;
  const std::vector<PlotTouch>& touches() const { return touches_; }
  /// Of the texts drawn so far, in px; infinity: none.
  double smallestText() const { return smallest_text_; }

  void path(const std::string& data, const cloth::SvgStyle& style, const cloth::SvgTip& tip = {}) override;
  void rect(cloth::SvgPoint corner, double width, double height, const cloth::SvgStyle& style,
            const cloth::SvgTip& tip = {}) override;
  void text(cloth::SvgPoint baseline, const cloth::SvgText& text) override;
  void marker(cloth::Marker marker, cloth::SvgPoint centre, double radius, const cloth::SvgStyle& style,
              const cloth::SvgTip& tip = {}) override;
  void begin_group(const std::string& name, const cloth::SvgStyle& style = {}, bool untouchable = false,
                   bool crisp = false) override;
  void end_group() override;

 private:
  struct Group {
    cloth::SvgStyle style;
    bool untouchable = false;
  };
  void draw(const QPainterPath& shape, const cloth::SvgStyle& style, const cloth::SvgTip& tip);

  QPainter& painter_;
  QFont font_;
  Look look_;
  std::vector<Group> groups_;
  std::vector<PlotTouch> touches_;
  double smallest_text_ = std::numeric_limits<double>::infinity();
};

}  // namespace clothlab

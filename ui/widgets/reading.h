// A line of text that changes many times a second. A QLabel updates the layout of the whole window with every
// new text; this widget keeps the size of its widest text.
#pragma once

#include <QWidget>

namespace clothlab {

class Reading : public QWidget {
  Q_OBJECT

 public:
  enum class Look { plain, bold, muted };

  Reading(const QString& widest, Look look, QWidget* parent);

  const QString& text() const { return text_; }
  void setText(const QString& text);

  QSize sizeHint() const override;
  QSize minimumSizeHint() const override { return sizeHint(); }

 protected:
  void paintEvent(QPaintEvent* event) override;

 private:
  QFont textFont() const;

  QString widest_, text_;
  Look look_;
};

}  // namespace clothlab

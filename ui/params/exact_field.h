// A field for one exact number with its unit: what is typed is what is stored. It shows six digits and the
// unit with a prefix while it is not edited, and all digits in the unit itself while it has the focus;
// showing never changes the value.
#pragma once

#include <QLineEdit>
#include <string>

namespace clothlab {

class ExactField : public QLineEdit {
  Q_OBJECT

 public:
  explicit ExactField(QWidget* parent = nullptr);

  void setUnit(const std::string& unit);  ///< after the number, muted
  void setPrefix(const QString& text);    ///< before the number, muted: an axis

  /// Shows a value and discards text being typed.
  void showValue(double value);
  /// Shows that there is no number; `hint`, with a unit of its own, stands in its place, muted.
  void showNothing(const QString& hint);

  /// Whether the text is not in the document: it is being typed, or was refused.
  bool hasPendingText() const { return isModified() || invalid_; }
  void setInvalid(bool invalid);
  void abandonEdit();  ///< back to the value that was shown

  QSize sizeHint() const override { return {112, QLineEdit::sizeHint().height()}; }
  QSize minimumSizeHint() const override { return {56, QLineEdit::minimumSizeHint().height()}; }

 Q_SIGNALS:
  void committed(const QString& text);  ///< Enter, or the focus leaves, after an edit
  void abandoned();                     ///< Escape, after an edit
  void stepped(int steps);              ///< arrow and page keys
  void stepsEnded();                    ///< the key was released

 protected:
  bool event(QEvent* event) override;
  void keyPressEvent(QKeyEvent* event) override;
  void keyReleaseEvent(QKeyEvent* event) override;
  void focusInEvent(QFocusEvent* event) override;
  void focusOutEvent(QFocusEvent* event) override;
  void mousePressEvent(QMouseEvent* event) override;
  void mouseReleaseEvent(QMouseEvent* event) override;
  void changeEvent(QEvent* event) override;
  void paintEvent(QPaintEvent* event) override;

 private:
  void commit();
  void showText();
  QString shownUnit() const;
  void updateMargins();
  void endSteps();

  std::string unit_;
  QString prefix_;
  QString short_, short_unit_, exact_;  ///< of the value shown
  bool invalid_ = false;
  bool stepping_ = false;
  bool select_on_release_ = false;
};

}  // namespace clothlab

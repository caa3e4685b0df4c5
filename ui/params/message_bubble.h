// A message about the row of a form. It lies over the form, above the row's control, and lets the mouse
// through: no row moves when it comes or goes.
#pragma once

#include <QLabel>

class QLayout;

namespace clothlab {

class MessageBubble : public QLabel {
  Q_OBJECT

 public:
  enum class Level { error, warning };

  /// For the control in this layout of the row.
  MessageBubble(QWidget& row, const QLayout& control);

  /// Shows a message until another one, or until the focus goes on to another row. It is shown again while
  /// the mouse is over the row or the focus in it.
  void say(Level level, const QString& text);
  void withdraw();

 protected:
  bool eventFilter(QObject* watched, QEvent* event) override;

 private:
  void appear();
  void place();
  void followFocus(const QWidget* old, const QWidget* now);
  bool isInRow(const QWidget* widget) const;

  QWidget& row_;
  const QLayout& control_;
};

}  // namespace clothlab

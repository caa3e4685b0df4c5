// One message above the view: what happened, how to correct it, and optionally a button with an action. A new
// message replaces the present one.
#pragma once

#include <QFrame>
#include <functional>

class QLabel;
class QPushButton;
class QToolButton;

namespace clothlab {

class NoticeBar : public QFrame {
  Q_OBJECT

 public:
  enum class Level { info, warning, error };

  explicit NoticeBar(QWidget* parent = nullptr);

  /// `cause` names what the message is about ("divergence"); a later message of the same cause replaces it.
  void show(const QString& cause, Level level, const QString& text, const QString& button = {},
            std::function<void()> action = {});

  /// Hides the message if it has this cause.
  void withdraw(const QString& cause) {
    if (cause_ == cause) hide();
  }

  QString cause() const { return isHidden() ? QString() : cause_; }
  QString text() const;

 protected:
  void changeEvent(QEvent* event) override;

 private:
  void dress();

  QString cause_;
  Level level_ = Level::info;
  QLabel* symbol_;
  QLabel* label_;
  QPushButton* button_;
  QToolButton* close_;
  std::function<void()> action_;
};

}  // namespace clothlab

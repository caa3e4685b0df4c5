// Answers the dialogs that come up while it lives, one after the other, as a hand would.
#pragma once

#include <QAbstractButton>
#include <QApplication>
#include <QDialogButtonBox>
#include <QFileDialog>
#include <QLineEdit>
#include <QMessageBox>
#include <QProgressDialog>
#include <QTimer>
#include <QtTest>
#include <algorithm>
#include <deque>
#include <functional>

#include "patience.h"

namespace clothlab::test {

class Answers {
 public:
  Answers() {
    QObject::connect(&watch_, &QTimer::timeout, [this] { look(); });
    watch_.start(30);
  }

  /// Into a dialog for files, and its Open or Save button.
  Answers& type(const QString& path) {
    return add([path](QDialog* dialog) {
      auto* files = qobject_cast<QFileDialog*>(dialog);
      if (!files) return false;
      files->findChild<QLineEdit*>("fileNameEdit")->setText(path);
      const bool saves = files->acceptMode() == QFileDialog::AcceptSave;
      press(files, saves ? QDialogButtonBox::Save : QDialogButtonBox::Open);
      return true;
    });
  }
  /// Escape in a dialog for files.
  Answers& leave() {
    return add([](QDialog* dialog) {
      if (!qobject_cast<QFileDialog*>(dialog)) return false;
      QTest::keyClick(dialog, Qt::Key_Escape);
      return true;
    });
  }
  /// The button of a message that has this text.
  Answers& press(const QString& button) {
    return add([this, button](QDialog* dialog) {
      auto* message = qobject_cast<QMessageBox*>(dialog);
      if (!message) return false;
      texts_ << message->text();
      for (QAbstractButton* each : message->buttons())
        if (each->text().remove('&') == button) {
          QTest::mouseClick(each, Qt::LeftButton);
          return true;
        }
      return false;
    });
  }

  /// Whether each came, in this order, and no other dialog. Then waits until a window, if one is left,
  /// is active again and takes the next key; a window manager may forget which was, so that it is asked for.
  bool came_true() const {
    const auto takes_keys = [] {
      const QWidgetList windows = QApplication::topLevelWidgets();
      const auto shown = std::find_if(windows.begin(), windows.end(), [](const QWidget* window) {
        return window->isVisible() && window->isWindow() && window->windowType() != Qt::Popup;
      });
      if (QApplication::activeWindow() || shown == windows.end()) return true;
      (*shown)->activateWindow();
      return false;
    };
    return steps_.empty() && unexpected_.isEmpty() && QTest::qWaitFor(takes_keys, patience);
  }
  QString what_went_wrong() const {
    return QStringLiteral("%1 answers are left; unexpected: %2")
        .arg(steps_.size())
        .arg(unexpected_.join(", "));
  }
  QString last_text() const { return texts_.isEmpty() ? QString() : texts_.last(); }

 private:
  using Step = std::function<bool(QDialog*)>;  ///< false: not that dialog

  Answers& add(Step step) {
    steps_.push_back(std::move(step));
    return *this;
  }

  static void press(QDialog* dialog, QDialogButtonBox::StandardButton which) {
    QTest::mouseClick(dialog->findChild<QDialogButtonBox*>()->button(which), Qt::LeftButton);
  }

  void look() {
    auto* dialog = qobject_cast<QDialog*>(QApplication::activeModalWidget());
    if (!dialog || !dialog->isVisible()) return;
    if (qobject_cast<QProgressDialog*>(dialog))
      return;  // it comes up where work takes long, and goes by itself
    if (!steps_.empty()) {
      const Step step = std::move(steps_.front());
      steps_.pop_front();  // what it does may bring up the next dialog
      if (step(dialog)) return;
    }
    auto* message = qobject_cast<QMessageBox*>(dialog);
    unexpected_ << (message ? message->text() : dialog->windowTitle());
    dialog->reject();
  }

  QTimer watch_;
  std::deque<Step> steps_;
  QStringList texts_, unexpected_;
};

}  // namespace clothlab::test

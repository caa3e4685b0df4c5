// Turns the window dark or light with the desktop while it is open.
#pragma once

#include <QDBusVariant>
#include <QObject>
#include <QString>
#include <optional>

class QApplication;

namespace clothlab {

/// The colour scheme from the desktop's settings portal (GNOME, KDE and others), as far as FollowDesktop has
/// heard: true for dark, false for light, nullopt without a preference, a portal or an answer. Qt 6.4 does
/// not read it.
std::optional<bool> portal_prefers_dark();

class FollowDesktop : public QObject {
  Q_OBJECT

 public:
  /// Asks the portal without waiting: the answer changes the theme when it comes.
  explicit FollowDesktop(QApplication& application);
  bool eventFilter(QObject* watched, QEvent* event) override;

 private Q_SLOTS:
  void setting_changed(const QString& group, const QString& key, const QDBusVariant& value);

 private:
  void ask_portal();
  void follow_soon();

  bool waiting_ = false;
};

}  // namespace clothlab

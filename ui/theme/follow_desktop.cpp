#include "theme/follow_desktop.h"

#include <QApplication>
#include <QDBusConnection>
#include <QDBusMessage>
#include <QDBusPendingCallWatcher>
#include <QEvent>
#include <QFileInfo>
#include <QSettings>
#include <QTimer>

#include "theme/theme.h"

namespace clothlab {
namespace {

const char* const service = "org.freedesktop.portal.Desktop";
const char* const path = "/org/freedesktop/portal/desktop";
const char* const interface = "org.freedesktop.portal.Settings";
const char* const appearance = "org.freedesktop.appearance";
const char* const colour_scheme = "color-scheme";

/// What the portal has answered last, which is kept for the next start: 1 dark, 2 light, 0 no preference.
const char* const scheme_key = "desktopColourScheme";

/// Asking for the bus where there is none makes D-Bus try to start one, which takes its time and leaves a
/// process.
bool has_session_bus() {
  return qEnvironmentVariableIsSet("DBUS_SESSION_BUS_ADDRESS") ||
         QFileInfo::exists(qEnvironmentVariable("XDG_RUNTIME_DIR") + "/bus");
}

/// The older call of the portal wraps its answer in one variant more.
QVariant unwrapped(QVariant value) {
  while (value.canConvert<QDBusVariant>()) value = value.value<QDBusVariant>().variant();
  return value;
}

}  // namespace

std::optional<bool> portal_prefers_dark() {
  const uint scheme = has_session_bus() ? QSettings().value(scheme_key).toUInt() : 0;
  return scheme == 1 || scheme == 2 ? std::optional(scheme == 1) : std::nullopt;
}

FollowDesktop::FollowDesktop(QApplication& application) : QObject(&application) {
  application.installEventFilter(this);
  if (!has_session_bus()) return;
  QDBusConnection::sessionBus().connect(service, path, interface, "SettingChanged", this,
                                        SLOT(setting_changed(QString, QString, QDBusVariant)));
  ask_portal();
}

void FollowDesktop::ask_portal() {
  QDBusMessage question = QDBusMessage::createMethodCall(service, path, interface, "Read");
  question << QString(appearance) << QString(colour_scheme);
  auto* answer = new QDBusPendingCallWatcher(QDBusConnection::sessionBus().asyncCall(question), this);
  connect(answer, &QDBusPendingCallWatcher::finished, this, [this, answer] {
    answer->deleteLater();
    const QDBusMessage message = answer->reply();
    if (message.type() != QDBusMessage::ReplyMessage || message.arguments().isEmpty()) return;
    const uint scheme = unwrapped(message.arguments().constFirst()).toUInt();
    if (scheme == QSettings().value(scheme_key).toUInt()) return;
    QSettings().setValue(scheme_key, scheme);
    follow_soon();
  });
}

bool FollowDesktop::eventFilter(QObject* watched, QEvent* event) {
  // Sent to every window when the desktop changes its theme, and never by setPalette() or setStyleSheet():
  // acting on it cannot start a loop.
  if (event->type() == QEvent::ThemeChange) follow_soon();
  return QObject::eventFilter(watched, event);
}

void FollowDesktop::setting_changed(const QString& group, const QString& key, const QDBusVariant&) {
  if (group == appearance && key == colour_scheme) ask_portal();
}

/// Waits for the event loop, so that the news from all windows and from the portal together cost one change.
void FollowDesktop::follow_soon() {
  if (waiting_) return;
  waiting_ = true;
  QTimer::singleShot(0, this, [this] {
    waiting_ = false;
    apply_theme(*qApp);
  });
}

}  // namespace clothlab

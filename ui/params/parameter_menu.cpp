#include "params/parameter_menu.h"

#include <QClipboard>
#include <QGuiApplication>
#include <QMenu>
#include <QToolButton>

#include "document/varied_ranges.h"
#include "theme/theme.h"
#include "widgets/building.h"

namespace clothlab {
namespace {

constexpr QSize size{24, 18};  // px

void fill(QMenu& menu, LabDocument& document, const std::string& path) {
  menu.clear();
  VariedRanges& varied = document.varied();
  if (varied.find(path)) {
    named("vary", menu.addAction(QObject::tr("Do not vary")));
    QObject::connect(menu.actions().last(), &QAction::triggered, &menu,
                     [&varied, path] { varied.remove(path); });
  } else {
    QAction* vary = named("vary", menu.addAction(QObject::tr("Vary…")));
    vary->setToolTip(QObject::tr("Give it a range: a sweep runs the scene at values from end to end"));
    vary->setEnabled(varied.list().size() < VariedRanges::most);
    QObject::connect(vary, &QAction::triggered, &menu, [&varied, path] { varied.add(path); });
  }
  menu.addSeparator();
  QAction* reset = named("resetFromMenu", menu.addAction(QObject::tr("Back to the default")));
  const auto fallback = cloth::default_of(document.scene(), path);
  reset->setEnabled(fallback && document.value(path) != fallback);
  QObject::connect(reset, &QAction::triggered, &menu, [&document, path] { document.resetParameter(path); });
  QAction* copy = named("copyPath", menu.addAction(QObject::tr("Copy the path")));
  copy->setToolTip(QString::fromStdString(path));
  QObject::connect(copy, &QAction::triggered, &menu,
                   [path] { QGuiApplication::clipboard()->setText(QString::fromStdString(path)); });
}

}  // namespace

QToolButton* make_parameter_menu(LabDocument& document, const cloth::Parameter& parameter, QWidget* parent) {
  auto* button = named("parameterMenu", new QToolButton(parent));
  button->setIcon(icon("more"));
  button->setIconSize({16, 16});
  button->setFixedSize(size);
  button->setAutoRaise(true);
  button->setFocusPolicy(Qt::NoFocus);
  button->setPopupMode(QToolButton::InstantPopup);
  button->setProperty("quiet", true);
  const QString label = QString::fromStdString(parameter.info.label);
  button->setAccessibleName(QObject::tr("Menu of %1").arg(label));
  button->setToolTip(QObject::tr("Vary it, its default, its path (menu key on the slider)"));
  auto* menu = named("menuOfParameter", new QMenu(button));
  menu->setToolTipsVisible(true);
  button->setMenu(menu);
  QObject::connect(menu, &QMenu::aboutToShow, button,
                   [menu, &document, path = parameter.path] { fill(*menu, document, path); });
  return button;
}

}  // namespace clothlab

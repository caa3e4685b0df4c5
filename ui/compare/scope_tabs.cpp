#include "compare/scope_tabs.h"

#include <QLabel>
#include <QSignalBlocker>
#include <QTabBar>
#include <QVBoxLayout>

#include "compare/pane_style.h"
#include "document/lab_document.h"
#include "params/parameter_panel.h"
#include "params/wording.h"
#include "theme/theme.h"
#include "widgets/building.h"

namespace clothlab {
namespace {

QString own_note(const cloth::Comparison& comparison, const std::string& path) {
  QStringList own;
  for (std::size_t i = 0; i < comparison.panes.size(); ++i) {
    if (!own_value(comparison.panes[i], path)) continue;
    const cloth::Scene scene = scene_of(comparison, i);
    if (const auto parameter = cloth::find_parameter(scene, path))
      own << QStringLiteral("%1 %2").arg(QString::fromStdString(comparison.panes[i].name),
                                         value_in_words(parameter->info, parameter->get(scene)));
  }
  return ScopeTabs::tr("Own: %1").arg(own.join(", "));
}

QString shared_note(const cloth::Scene& shared, const std::string& path) {
  const auto parameter = cloth::find_parameter(shared, path);
  return ScopeTabs::tr("Own value. Shared: %1")
      .arg(parameter ? value_in_words(parameter->info, parameter->get(shared)) : ScopeTabs::tr("not there"));
}

}  // namespace

ScopeTabs::ScopeTabs(LabDocument& document, ParameterPanel& form, QWidget* parent)
    : QWidget(parent),
      document_(document),
      form_(form),
      tabs_(named("scopes", new QTabBar(this))),
      hint_(muted(new QLabel(this))) {
  tabs_->setAccessibleName(tr("Whose values the form shows"));
  tabs_->setExpanding(false);
  tabs_->setUsesScrollButtons(false);
  tabs_->setIconSize({12, 12});
  tabs_->setStyleSheet("QTabBar::tab { padding: 6px 6px; margin-right: 0; }");
  hint_->setWordWrap(true);
  hint_->setContentsMargins(2 * spacing, spacing, spacing, 0);
  auto* rows = spaced(new QVBoxLayout(this), 0);
  rows->addWidget(tabs_);
  rows->addWidget(hint_);
  hide();
  connect(tabs_, &QTabBar::currentChanged, this, [this](int tab) {
    document_.setScope(tab > 0 ? std::optional(static_cast<std::size_t>(tab - 1)) : std::nullopt);
  });
  connect(&form_, &ParameterPanel::noteButtonClicked, this, [this](const std::string& path) {
    if (document_.scope()) document_.useShared(*document_.scope(), path);
  });
  connect(&document_, &LabDocument::scopeChanged, this, &ScopeTabs::refresh);
}

void ScopeTabs::refresh() {
  form_.setBlocksEditable(!document_.scope());
  if (isHidden() == document_.isComparison()) {
    form_.clearNotes();
    setVisible(document_.isComparison());
  }
  if (!document_.isComparison()) return;
  const QSignalBlocker quiet(tabs_);
  const auto& panes = document_.comparison().panes;
  const int count = static_cast<int>(panes.size()) + 1;
  while (tabs_->count() > count) tabs_->removeTab(tabs_->count() - 1);
  while (tabs_->count() < count) tabs_->addTab({});
  tabs_->setTabText(0, tr("Shared"));
  for (int tab = 1; tab < count; ++tab) {
    const cloth::Pane& pane = panes[static_cast<std::size_t>(tab - 1)];
    tabs_->setTabText(tab, QString::fromStdString(pane.name));
    tabs_->setTabIcon(tab, pane_icon(style_of(pane)));
    tabs_->setTabToolTip(
        tab, QString::fromStdString(title_of(document_.comparison(), static_cast<std::size_t>(tab - 1))));
  }
  const auto scope = document_.scope();
  tabs_->setCurrentIndex(scope ? static_cast<int>(*scope) + 1 : 0);
  hint_->setText(
      scope
          ? tr("What you change here becomes pane %1's own.").arg(QString::fromStdString(panes[*scope].name))
          : tr("What all panes share. A pane keeps the values that it has of its own."));
  noteOwnValues();
}

/// Below each parameter: in which panes it is own, or that it is this pane's own and what the others share.
void ScopeTabs::noteOwnValues() {
  const cloth::Comparison& comparison = document_.comparison();
  form_.clearNotes();
  const auto scope = document_.scope();
  for (const std::string& path : own_paths(comparison)) {
    if (!scope)
      form_.setNote(path, own_note(comparison, path));
    else if (own_value(comparison.panes[*scope], path))
      form_.setNote(path, shared_note(comparison.scene, path), tr("Use shared"));
  }
}

}  // namespace clothlab

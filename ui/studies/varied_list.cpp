#include "studies/varied_list.h"

#include <QLabel>
#include <QMenu>
#include <QToolButton>
#include <QVBoxLayout>
#include <algorithm>

#include "document/varied_ranges.h"
#include "theme/theme.h"
#include "widgets/building.h"

namespace clothlab {

VariedList::VariedList(LabDocument& document, RangeRow::Place place, QWidget* parent)
    : QWidget(parent), document_(document), place_(place) {
  auto* column = spaced(new QVBoxLayout(this), spacing / 2);
  hint_ = named("sweepHint",
                muted(new QLabel(tr("Nothing is varied yet: choose “Vary…” in the menu ⋮ of a parameter, or "
                                    "here:"),
                                 this)));
  hint_->setWordWrap(true);
  column->addWidget(hint_);
  ranges_ = spaced(new QVBoxLayout, spacing);
  column->addLayout(ranges_);
  auto* button = named("sweepVary", new QToolButton(this));
  button->setText(tr("Vary a parameter"));
  button->setIcon(icon("add"));
  button->setIconSize({16, 16});
  button->setToolButtonStyle(Qt::ToolButtonTextBesideIcon);
  button->setPopupMode(QToolButton::InstantPopup);
  button->setToolTip(tr("Every number of the scene; in the form, the menu beside a parameter does the same"));
  menu_ = named("sweepVaryMenu", new QMenu(button));
  button->setMenu(menu_);
  column->addWidget(button);
  connect(menu_, &QMenu::aboutToShow, this, &VariedList::fillMenu);
  connect(&document.varied(), &VariedRanges::changed, this, &VariedList::refresh);
  refresh();
}

/// A menu for each block.
void VariedList::fillMenu() {
  menu_->clear();
  for (const cloth::Block& block : cloth::blocks_of(document_.scene())) {
    QMenu* of_block = nullptr;
    for (const cloth::Parameter& parameter : block.parameters) {
      if (!can_be_varied(parameter.info)) continue;
      if (!of_block) of_block = menu_->addMenu(QString::fromStdString(block.title));
      QAction* action = of_block->addAction(QString::fromStdString(parameter.info.label));
      action->setObjectName("vary:" + QString::fromStdString(parameter.path));
      action->setEnabled(!document_.varied().find(parameter.path));
      connect(action, &QAction::triggered, this,
              [this, path = parameter.path] { document_.varied().add(path); });
    }
  }
}

void VariedList::refresh() {
  const std::vector<VariedRange> ranges = document_.varied().list();
  const bool same =
      std::equal(ranges.begin(), ranges.end(), rows_.begin(), rows_.end(),
                 [](const VariedRange& range, const RangeRow* row) { return range.path == row->path(); });
  if (same)
    for (RangeRow* row : rows_) row->refresh();
  else
    rebuild();
  hint_->setVisible(ranges.empty());
  Q_EMIT changed();
}

void VariedList::rebuild() {
  for (RangeRow* row : std::exchange(rows_, {})) {
    row->abandonEdits();
    row->hide();
    row->deleteLater();
  }
  QWidget* last = nullptr;
  for (const VariedRange& range : document_.varied().list()) {
    auto* row = new RangeRow(document_, *find_parameter(document_.scene(), range.path), place_, this);
    connect(row, &RangeRow::ruleBroken, this, &VariedList::ruleBroken);
    ranges_->addWidget(row);
    rows_.push_back(row);
    for (QWidget* stop : row->tabStops()) {
      if (last) QWidget::setTabOrder(last, stop);
      last = stop;
    }
  }
  if (last) QWidget::setTabOrder(last, findChild<QToolButton*>("sweepVary"));
}

}  // namespace clothlab

#include "compare/ranking_panel.h"

#include <QComboBox>
#include <QLabel>
#include <QSignalBlocker>
#include <QVBoxLayout>

#include "compare/pane_style.h"
#include "theme/theme.h"
#include "widgets/building.h"
#include "widgets/numbers.h"

namespace clothlab {
namespace {

constexpr int refill_interval = 200;  // ms

}  // namespace

RankingPanel::RankingPanel(QWidget* parent)
    : QWidget(parent), reference_(named("reference", new QComboBox(this))), table_(new RankingTable(this)) {
  auto* head = spaced(new QHBoxLayout, spacing, {spacing, spacing / 2, spacing, spacing / 2});
  auto* label = new QLabel(tr("Differences from"), this);
  label->setBuddy(reference_);
  reference_->setAccessibleName(tr("Reference"));
  reference_->setMinimumContentsLength(12);
  head->addWidget(label);
  head->addWidget(reference_);
  head->addStretch(1);
  auto* rows = spaced(new QVBoxLayout(this), 0);
  rows->addLayout(head);
  rows->addWidget(table_, 1);
  since_results_.start();
  connect(reference_, &QComboBox::activated, this, [this](int index) {
    Q_EMIT referenceChosen(reference_->itemData(index).toString().toStdString());
  });
}

void RankingPanel::showComparison(const cloth::Comparison& comparison) {
  const QSignalBlocker quiet(reference_);
  reference_->clear();
  reference_->addItem(tr("Error control"), QString::fromLatin1(cloth::controlled_reference));
  for (std::size_t i = 0; i < comparison.panes.size(); ++i) {
    const cloth::Pane& pane = comparison.panes[i];
    reference_->addItem(
        pane_icon(style_of(pane)),
        tr("Pane %1, %2")
            .arg(QString::fromStdString(pane.name), QString::fromStdString(title_of(comparison, i))),
        QString::fromStdString(pane.name));
  }
  reference_->addItem(tr("None"), QString::fromLatin1(cloth::no_reference));
  reference_->setCurrentIndex(reference_->findData(QString::fromStdString(comparison.reference)));
}

void RankingPanel::showResults(const WorkerStatus& status) {
  reference_->setToolTip(tr("Differences are from: %1").arg(sentence_text(status.reference)));
  const bool news = status.time != shown_time_ || static_cast<int>(status.panes.size()) != table_->rowCount();
  if (status.playing && !(news && since_results_.elapsed() > refill_interval)) return;
  table_->showResults(status.panes);
  shown_time_ = status.time;
  since_results_.restart();
}

}  // namespace clothlab

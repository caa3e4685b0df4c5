#include "compare/pane_view.h"

#include <QAction>
#include <QHBoxLayout>
#include <QLabel>
#include <QMenu>
#include <QPainter>
#include <QSignalBlocker>
#include <QToolButton>
#include <QVBoxLayout>
#include <algorithm>

#include "compare/pane_style.h"
#include "integrators/registry.h"
#include "params/exact_field.h"
#include "params/panel_parts.h"
#include "params/wording.h"
#include "theme/theme.h"
#include "widgets/building.h"
#include "widgets/notice_bar.h"
#include "widgets/numbers.h"
#include "widgets/reading.h"
#include "widgets/stability_gauge.h"

namespace clothlab {
namespace {

constexpr int frame_width = 2;    // px
constexpr int step_width = 80;    // px
constexpr int least_width = 222;  // px: letter, half of a method's name and the menu; step and gauge below
/// px: a lower view takes the row of the difference, which the ranking says too; and then that of the gauge.
constexpr int view_below_difference = 96, view_below_gauge = 60;

void set_text(QLabel& label, const QString& text) {
  if (label.text() != text) label.setText(text);
}

QString metres_text(double metres) {
  constexpr int digits = 3;
  return quantity_text(metres, "m", digits);
}

QString difference_from_reference(const cloth::PaneResult& result, bool has_reference) {
  if (result.divergence) return PaneView::tr("Stopped at %1").arg(quantity_text(result.simulated, "s", 4));
  if (result.is_reference) return PaneView::tr("Reference");
  if (!has_reference) return PaneView::tr("No reference");
  if (!result.rms) return PaneView::tr("No difference measured");
  const QString text =
      PaneView::tr("RMS %1, largest %2").arg(metres_text(*result.rms), metres_text(*result.largest));
  return result.below_floor ? PaneView::tr("%1 (as close as the reference can tell)").arg(text) : text;
}

/// And whether its energy closes: what a pane's motion is worth without any reference.
QString difference_text(const cloth::PaneResult& result, bool has_reference) {
  const QString text = difference_from_reference(result, has_reference);
  if (!result.energy.is_doubtful_so_far()) return text;
  return PaneView::tr("%1; energy error %2 % of the exchanged")
      .arg(text, number_text(100 * result.energy.share(), 2));
}

}  // namespace

PaneView::PaneView(QWidget* parent)
    : QFrame(parent),
      view_(new ClothView(this)),
      header_(new QWidget(this)),
      badge_(new PaneBadge(this)),
      method_(new QuietCombo(this)),
      step_(new ExactField(this)),
      more_(new QToolButton(this)),
      gauge_(new StabilityGauge(this)),
      cost_(new Reading("0.0000 s/s", Reading::Look::muted, this)),
      difference_(new ElidedLabel(this)),
      notice_(new NoticeBar(this)) {
  auto* column = spaced(new QVBoxLayout(this), 0);
  column->addWidget(header_);
  column->addWidget(view_, 1);
  notice_->layOver(view_, Qt::TopEdge);
  makeHeader();

  connect(method_, &QComboBox::activated, this,
          [this](int index) { Q_EMIT methodChosen(method_->itemData(index).toString().toStdString()); });
  connect(step_, &ExactField::committed, this, &PaneView::takeStep);
}

void PaneView::makeHeader() {
  auto* column =
      spaced(new QVBoxLayout(header_), spacing / 4, {spacing, spacing / 2, spacing / 2, spacing / 2});

  method_->setObjectName("method");
  method_->setAccessibleName(tr("Method"));
  method_->setMinimumContentsLength(2);  // where the window is narrow, the panes share it
  for (const cloth::MethodFacts& facts : cloth::integrator_facts())
    method_->addItem(QString::fromStdString(facts.title), QString::fromStdString(facts.name));
  step_->setObjectName("step");
  step_->setUnit("s");
  step_->setAccessibleName(tr("Time step"));
  step_->setFixedWidth(step_width);
  more_->setObjectName("more");
  more_->setText(QStringLiteral("⋯"));
  more_->setStyleSheet("QToolButton::menu-indicator { image: none; } QToolButton { padding: 4px 8px; }");
  more_->setAccessibleName(tr("Pane"));
  more_->setToolTip(tr("Duplicate, remove, make it the reference"));
  more_->setPopupMode(QToolButton::InstantPopup);
  makeMenu(*more_);
  first_row_ = spaced(new QHBoxLayout, spacing / 2);
  first_row_->addWidget(badge_);
  first_row_->addWidget(method_, 1);
  first_row_->addWidget(step_);
  first_row_->addWidget(more_);
  column->addLayout(first_row_);

  second_row_ = spaced(new QHBoxLayout, spacing);
  second_row_->addWidget(gauge_, 1);
  cost_->setObjectName("cost");
  cost_->setToolTip(tr("Seconds of stepping for each simulated second"));
  second_row_->addWidget(cost_);
  column->addLayout(second_row_);

  difference_->setObjectName("difference");
  column->addWidget(difference_);
}

void PaneView::makeMenu(QToolButton& button) {
  auto* menu = new QMenu(&button);
  duplicate_ = menu->addAction(tr("Duplicate"), this, &PaneView::duplicateWanted);
  duplicate_->setObjectName("duplicate");
  menu->addAction(tr("Remove"), this, &PaneView::removeWanted)->setObjectName("removePane");
  menu->addSeparator();
  make_reference_ = menu->addAction(tr("Measure the others against it"), this, &PaneView::referenceWanted);
  make_reference_->setObjectName("makeReference");
  make_reference_->setCheckable(true);
  button.setMenu(menu);
}

void PaneView::takeStep(const QString& text) {
  const QString typed = text.trimmed().toLower();
  if (typed.isEmpty() || typed == "auto") {
    Q_EMIT stepChosen(std::string("auto"));
    return;
  }
  const cloth::Quantity step = typed_quantity(text, "s");
  if (step.ok())
    Q_EMIT stepChosen(step.value);
  else
    showStepRule(tr("%1, or \"auto\"").arg(typographic(QString::fromStdString(step.rule))));
}

void PaneView::showStepRule(const QString& rule) {
  step_->setInvalid(!rule.isEmpty());
  step_->setToolTip(rule.isEmpty() ? tr("Time step of this pane: a number of seconds, or \"auto\"") : rule);
}

void PaneView::setAlone(bool alone) {
  is_alone_ = alone;
  const int margin = alone ? 0 : frame_width;
  layout()->setContentsMargins(margin, margin, margin, margin);
  header_->setVisible(!alone);
  setLow(is_low_);
  if (alone) forgetStop();  // the window says it
  update();
}

void PaneView::setLow(bool low) {
  is_low_ = low;
  view_->setMinimumSize(is_alone_ ? QSize(320, 160) : QSize(160, low ? 24 : 56));
  layout()->activate();
}

void PaneView::showPane(const cloth::Comparison& comparison, std::size_t pane, bool can_grow) {
  const cloth::Pane& shown = comparison.panes[pane];
  scene_ = scene_of(comparison, pane);
  style_ = style_of(shown);
  const QString name = "pane:" + QString::fromStdString(shown.name);
  if (name != objectName()) forgetStop();
  if (notice_->shows("divergence")) sayStop();
  setObjectName(name);
  badge_->setPane(style_, QString::fromStdString(shown.name));
  badge_->setToolTip(QString::fromStdString(title_of(comparison, pane)));
  {
    const QSignalBlocker quiet(method_);
    method_->setCurrentIndex(method_->findData(QString::fromStdString(scene_.integrator.method)));
  }
  const StabilityReading reading = read_stability(scene_);
  if (!step_->hasPendingText()) {
    showStepRule({});
    if (scene_.integrator.time_step)
      step_->showValue(*scene_.integrator.time_step);
    else
      step_->showNothing(tr("auto"));
  }
  gauge_->setReading(reading);
  duplicate_->setEnabled(can_grow);
  make_reference_->setChecked(comparison.reference == shown.name);
  dress();
}

void PaneView::showResult(const cloth::PaneResult& result, bool has_reference) {
  cost_->setText(result.simulated > 0 ? tr("%1 s/s").arg(number_text(result.cost(), 3)) : QString());
  set_text(*difference_, difference_text(result, has_reference));
  QStringList notices;
  if (!result.notice.empty()) notices << sentence_text(result.notice);
  if (result.energy.is_doubtful_so_far()) notices << sentence_text(describe(result.energy));
  difference_->setToolTip(notices.isEmpty() ? difference_->text() : notices.join('\n'));
  if (result.divergence.has_value() == stop_.has_value()) return;
  stop_ = result.divergence;
  sayStop();
}

void PaneView::sayStop() {
  if (!stop_) return notice_->withdraw("divergence");
  const QString what = stop_->pinched         ? tr("Pinched at %1: %2.")
                       : stop_->solver_failed ? tr("Stopped at %1: %2.")
                                              : tr("Diverged at %1: %2.");
  std::vector<NoticeAction> help;
  for (const Remedy& remedy : remedies_for(scene_, *stop_))
    help.push_back({remedy.text, [this, remedy] { Q_EMIT remedyChosen(remedy); }});
  notice_->show("divergence", NoticeBar::Level::error,
                what.arg(quantity_text(stop_->time, "s", 4), sentence_text(stop_->cause)), std::move(help),
                tr("The pane %1.").arg(sentence_text(cloth::describe(*stop_))));
}

void PaneView::forgetStop() {
  stop_.reset();
  sayStop();
}

void PaneView::dress() {
  update();
  badge_->update();
}

void PaneView::changeEvent(QEvent* event) {
  QFrame::changeEvent(event);
  if (event->type() == QEvent::PaletteChange) dress();
}

QSize PaneView::minimumSizeHint() const {
  if (is_alone_) return QFrame::minimumSizeHint();
  return {least_width, 2 * frame_width + headerHeight(3) + view_->minimumHeight()};
}

/// With so many rows: method; step and gauge; difference.
int PaneView::headerHeight(int rows) const {
  const int heights[]{method_->sizeHint().height(),
                      std::max(gauge_->sizeHint().height(), is_roomy_ ? 0 : step_->sizeHint().height()),
                      difference_->sizeHint().height()};
  const QMargins margins = header_->layout()->contentsMargins();
  int height = margins.top() + margins.bottom() + (rows - 1) * header_->layout()->spacing();
  for (int row = 0; row < rows; ++row) height += heights[row];
  return height;
}

/// At which the longest name of a method is whole with the step beside it.
int PaneView::roomyWidth() const {
  int method = 0;
  for (int i = 0; i < method_->count(); ++i)
    method = std::max(method, method_->widthFor(method_->itemText(i)));
  const QMargins margins = header_->layout()->contentsMargins();
  const int around = 2 * frame_width + margins.left() + margins.right() + 3 * first_row_->spacing();
  return around + badge_->sizeHint().width() + method + step_width + more_->sizeHint().width();
}

/// Where the window is narrow, the step stands before the gauge, and the ranking alone says the cost. Where
/// it is low, the cloth has the room of the lower rows.
void PaneView::suitSize() {
  const bool roomy = width() >= roomyWidth();
  if (roomy != is_roomy_) {
    (roomy ? second_row_ : first_row_)->removeWidget(step_);
    if (roomy)
      first_row_->insertWidget(first_row_->indexOf(method_) + 1, step_);
    else
      second_row_->insertWidget(0, step_);
    is_roomy_ = roomy;
  }
  const auto view_below = [this](int rows) { return height() - 2 * frame_width - headerHeight(rows); };
  const bool has_gauge = view_below(2) >= view_below_gauge;
  gauge_->setVisible(has_gauge);
  step_->setVisible(has_gauge || roomy);
  cost_->setVisible(has_gauge && roomy);
  difference_->setVisible(has_gauge && view_below(3) >= view_below_difference);
}

void PaneView::resizeEvent(QResizeEvent* event) {
  QFrame::resizeEvent(event);
  suitSize();
}

void PaneView::paintEvent(QPaintEvent*) {
  if (is_alone_) return;
  QPainter painter(this);
  painter.fillRect(rect(), theme().panel);
  painter.setPen(QPen(pane_colour(style_), frame_width));
  painter.drawRect(QRectF(rect()).adjusted(1, 1, -1, -1));
}

}  // namespace clothlab

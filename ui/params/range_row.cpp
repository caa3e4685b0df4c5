#include "params/range_row.h"

#include <QCheckBox>
#include <QHBoxLayout>
#include <QLabel>
#include <QSignalBlocker>
#include <QSpinBox>
#include <QToolButton>
#include <QVBoxLayout>

#include "params/exact_field.h"
#include "params/panel_parts.h"
#include "params/range_slider.h"
#include "theme/theme.h"
#include "widgets/building.h"
#include "widgets/numbers.h"

namespace clothlab {
namespace {

constexpr int cross_width = 24;                     // px
constexpr int field_least = 104, field_most = 136;  // px, as the exact field's above

}  // namespace

RangeRow::RangeRow(LabDocument& document, const cloth::Parameter& parameter, Place place, QWidget* parent)
    : QWidget(parent),
      document_(document),
      path_(parameter.path),
      unit_(parameter.info.unit),
      label_(QString::fromStdString(parameter.info.label)),
      scale_(parameter.info) {
  setObjectName("range:" + QString::fromStdString(path_));
  setAccessibleName(tr("%1: the range to vary it over").arg(label_));
  auto* column = spaced(new QVBoxLayout(this), spacing / 4);
  if (place == Place::form) makeSlider();
  makeFields(*column);
  if (place == Place::fit) count_->hide(), logarithmic_->hide();
  refresh();
}

void RangeRow::makeSlider() {
  slider_ = named("range", new RangeSlider(label_, this));
  slider_->setToolTip(tr("The range of a sweep: drag its ends"));
  connect(slider_, &RangeSlider::dragBegan, &document_, &LabDocument::beginDrag);
  connect(slider_, &RangeSlider::dragEnded, this, [this] {
    document_.endDrag();
    refresh();
  });
  const auto change = [this](RangeSlider::End end, auto value_of) {
    auto range = document_.varied().find(path_);
    if (!range) return;
    double& of = end == RangeSlider::End::from ? range->from : range->to;
    of = value_of(of);
    put(*range);
  };
  connect(slider_, &RangeSlider::moved, this, [this, change](RangeSlider::End end, double position) {
    change(end, [&](double) {
      const double value = scale_.value_at(position);
      // The left end of some logarithmic sliders is 0, which no equal ratio reaches.
      const auto range = document_.varied().find(path_);
      const bool ratios = range && range->scale == cloth::AxisScale::logarithmic;
      return value == 0 && ratios ? scale_.stepped(0, 1) : value;
    });
  });
  connect(slider_, &RangeSlider::stepped, this, [this, change](RangeSlider::End end, int steps) {
    change(end, [&](double value) { return scale_.stepped(value, steps); });
  });
}

void RangeRow::makeFields(QLayout& column) {
  const auto field = [this](const char* name, const QString& words) {
    auto* made = named(name, new ExactField(this));
    made->setUnit(unit_);
    made->setAccessibleName(tr("%1: %2").arg(label_, words));
    made->setToolTip(words);
    return made;
  };
  from_ = field("rangeFromField", tr("The smallest value"));
  to_ = field("rangeToField", tr("The largest value"));
  count_ = named("rangeCount", new QSpinBox(this));
  count_->setRange(2, VariedRanges::most_values);
  count_->setPrefix(QStringLiteral("× "));
  count_->setAccessibleName(tr("%1: number of values").arg(label_));
  count_->setToolTip(tr("How many values, both ends included"));
  count_->setFocusPolicy(Qt::StrongFocus);
  count_->setKeyboardTracking(false);
  logarithmic_ = named("rangeLog", new QCheckBox(tr("log"), this));
  logarithmic_->setAccessibleName(tr("%1: in equal ratios").arg(label_));
  logarithmic_->setToolTip(tr("In equal ratios instead of equal distances"));
  auto* cross = named("rangeRemove", new QToolButton(this));
  cross->setIcon(icon("remove"));
  cross->setIconSize({16, 16});
  cross->setFixedSize(cross_width, cross_width);
  cross->setAutoRaise(true);
  cross->setFocusPolicy(Qt::TabFocus);
  cross->setAccessibleName(tr("Do not vary %1").arg(label_));
  cross->setToolTip(cross->accessibleName());
  cross_ = cross;
  arrange(static_cast<QVBoxLayout&>(column));
  connectField(from_, &VariedRange::from);
  connectField(to_, &VariedRange::to);
  connect(count_, &QSpinBox::valueChanged, this, [this](int count) {
    if (auto range = document_.varied().find(path_)) range->count = count, put(*range);
  });
  connect(logarithmic_, &QCheckBox::clicked, this, [this](bool on) {
    auto range = document_.varied().find(path_);
    if (!range) return;
    range->scale = on ? cloth::AxisScale::logarithmic : cloth::AxisScale::linear;
    put(*range);
  });
  connect(cross, &QToolButton::clicked, this, [this] { document_.varied().remove(path_); });
}

/// In the form the handles move below that of the value, on the same scale, and the cross stands below the
/// button that resets it.
void RangeRow::arrange(QVBoxLayout& column) {
  auto* first = spaced(new QHBoxLayout, spacing);
  auto* second = spaced(new QHBoxLayout, spacing / 2);
  if (slider_) {
    count_->setMinimumWidth(field_least);
    count_->setMaximumWidth(field_most);
    first->addWidget(slider_, 5);
    first->addWidget(count_, 4);
  } else {
    auto* name = new ElidedLabel(label_, this);
    name->setToolTip(QString::fromStdString(path_));
    first->addWidget(name, 1);
    first->addWidget(count_);
  }
  auto* first_and_cross = spaced(new QHBoxLayout, spacing / 2);
  first_and_cross->addLayout(first, 1);
  first_and_cross->addWidget(cross_);
  second->addWidget(from_, 1);
  second->addWidget(muted(new QLabel(tr("to"), this)));
  second->addWidget(to_, 1);
  second->addWidget(logarithmic_);
  column.addLayout(first_and_cross);
  column.addLayout(second);
}

void RangeRow::connectField(ExactField* field, double VariedRange::*end) {
  connect(field, &ExactField::committed, this,
          [this, field, end](const QString& text) { typed(field, end, text); });
  connect(field, &ExactField::textEdited, this, [this] { Q_EMIT ruleBroken({}); });
  connect(field, &ExactField::abandoned, this, &RangeRow::refresh);
  connect(field, &ExactField::stepped, this, [this, end](int steps) {
    if (!stepping_) document_.beginDrag();
    stepping_ = true;
    if (auto range = document_.varied().find(path_))
      (*range).*end = scale_.stepped((*range).*end, steps), put(*range);
  });
  connect(field, &ExactField::stepsEnded, this, [this] {
    if (stepping_) document_.endDrag();
    stepping_ = false;
  });
}

void RangeRow::typed(ExactField* field, double VariedRange::*end, const QString& text) {
  auto range = document_.varied().find(path_);
  if (!range) return;
  const cloth::Quantity quantity = typed_quantity(text, unit_);
  (*range).*end = quantity.value;
  const QString rule = quantity.ok() ? document_.varied().set(*range) : QString::fromStdString(quantity.rule);
  if (!rule.isEmpty()) field->setInvalid(true);
  Q_EMIT ruleBroken(rule);
  if (rule.isEmpty()) refresh();
}

/// What a hand or a key does beyond a rule changes nothing.
void RangeRow::put(VariedRange range) {
  const QString rule = document_.varied().set(range);
  if (!rule.isEmpty()) refresh();
}

void RangeRow::refresh() {
  const auto range = document_.varied().find(path_);
  if (!range) return;
  if (!from_->hasPendingText()) from_->showValue(range->from);
  if (!to_->hasPendingText()) to_->showValue(range->to);
  const QSignalBlocker quiet(count_);
  count_->setValue(range->count);
  logarithmic_->setChecked(range->scale == cloth::AxisScale::logarithmic);
  if (!slider_) return;
  slider_->setPositions(scale_.position_of(range->from), scale_.position_of(range->to));
  const auto value = document_.value(path_);
  const double* number = value ? std::get_if<double>(&*value) : nullptr;
  const std::int64_t* whole = value ? std::get_if<std::int64_t>(&*value) : nullptr;
  slider_->setMark(number  ? scale_.position_of(*number)
                   : whole ? scale_.position_of(static_cast<double>(*whole))
                           : -1);
}

QList<QWidget*> RangeRow::tabStops() const {
  QList<QWidget*> stops;
  if (slider_) stops << slider_->handle(RangeSlider::End::from) << slider_->handle(RangeSlider::End::to);
  return stops << from_ << to_ << count_ << logarithmic_ << cross_;
}

void RangeRow::abandonEdits() {
  for (ExactField* field : {from_, to_}) {
    const QSignalBlocker quiet(field);
    field->abandonEdit();
  }
}

}  // namespace clothlab

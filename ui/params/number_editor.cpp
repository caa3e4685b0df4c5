#include <QCheckBox>
#include <QContextMenuEvent>
#include <QHBoxLayout>
#include <QMenu>
#include <QToolButton>
#include <QVBoxLayout>
#include <cmath>

#include "params/editors.h"
#include "params/exact_field.h"
#include "params/parameter_menu.h"
#include "params/range_row.h"
#include "params/value_slider.h"
#include "params/wording.h"
#include "widgets/numbers.h"

namespace clothlab {
namespace {

const cloth::ParameterValue auto_word = std::string("auto");

std::optional<double> as_number(const cloth::ParameterValue& value) {
  if (const double* number = std::get_if<double>(&value)) return *number;
  if (const std::int64_t* whole = std::get_if<std::int64_t>(&value)) return static_cast<double>(*whole);
  return std::nullopt;
}

}  // namespace

NumberEditor::NumberEditor(LabDocument& document, const cloth::Parameter& parameter, QWidget* parent)
    : ParameterEditor(document, parameter, parent),
      scale_(parameter.info),
      slider_(new ValueSlider(this)),
      field_(new ExactField(this)) {
  name(*slider_, "slider");
  name(*field_, "field", tr("exact value"));
  field_->setUnit(info().unit);
  field_->setMinimumWidth(104);
  field_->setMaximumWidth(136);
  controlRow().addWidget(slider_, 5);
  controlRow().addWidget(field_, 4);
  if (info().auto_allowed) makeAutoToggle();

  connectParts(
      slider_, field_, [this](double position) { commitNumber(scale_.value_at(position)); },
      [this](int steps) { step(steps); });
  connect(field_, &ExactField::committed, this, &NumberEditor::commitText);
  makeMenu();
  connect(&this->document().varied(), &VariedRanges::changed, this, &NumberEditor::followRange);
  followRange();
  refresh();
}

/// At the end of the title, above the button that resets the value.
void NumberEditor::makeMenu() {
  menu_ = make_parameter_menu(document(), parameter(), this);
  titleEnd().addWidget(menu_);
}

/// Without a title it stands beside the control.
void NumberEditor::hideTitle() {
  ParameterEditor::hideTitle();
  controlRow().addWidget(menu_);
}

void NumberEditor::contextMenuEvent(QContextMenuEvent* event) {
  const QPoint below = menu_->mapToGlobal(QPoint(0, menu_->height()));
  menu_->menu()->popup(event->reason() == QContextMenuEvent::Mouse ? event->globalPos() : below);
}

void NumberEditor::followRange() {
  const bool varied = document().varied().find(path()).has_value();
  if (varied && !range_) {
    range_ = new RangeRow(document(), parameter(), RangeRow::Place::form, this);
    static_cast<QVBoxLayout*>(layout())->insertWidget(2, range_);
    connect(range_, &RangeRow::ruleBroken, this, &NumberEditor::showMessage);
    range_->show();
  } else if (!varied && range_) {
    range_->abandonEdits();
    range_->hide();
    range_->deleteLater();
    range_ = nullptr;
  } else if (range_) {
    return range_->refresh();
  }
  Q_EMIT tabStopsChanged();
}

void NumberEditor::makeAutoToggle() {
  auto_ = new QCheckBox(tr("Auto"), this);
  name(*auto_, "auto", tr("automatic"));
  titleRow().addWidget(auto_);
  connect(auto_, &QCheckBox::clicked, this, &NumberEditor::commitAuto);
}

QList<QWidget*> NumberEditor::tabStops() const {
  QList<QWidget*> stops{slider_, field_, &resetButton()};
  if (auto_) stops.prepend(auto_);
  if (range_) stops << range_->tabStops();
  return stops;
}

void NumberEditor::abandonEdits() {
  if (range_) range_->abandonEdits();
  const QSignalBlocker quiet(field_);
  field_->abandonEdit();
}

void NumberEditor::showValue(const cloth::ParameterValue& value) {
  const auto number = as_number(value);
  if (auto_) auto_->setChecked(!number);
  slider_->setEnabled(number || auto_value_);
  if (!number) return showAuto();
  last_number_ = number;
  if (range_) range_->refresh();
  field_->showValue(*number);
  // During a drag, rounding the value must not move the handle.
  if (!slider_->isSliderDown()) slider_->setPosition(scale_.position_of(*number));
}

void NumberEditor::showAuto() {
  constexpr int digits = 3;
  field_->showNothing(auto_value_ ? quantity_text(*auto_value_, info().unit, digits) : tr("auto"));
  if (!slider_->isSliderDown()) slider_->setPosition(scale_.position_of(startingNumber()));
}

void NumberEditor::setAutoValue(std::optional<double> value) {
  auto_value_ = value;
  if (this->value() == auto_word && !field_->hasPendingText()) {
    slider_->setEnabled(value.has_value());
    showAuto();
  }
}

void NumberEditor::showDefault(const std::optional<cloth::ParameterValue>& fallback) {
  const auto number = fallback ? as_number(*fallback) : std::nullopt;
  slider_->setMark(number ? scale_.position_of(*number) : -1);
}

void NumberEditor::markInvalid(bool invalid) {
  field_->setInvalid(invalid);
}

double NumberEditor::startingNumber() const {
  if (auto_value_) return *auto_value_;
  return last_number_ ? *last_number_ : scale_.value_at(0.5);
}

void NumberEditor::commitAuto(bool on) {
  if (on)
    commit(auto_word);
  else
    commitNumber(startingNumber());
}

void NumberEditor::commitText(const QString& text) {
  if (info().auto_allowed && text.trimmed().compare("auto", Qt::CaseInsensitive) == 0) {
    commit(auto_word);
    return;
  }
  const cloth::Quantity typed = typed_quantity(text, info().unit);
  if (typed.ok()) return commitNumber(typed.value);
  if (info().auto_allowed && text.trimmed().isEmpty()) return refresh();
  showRule(QString::fromStdString(typed.rule));
}

void NumberEditor::commitNumber(double number) {
  if (info().kind == cloth::Kind::number) {
    commit(number);
    return;
  }
  // The range first, so that the number fits its type.
  constexpr double exactly_whole = 9007199254740992.0;  // 2^53
  if (const auto rule = broken_rule(info(), number)) return showRule(QString::fromStdString(*rule));
  if (number != std::round(number) || std::abs(number) > exactly_whole)
    return showRule(tr("must be a whole number"));
  commit(static_cast<std::int64_t>(number));
}

void NumberEditor::step(int steps) {
  const auto present = value();
  if (!present) return;
  const auto number = as_number(*present);
  commitNumber(scale_.stepped(number ? *number : startingNumber(), steps));
}

}  // namespace clothlab

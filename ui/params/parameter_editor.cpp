#include "params/parameter_editor.h"

#include <QHBoxLayout>
#include <QLabel>
#include <QToolButton>
#include <QVBoxLayout>
#include <algorithm>
#include <utility>

#include "params/doubt.h"
#include "params/editors.h"
#include "params/exact_field.h"
#include "params/message_bubble.h"
#include "params/panel_parts.h"
#include "params/value_slider.h"
#include "params/wording.h"
#include "theme/theme.h"
#include "widgets/building.h"

namespace clothlab {
namespace {

constexpr int reset_width = 24;  // px

/// As the first letter of a sentence.
QString capitalised(QString text) {
  if (!text.isEmpty()) text[0] = text[0].toUpper();
  return text;
}

}  // namespace

ParameterEditor::ParameterEditor(LabDocument& document, cloth::Parameter parameter, QWidget* parent)
    : QWidget(parent), document_(document), parameter_(std::move(parameter)) {
  setObjectName("param:" + QString::fromStdString(parameter_.path));
  setAccessibleName(QString::fromStdString(info().label));
  auto* column = spaced(new QVBoxLayout(this), spacing / 4);
  makeTitle(*column);
  control_row_ = spaced(new QHBoxLayout, spacing);
  makeReset();
  auto* control_and_reset = spaced(new QHBoxLayout, spacing / 2);
  control_and_reset->addLayout(control_row_, 1);
  control_and_reset->addWidget(reset_, 0, Qt::AlignVCenter);
  column->addLayout(control_and_reset);
  makeNote(*column);
  message_ = new MessageBubble(*this, *control_row_);
  message_->setFont(smaller(message_->font()));
}

ParameterEditor::~ParameterEditor() {
  delete message_;
}

void ParameterEditor::makeTitle(QVBoxLayout& column) {
  title_ = new QWidget(this);
  title_row_ = spaced(new QHBoxLayout(title_), spacing);
  label_ = new ElidedLabel(QString::fromStdString(info().label), title_);
  title_row_->addWidget(label_);
  doubt_ = named("doubt", new QLabel(QStringLiteral("⚠"), title_));
  doubt_->setProperty("state", "warning");
  doubt_->hide();
  title_row_->addWidget(doubt_);
  if (info().cost == cloth::EditCost::restart) {
    auto* mark = named("restarts", new QLabel(tr("restarts"), title_));
    mark->setProperty("muted", true);
    mark->setFont(smaller(mark->font()));
    mark->setToolTip(tr("An edit restarts the simulation"));
    title_row_->addWidget(mark);
  }
  title_row_->addStretch(1);
  if (info().kind == cloth::Kind::vector && !info().unit.empty()) {
    auto* unit = new QLabel(unit_text(info().unit), title_);
    unit->setProperty("muted", true);
    title_row_->addWidget(unit);
  }
  auto* to_end_of_control = spaced(new QHBoxLayout, spacing / 2);
  to_end_of_control->addWidget(title_, 1);
  auto* end = new QWidget(this);
  end->setFixedWidth(reset_width);
  title_end_ = spaced(new QHBoxLayout(end), 0);
  to_end_of_control->addWidget(end);
  column.addLayout(to_end_of_control);
}

void ParameterEditor::makeReset() {
  reset_ = named("reset", new QToolButton(this));
  reset_->setIcon(icon("reset-value"));
  reset_->setIconSize({16, 16});
  reset_->setFixedSize(reset_width, reset_width);
  reset_->setFocusPolicy(Qt::TabFocus);
  reset_->setAccessibleName(tr("Reset %1").arg(QString::fromStdString(info().label)));
  QSizePolicy keep_room = reset_->sizePolicy();
  keep_room.setRetainSizeWhenHidden(true);  // controls do not move when it comes and goes
  reset_->setSizePolicy(keep_room);
  connect(reset_, &QToolButton::clicked, this, [this] {
    if (reset_->hasFocus()) tabStops().first()->setFocus(Qt::OtherFocusReason);
    document_.resetParameter(path());
    refresh();
  });
}

void ParameterEditor::makeNote(QVBoxLayout& column) {
  note_ = named("note", new QLabel(this));
  note_->setProperty("muted", true);
  note_->setWordWrap(true);
  note_->setTextFormat(Qt::PlainText);
  note_->setFont(smaller(note_->font()));
  note_->hide();
  note_button_ = new QToolButton(this);
  name(*note_button_, "noteButton", tr("note"));
  note_button_->setFont(note_->font());
  note_button_->setFocusPolicy(Qt::TabFocus);
  note_button_->hide();
  connect(note_button_, &QToolButton::clicked, this, &ParameterEditor::noteButtonClicked);
  auto* note_row = spaced(new QHBoxLayout, spacing);
  note_row->addWidget(note_, 1);
  note_row->addWidget(note_button_);
  column.addLayout(note_row);
}

void ParameterEditor::name(QWidget& part, const QString& object_name, const QString& suffix) {
  const QString label = QString::fromStdString(info().label);
  part.setObjectName(object_name);
  part.setAccessibleName(suffix.isEmpty() ? label : label + ' ' + suffix);
  part.setAccessibleDescription(QString::fromStdString(info().doc));
  named_ << &part;
}

bool ParameterEditor::matches(const QStringList& words) const {
  const QString text = QString::fromStdString(info().label + '\n' + path() + '\n' + info().doc);
  return std::all_of(words.begin(), words.end(),
                     [&](const QString& word) { return text.contains(word, Qt::CaseInsensitive); });
}

void ParameterEditor::refresh() {
  const auto present = value();
  if (!present) return;
  showRule({});
  showValue(*present);
  markDoubt(*present);
  refreshDefault();
}

void ParameterEditor::refreshDefault() {
  const auto present = value();
  const auto fallback = cloth::default_of(document_.scene(), path());
  reset_->setVisible(fallback && present && *present != *fallback);
  if (fallback == default_ && !label_->toolTip().isEmpty()) return;
  default_ = fallback;
  const QString tooltip = tooltip_of(parameter_, default_);
  label_->setToolTip(tooltip);
  for (QWidget* part : named_) part->setToolTip(tooltip);
  if (default_) reset_->setToolTip(tr("Back to %1").arg(value_in_words(info(), *default_)));
  showDefault(default_);
}

bool ParameterEditor::commit(const cloth::ParameterValue& value) {
  const QString rule = document_.setParameter(path(), value);
  if (!rule.isEmpty()) {
    showRule(rule);
    return false;
  }
  refresh();
  if (!doubt_->isHidden()) message_->say(MessageBubble::Level::warning, doubt_->toolTip());
  return true;
}

void ParameterEditor::markDoubt(const cloth::ParameterValue& value) {
  const auto doubt = cloth::doubt_about(info(), value);
  doubt_->setVisible(doubt.has_value());
  if (doubt)
    doubt_->setToolTip(
        QStringLiteral("%1: %2.").arg(value_in_words(info(), value), QString::fromStdString(*doubt)));
}

void ParameterEditor::showRule(const QString& rule) {
  markInvalid(!rule.isEmpty());
  if (rule.isEmpty()) return message_->withdraw();
  const QString sentence = capitalised(typographic(rule));
  const auto kept = value();
  message_->say(MessageBubble::Level::error,
                kept ? tr("%1. Still %2.").arg(sentence, value_in_words(info(), *kept)) : sentence);
}

void ParameterEditor::showMessage(const QString& rule) {
  if (rule.isEmpty()) return message_->withdraw();
  message_->say(MessageBubble::Level::error, capitalised(typographic(rule)) + '.');
}

void ParameterEditor::setNote(const QString& note, const QString& button) {
  note_->setText(note);
  note_->setVisible(!note.isEmpty());
  note_button_->setText(button);
  note_button_->setAccessibleName(QStringLiteral("%1: %2").arg(QString::fromStdString(info().label), button));
  note_button_->setVisible(!button.isEmpty());
}

void ParameterEditor::connectParts(ValueSlider* slider, ExactField* field, std::function<void(double)> move,
                                   std::function<void(int)> step) {
  connect(slider, &ValueSlider::dragBegan, &document_, &LabDocument::beginDrag);
  connect(slider, &ValueSlider::moved, this, std::move(move));
  connect(slider, &ValueSlider::stepped, this, step);
  connect(slider, &ValueSlider::dragEnded, this, [this] {
    document_.endDrag();
    refresh();
  });
  connect(field, &ExactField::stepped, this, [this, step](int steps) {
    if (!stepping_) document_.beginDrag();
    stepping_ = true;
    step(steps);
  });
  connect(field, &ExactField::stepsEnded, this, [this] {
    if (stepping_) document_.endDrag();
    stepping_ = false;
  });
  connect(field, &ExactField::textEdited, this, [this] { showRule({}); });
  connect(field, &ExactField::abandoned, this, &ParameterEditor::refresh);
}

ParameterEditor* make_editor(LabDocument& document, const cloth::Parameter& parameter, QWidget* parent) {
  switch (parameter.info.kind) {
    case cloth::Kind::number:
    case cloth::Kind::integer:
      return new NumberEditor(document, parameter, parent);
    case cloth::Kind::vector:
      return new VectorEditor(document, parameter, parent);
    case cloth::Kind::choice:
    case cloth::Kind::words:
      return new ChoiceEditor(document, parameter, parent);
    case cloth::Kind::text:
      if (names_mesh(parameter)) return new MeshEditor(document, parameter, parent);
      return new TextEditor(document, parameter, parent);
  }
  return nullptr;
}

}  // namespace clothlab

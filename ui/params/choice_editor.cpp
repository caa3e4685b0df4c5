#include <QAbstractItemView>
#include <QHBoxLayout>
#include <QToolButton>
#include <algorithm>

#include "params/editors.h"
#include "params/panel_parts.h"
#include "params/wording.h"

namespace clothlab {

ChoiceEditor::ChoiceEditor(LabDocument& document, const cloth::Parameter& parameter, QWidget* parent)
    : ParameterEditor(document, parameter, parent), combo_(new QuietCombo(this)) {
  name(*combo_, "combo");
  combo_->view()->setAccessibleName(combo_->accessibleName());
  controlRow().addWidget(combo_, 1);
  for (const std::string& word : info().choices) {
    values_.emplace_back(word);
    combo_->addItem(choice_text(word), QString::fromStdString(word));
  }
  for (const cloth::Words& words : info().word_sets) {
    values_.emplace_back(words);
    combo_->addItem(words_text(words));
  }
  connect(combo_, &QComboBox::activated, this,
          [this](int index) { commit(values_.at(static_cast<std::size_t>(index))); });
  refresh();
}

QList<QWidget*> ChoiceEditor::tabStops() const {
  return {combo_, &resetButton()};
}

void ChoiceEditor::showValue(const cloth::ParameterValue& value) {
  const auto found = std::find(values_.begin(), values_.end(), value);
  combo_->setCurrentIndex(found == values_.end() ? -1 : static_cast<int>(found - values_.begin()));
}

}  // namespace clothlab

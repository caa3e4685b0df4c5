#include "studies/axis_choice.h"

#include <QCheckBox>
#include <QGridLayout>
#include <QLabel>
#include <QLineEdit>
#include <QScopedValueRollback>
#include <QSignalBlocker>
#include <QSpinBox>
#include <algorithm>
#include <limits>
#include <utility>

#include "params/panel_parts.h"
#include "params/wording.h"
#include "scene/scene_cloth.h"
#include "scene/scene_parameters.h"
#include "study/stability_map.h"
#include "theme/theme.h"
#include "widgets/building.h"
#include "widgets/numbers.h"

namespace clothlab {
namespace {

constexpr int usual_count = 12;
constexpr int digits = 3;

double number_of(const QLineEdit& field, const std::string& unit) {
  const cloth::Quantity typed = typed_quantity(field.text(), unit);
  return typed.ok() ? typed.value : std::numeric_limits<double>::quiet_NaN();
}

/// Around the scene's own value: the form's slider range.
cloth::StudyAxis offer_of(const cloth::Parameter& parameter) {
  const cloth::ParameterInfo& info = parameter.info;
  const bool logarithmic = info.scale == cloth::Scale::logarithmic && info.slider_minimum > 0;
  return {.path = parameter.path,
          .low = info.slider_minimum,
          .high = info.slider_maximum,
          .count = usual_count,
          .scale = logarithmic ? cloth::AxisScale::logarithmic : cloth::AxisScale::linear};
}

}  // namespace

AxisChoice::AxisChoice(QWidget* parent) : QWidget(parent) {
  parameter_ = named("parameter", new QuietCombo(this));
  parameter_->setToolTip(tr("The parameter. Choose it again for the range that suits the scene."));
  low_ = named("low", new QLineEdit(this));
  low_->setToolTip(tr("The smallest value"));
  high_ = named("high", new QLineEdit(this));
  high_->setToolTip(tr("The largest value"));
  count_ = named("count", new QSpinBox(this));
  count_->setRange(2, 200);
  count_->setToolTip(tr("How many values"));
  logarithmic_ = named("logarithmic", new QCheckBox(tr("log"), this));
  logarithmic_->setToolTip(tr("In equal ratios"));
  auto* grid = spaced(new QGridLayout(this), spacing / 2);
  grid->addWidget(parameter_, 0, 0, 1, 3);
  grid->addWidget(low_, 1, 0);
  grid->addWidget(new QLabel(tr("to"), this), 1, 1);
  grid->addWidget(high_, 1, 2);
  grid->addWidget(count_, 2, 0);
  grid->addWidget(logarithmic_, 2, 2);
  grid->setColumnStretch(0, 1);
  grid->setColumnStretch(2, 1);
  connect(parameter_, &QComboBox::activated, this, &AxisChoice::chooseParameter);
  connect(low_, &QLineEdit::textChanged, this, [this] { note(&Own::range); });
  connect(high_, &QLineEdit::textChanged, this, [this] { note(&Own::range); });
  connect(count_, &QSpinBox::valueChanged, this, [this] { note(&Own::count); });
  connect(logarithmic_, &QCheckBox::toggled, this, [this] { note(&Own::scale); });
}

std::vector<AxisChoice::Offer> AxisChoice::offersOf(const cloth::Scene& scene, const cloth::StudyAxis& axis) {
  std::vector<Offer> offers;
  const auto offer = [&](const QString& name, const std::string& unit, cloth::StudyAxis offered) {
    if (offered.path == axis.path) offered = axis;
    offers.push_back(
        {unit.empty() ? name : QString("%1 (%2)").arg(name, unit_text(unit)), std::move(offered), unit});
  };
  if (cloth::has_stiffness(scene)) offer(tr("All stiffnesses"), "N/m", cloth::default_stiffness_axis(scene));
  for (const cloth::Block& block : cloth::blocks_of(scene))
    for (const cloth::Parameter& parameter : block.parameters) {
      const cloth::ParameterInfo& info = parameter.info;
      if (info.kind != cloth::Kind::number && info.kind != cloth::Kind::integer) continue;
      if (!(info.slider_maximum > info.slider_minimum)) continue;
      offer(QString::fromStdString(block.title + ": " + info.label), info.unit, offer_of(parameter));
    }
  return offers;
}

void AxisChoice::setScene(const cloth::Scene& scene, const cloth::StudyAxis& axis) {
  std::vector<Offer> offers = offersOf(scene, axis);
  const int present = parameter_->currentIndex();
  const bool chosen = own_.parameter && present >= 0;
  const std::string path = chosen ? offers_[static_cast<std::size_t>(present)].axis.path : axis.path;
  auto shown = std::find_if(offers.begin(), offers.end(),
                            [&](const Offer& offered) { return offered.axis.path == path; });
  if (shown == offers.end() &&
      chosen) {  // its block is gone: the choice stays, and a start says what is wrong
    offers.push_back(offers_[static_cast<std::size_t>(present)]);
    const QString mark = tr(" (not in this scene)");
    if (!offers.back().name.endsWith(mark)) offers.back().name += mark;
    shown = std::prev(offers.end());
  } else if (shown == offers.end()) {
    shown = offers.begin();
  }
  if (shown == offers.end()) return;
  const std::size_t index = static_cast<std::size_t>(shown - offers.begin());
  offer(std::move(offers), index);
  suggest(offers_[index].axis);
  Q_EMIT changed();
}

void AxisChoice::offer(std::vector<Offer> offers, std::size_t shown) {
  const QSignalBlocker quiet(parameter_);
  const bool same = std::equal(offers.begin(), offers.end(), offers_.begin(), offers_.end(),
                               [](const Offer& a, const Offer& b) { return a.name == b.name; });
  offers_ = std::move(offers);
  if (!same) {  // else a list that is open stays as it is
    parameter_->clear();
    for (const Offer& offered : offers_) {
      parameter_->addItem(offered.name);
      parameter_->setItemData(parameter_->count() - 1, QString::fromStdString(offered.axis.path),
                              Qt::ToolTipRole);
    }
  }
  parameter_->setCurrentIndex(static_cast<int>(shown));
}

void AxisChoice::suggest(const cloth::StudyAxis& axis) {
  const QScopedValueRollback suggesting(suggesting_, true);
  if (!own_.range) {
    low_->setText(number_text(axis.low, digits));
    low_->setCursorPosition(0);
    high_->setText(number_text(axis.high, digits));
    high_->setCursorPosition(0);
  }
  if (!own_.count) count_->setValue(axis.count);
  if (!own_.scale) logarithmic_->setChecked(axis.scale == cloth::AxisScale::logarithmic);
}

void AxisChoice::chooseParameter(int index) {
  own_ = {.parameter = true};
  suggest(offers_[static_cast<std::size_t>(index)].axis);
  Q_EMIT changed();
}

void AxisChoice::note(bool Own::*set) {
  if (suggesting_) return;
  own_.*set = true;
  Q_EMIT changed();
}

void AxisChoice::keep() {
  own_ = {.parameter = true, .range = true, .count = true, .scale = true};
}

cloth::StudyAxis AxisChoice::axis() const {
  const int index = parameter_->currentIndex();
  const Offer offer = index < 0 ? Offer{} : offers_[static_cast<std::size_t>(index)];
  return {.path = offer.axis.path,
          .low = number_of(*low_, offer.unit),
          .high = number_of(*high_, offer.unit),
          .count = count_->value(),
          .scale = logarithmic_->isChecked() ? cloth::AxisScale::logarithmic : cloth::AxisScale::linear};
}

}  // namespace clothlab

#include <QCheckBox>
#include <QComboBox>
#include <QGridLayout>
#include <QLabel>
#include <QLineEdit>
#include <QLocale>
#include <QSpinBox>
#include <limits>

#include "report/svg.h"
#include "scene/scene_parameters.h"
#include "studies/study_choices.h"
#include "study/stability_map.h"
#include "theme/theme.h"
#include "widgets/building.h"

namespace clothlab {
namespace {

constexpr int usual_count = 12;
constexpr int count_width = 54;  // px

QString number_text(double value) {
  return QString::fromStdString(cloth::short_number(value, 3));
}

double number_of(const QLineEdit& field) {
  bool ok = false;
  const double value = QLocale::c().toDouble(field.text().trimmed(), &ok);
  return ok ? value : std::numeric_limits<double>::quiet_NaN();
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
  parameter_ = named("parameter", new QComboBox(this));
  parameter_->setSizeAdjustPolicy(QComboBox::AdjustToMinimumContentsLengthWithIcon);
  parameter_->setMinimumContentsLength(12);
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
  grid->addWidget(parameter_, 0, 0, 1, 5);
  count_->setFixedWidth(count_width);
  grid->addWidget(low_, 1, 0);
  grid->addWidget(new QLabel(tr("to"), this), 1, 1);
  grid->addWidget(high_, 1, 2);
  grid->addWidget(count_, 1, 3);
  grid->addWidget(logarithmic_, 1, 4);
  connect(parameter_, &QComboBox::activated, this, &AxisChoice::chooseParameter);
}

void AxisChoice::setScene(const cloth::Scene& scene, const cloth::StudyAxis& axis) {
  parameter_->clear();
  offers_.clear();
  const auto offer = [&](const QString& name, cloth::StudyAxis offered) {
    if (offered.path == axis.path) offered = axis;
    parameter_->addItem(name);
    offers_.push_back(std::move(offered));
    if (offers_.back().path == axis.path) parameter_->setCurrentIndex(parameter_->count() - 1);
  };
  if (scene.springs) offer(tr("All stiffnesses (N/m)"), cloth::default_stiffness_axis(scene));
  for (const cloth::Block& block : cloth::blocks_of(scene))
    for (const cloth::Parameter& parameter : block.parameters) {
      const cloth::ParameterInfo& info = parameter.info;
      if (info.kind != cloth::Kind::number && info.kind != cloth::Kind::integer) continue;
      if (!(info.slider_maximum > info.slider_minimum)) continue;
      const QString unit = info.unit.empty() ? "" : QString(" (%1)").arg(QString::fromStdString(info.unit));
      offer(QString::fromStdString(block.title + ": " + info.label) + unit, offer_of(parameter));
      parameter_->setItemData(parameter_->count() - 1, QString::fromStdString(parameter.path),
                              Qt::ToolTipRole);
    }
  show(axis);
}

void AxisChoice::show(const cloth::StudyAxis& axis) {
  low_->setText(number_text(axis.low));
  low_->setCursorPosition(0);
  high_->setText(number_text(axis.high));
  count_->setValue(axis.count);
  logarithmic_->setChecked(axis.scale == cloth::AxisScale::logarithmic);
}

cloth::StudyAxis AxisChoice::axis() const {
  const int index = parameter_->currentIndex();
  return {.path = index < 0 ? std::string() : offers_[static_cast<std::size_t>(index)].path,
          .low = number_of(*low_),
          .high = number_of(*high_),
          .count = count_->value(),
          .scale = logarithmic_->isChecked() ? cloth::AxisScale::logarithmic : cloth::AxisScale::linear};
}

}  // namespace clothlab

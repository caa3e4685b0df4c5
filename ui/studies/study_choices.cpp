#include "studies/study_choices.h"

#include <QCheckBox>
#include <QComboBox>
#include <QFormLayout>
#include <QGridLayout>
#include <QLabel>
#include <QLineEdit>
#include <QListWidget>
#include <QLocale>
#include <QSpinBox>
#include <QStackedWidget>
#include <QVBoxLayout>
#include <algorithm>
#include <cmath>
#include <limits>

#include "integrators/registry.h"
#include "report/svg.h"
#include "scene/scene_parameters.h"
#include "studies/study_library.h"
#include "study/stability_map.h"
#include "study/stability_report.h"
#include "theme/theme.h"
#include "widgets/building.h"

namespace clothlab {
namespace {

constexpr int method_rows = 5, method_height = 22, method_width = 152;  // px
const char* const made_by = "the Studies window of clothlab";

QString purpose_of(StudyChoices::Kind kind) {
  switch (kind) {
    case StudyChoices::Kind::work_precision:
      return QObject::tr(
          "Which method reaches an error in the least time? Every method over a series of "
          "steps, against a reference far more exact.");
    case StudyChoices::Kind::stability:
      return QObject::tr(
          "Which steps can a method take, and does theory know? A run for each cell of a map "
          "over two parameters, with the predicted limits over it.");
    case StudyChoices::Kind::extremes:
      return QObject::tr(
          "What breaks which method? Every method on cases pushed far: stiffness, steps, "
          "masses, damping, wind, limits.");
  }
  return {};
}

QFormLayout* form_on(QWidget* page) {
  auto* form = spaced(new QFormLayout(page), spacing / 2);
  form->setRowWrapPolicy(QFormLayout::WrapLongRows);
  return form;
}

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

StudyChoices::StudyChoices(QWidget* parent) : QWidget(parent) {
  kind_ = named("studyKind", new QComboBox(this));
  kind_->addItems({tr("Work-precision"), tr("Stability map"), tr("Extreme cases")});
  purpose_ = new QLabel(this);
  purpose_->setWordWrap(true);
  purpose_->setProperty("muted", true);
  methods_ = named("studyMethods", new QListWidget(this));
  methods_->setWrapping(true);
  methods_->setFlow(QListView::TopToBottom);
  methods_->setResizeMode(QListView::Adjust);
  methods_->setGridSize({method_width, method_height});
  methods_->setFixedHeight(method_rows * method_height + spacing);
  methods_->setHorizontalScrollBarPolicy(Qt::ScrollBarAlwaysOff);
  methods_->setAccessibleName(tr("Methods"));
  for (const cloth::MethodFacts& facts : cloth::integrator_facts()) {
    auto* item = new QListWidgetItem(QString::fromStdString(facts.title), methods_);
    item->setData(Qt::UserRole, QString::fromStdString(facts.name));
    item->setFlags(Qt::ItemIsEnabled | Qt::ItemIsUserCheckable | Qt::ItemIsSelectable);
    item->setCheckState(Qt::Checked);
  }
  makeForms();
  folder_ = named("studyFolder", new QLineEdit(this));
  folder_->setToolTip(tr("The results' folder; empty: a new one under %1").arg(shown_path(studies_folder())));
  folder_->setPlaceholderText(tr("a new one in %1").arg(shown_path(studies_folder())));

  auto* column = spaced(new QVBoxLayout(this), spacing / 2);
  column->addWidget(kind_);
  column->addWidget(purpose_);
  column->addWidget(methods_);
  column->addWidget(forms_);
  auto* folder = new QWidget(this);
  form_on(folder)->addRow(tr("Folder"), folder_);
  column->addWidget(folder);
  column->addStretch();
  connect(kind_, &QComboBox::currentIndexChanged, this, &StudyChoices::follow);
  follow();
}

void StudyChoices::makeForms() {
  forms_ = new QStackedWidget(this);
  auto* precision = new QWidget(forms_);
  QFormLayout* form = form_on(precision);
  horizon_ = named("horizon", new QLineEdit(precision));
  form->addRow(tr("Horizon (s)"), horizon_);
  repeats_ = named("repeats", new QSpinBox(precision));
  repeats_->setRange(5, 100);
  repeats_->setToolTip(tr("How often each run is timed"));
  form->addRow(tr("Repeats"), repeats_);
  forms_->addWidget(precision);

  auto* map = new QWidget(forms_);
  form = form_on(map);
  form->setRowWrapPolicy(QFormLayout::DontWrapRows);
  x_ = named("xAxis", new AxisChoice(map));
  form->addRow(tr("Across"), x_);
  y_ = named("yAxis", new AxisChoice(map));
  form->addRow(tr("Up"), y_);
  periods_ = named("periods", new QSpinBox(map));
  periods_->setRange(1, 100000);
  periods_->setValue(static_cast<int>(cloth::StabilityCriterion{}.periods));
  periods_->setToolTip(tr("How long a run lasts, in periods of the fastest motion"));
  form->addRow(tr("Periods"), periods_);
  forms_->addWidget(map);

  auto* extremes = new QWidget(forms_);
  form = form_on(extremes);
  cases_ = named("cases", new QComboBox(extremes));
  cases_->addItems({tr("This scene, pushed"), tr("The fixed list")});
  form->addRow(tr("Cases"), cases_);
  forms_->addWidget(extremes);
}

StudyChoices::Kind StudyChoices::kind() const {
  return static_cast<Kind>(kind_->currentIndex());
}

void StudyChoices::setKind(Kind kind) {
  kind_->setCurrentIndex(static_cast<int>(kind));
}

void StudyChoices::follow() {
  purpose_->setText(purpose_of(kind()));
  forms_->setCurrentIndex(static_cast<int>(kind()));
  for (int k = 0; k < forms_->count(); ++k)  // no taller than the form that is seen
    forms_->widget(k)->setSizePolicy(
        QSizePolicy::Preferred, k == forms_->currentIndex() ? QSizePolicy::Preferred : QSizePolicy::Ignored);
  forms_->adjustSize();
  checkMethods(kind() == Kind::stability ? cloth::methods_with_a_limit() : cloth::integrator_names());
}

void StudyChoices::checkMethods(const std::vector<std::string>& names) {
  for (int row = 0; row < methods_->count(); ++row) {
    const std::string name = methods_->item(row)->data(Qt::UserRole).toString().toStdString();
    const bool on = std::find(names.begin(), names.end(), name) != names.end();
    methods_->item(row)->setCheckState(on ? Qt::Checked : Qt::Unchecked);
  }
}

void StudyChoices::setScene(const cloth::Scene& scene) {
  scene_ = scene;
  horizon_->setPlaceholderText(
      QLocale::c().toString(cloth::default_horizon(cloth::studied_scene(scene)), 'g', 4));
  x_->setScene(scene, cloth::default_time_axis(scene, cloth::methods_with_a_limit()));
  y_->setScene(scene, cloth::default_stiffness_axis(scene));
}

std::vector<std::string> StudyChoices::methods() const {
  std::vector<std::string> names;
  for (int row = 0; row < methods_->count(); ++row)
    if (methods_->item(row)->checkState() == Qt::Checked)
      names.push_back(methods_->item(row)->data(Qt::UserRole).toString().toStdString());
  return names;
}

std::variant<StudyOrder, QString> StudyChoices::stabilityOrder() const {
  cloth::StabilityOptions options{.methods = methods()};
  options.criterion.periods = periods_->value();
  for (const auto& [choice, axis, name] :
       {std::tuple{x_, &options.x, "across"}, std::tuple{y_, &options.y, "up"}}) {
    *axis = choice->axis();
    const auto checked = cloth::parse_axis(cloth::axis_text(*axis), name);
    if (const auto* problem = std::get_if<cloth::Problem>(&checked))
      return QString::fromStdString(problem->text());
  }
  const auto problems = cloth::find_problems(scene_, options);
  if (!problems.empty()) return QString::fromStdString(problems.front().text());
  return StudyOrder{scene_, options, {}, made_by};
}

std::variant<StudyOrder, QString> StudyChoices::order() const {
  if (methods().empty()) return tr("Choose at least one method.");
  std::variant<StudyOrder, QString> result;
  if (kind() == Kind::stability) {
    result = stabilityOrder();
  } else if (kind() == Kind::extremes) {
    cloth::ExtremesOptions options{.methods = methods()};
    if (cases_->currentIndex() == 0) options.scene = scene_;
    result = StudyOrder{scene_, options, {}, made_by};
  } else {
    cloth::WorkPrecisionOptions options;
    options.methods = methods();
    options.repeats = repeats_->value();
    if (const QString text = horizon_->text().trimmed(); !text.isEmpty()) {
      bool ok = false;
      options.horizon = QLocale::c().toDouble(text, &ok);
      if (!ok || !(*options.horizon > 0) || !std::isfinite(*options.horizon))
        return tr("Horizon: \"%1\" must be a time in s, more than 0.").arg(text);
    }
    result = StudyOrder{scene_, options, {}, made_by};
  }
  if (auto* order = std::get_if<StudyOrder>(&result)) {
    const QString folder = path_from(folder_->text().trimmed());
    order->folder =
        (folder.isEmpty() ? new_study_folder(kind_->currentText(), QString::fromStdString(scene_.title))
                          : folder)
            .toStdString();
  }
  return result;
}

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

#include "studies/study_choices.h"

#include <QComboBox>
#include <QFormLayout>
#include <QLabel>
#include <QLineEdit>
#include <QListWidget>
#include <QScopedValueRollback>
#include <QSpacerItem>
#include <QSpinBox>
#include <algorithm>

#include "integrators/registry.h"
#include "params/wording.h"
#include "studies/axis_choice.h"
#include "studies/fit_choices.h"
#include "studies/outputs_choice.h"
#include "studies/study_library.h"
#include "studies/sweep_choices.h"
#include "study/refined_scene.h"
#include "study/stability_map.h"
#include "study/stability_report.h"
#include "study/validation/validation.h"
#include "theme/theme.h"
#include "widgets/building.h"
#include "widgets/numbers.h"

namespace clothlab {
namespace {

constexpr int method_rows = 6, protocol_rows = 6, method_height = 22, method_width = 164;  // px

QString purpose_of(StudyChoices::Kind kind) {
  switch (kind) {
    case StudyChoices::Kind::sweep:
      return QObject::tr(
          "How does a value depend on parameters? A run for each combination of their values, on all cores; "
          "it goes on where it was stopped.");
    case StudyChoices::Kind::fit:
      return QObject::tr(
          "Which values make the scene do what was measured, and how sure are they? Runs of the scene come "
          "closer and closer to a measured curve.");
    case StudyChoices::Kind::work_precision:
      return QObject::tr(
          "Which method reaches an error in the least time? Every method over a series of "
          "steps, against a reference far more exact.");
    case StudyChoices::Kind::iterations:
      return QObject::tr(
          "How far do the iterations of a solver come? One implicit Euler step of the scene, solved with "
          "more "
          "and more of them: what is left of its objective, against iterations and against time.");
    case StudyChoices::Kind::stability:
      return QObject::tr(
          "Which steps can a method take, and does theory know? A run for each cell of a map "
          "over two parameters, with the predicted limits over it.");
    case StudyChoices::Kind::extremes:
      return QObject::tr(
          "What breaks which method? Every method on cases pushed far: stiffness, steps, "
          "masses, damping, wind, limits.");
    case StudyChoices::Kind::convergence:
      return QObject::tr(
          "Is a value one of the cloth or of its grid? The scene on finer and finer grids, with "
          "the order, the limit and the error of what is read off.");
    case StudyChoices::Kind::validation:
      return QObject::tr(
          "Is a material the cloth that its numbers say? Strips of a material on four grids against exact "
          "curves, loads and forces of laboratory tests.");
  }
  return {};
}

QString cells_text(const std::vector<int>& cells) {
  QStringList texts;
  for (const int count : cells) texts << QString::number(count);
  return texts.join(", ");
}

/// Boxes to check, all of them checked, in columns.
QListWidget* boxes(const char* name, const QString& accessible, int rows, QWidget* parent) {
  auto* list = named(name, new QListWidget(parent));
  list->setWrapping(true);
  list->setFlow(QListView::TopToBottom);
  list->setResizeMode(QListView::Adjust);
  list->setGridSize({method_width, method_height});
  list->setFixedHeight(rows * method_height + spacing);
  list->setHorizontalScrollBarPolicy(Qt::ScrollBarAlwaysOff);
  list->setAccessibleName(accessible);
  return list;
}

void add_box(QListWidget* list, const std::string& title, const std::string& name) {
  auto* item = new QListWidgetItem(QString::fromStdString(title), list);
  item->setData(Qt::UserRole, QString::fromStdString(name));
  item->setFlags(Qt::ItemIsEnabled | Qt::ItemIsUserCheckable | Qt::ItemIsSelectable);
  item->setCheckState(Qt::Checked);
}

}  // namespace

StudyChoices::StudyChoices(LabDocument& document, QWidget* parent) : QWidget(parent) {
  kind_ = named("studyKind", new QComboBox(this));
  sweep_ = new SweepChoices(document, this);
  fit_ = new FitChoices(document, this);
  kind_->addItems({tr("Sweep"), tr("Fit to measured values"), tr("Work-precision"),
                   tr("Convergence of iterations"), tr("Stability map"), tr("Extreme cases"),
                   tr("Grid convergence"), tr("Materials against exact solutions")});
  purpose_ = new QLabel(this);
  purpose_->setWordWrap(true);
  purpose_->setProperty("muted", true);
  methods_ = boxes("studyMethods", tr("Methods"), method_rows, this);
  for (const cloth::MethodFacts& facts : cloth::integrator_facts())
    add_box(methods_, facts.title, facts.name);
  protocols_ = boxes("studyProtocols", tr("Protocols"), protocol_rows, this);
  const std::vector<std::string> exact = cloth::exact_protocols();
  for (const std::string& name : cloth::validation_protocols()) {
    add_box(protocols_, name, name);
    if (std::find(exact.begin(), exact.end(), name) == exact.end())  // it takes many minutes
      protocols_->item(protocols_->count() - 1)->setCheckState(Qt::Unchecked);
  }
  makeFields();
  makeRows();
  connectRows();
  follow();
}

void StudyChoices::makeFields() {
  horizon_ = named("horizon", new QLineEdit(this));
  repeats_ = named("repeats", new QSpinBox(this));
  repeats_->setRange(5, 100);
  repeats_->setToolTip(tr("How often each run is timed"));
  x_ = named("xAxis", new AxisChoice(this));
  y_ = named("yAxis", new AxisChoice(this));
  periods_ = named("periods", new QSpinBox(this));
  periods_->setRange(1, 100000);
  periods_->setValue(static_cast<int>(cloth::StabilityCriterion{}.periods));
  periods_->setToolTip(tr("How long a run lasts, in periods of the fastest motion"));
  cases_ = named("cases", new QComboBox(this));
  cases_->addItems({tr("This scene, pushed"), tr("The fixed list")});
  cells_ = named("cells", new QLineEdit(this));
  cells_->setToolTip(
      tr("Cells across of each grid, from coarse to fine, between commas. The cells down follow."));
  outputs_ = named("outputs", new OutputsChoice(this));
  time_ = named("studyTime", new QLineEdit(this));
  time_->setToolTip(tr("How long the runs last; empty: the scene's duration"));
  step_ = named("iteratedStep", new QLineEdit(this));
  step_->setToolTip(tr("The time step that is solved; empty: the scene's, or 0.01 s where that is auto"));
  before_ = named("iteratedTime", new QLineEdit(this));
  before_->setToolTip(tr("Simulated time before the step that is studied, moved by implicit Euler"));
  before_->setPlaceholderText(number_text(cloth::IterationsOptions{}.time, 4));
  most_ = named("mostIterations", new QSpinBox(this));
  most_->setRange(1, 1'000'000);
  most_->setValue(cloth::IterationsOptions{}.most);
  most_->setToolTip(tr("A method ends there, at the floor of what can be measured, or after a minute"));
  folder_ = named("studyFolder", new QLineEdit(this));
  folder_->setToolTip(tr("The results' folder; empty: a new one under %1").arg(shown_path(studies_folder())));
  folder_->setPlaceholderText(tr("a new one in %1").arg(shown_path(studies_folder())));
}

/// Two left edges: that of the labels and that of the fields.
void StudyChoices::makeRows() {
  form_ = spaced(new QFormLayout(this), spacing / 2);
  form_->setRowWrapPolicy(QFormLayout::DontWrapRows);
  form_->setFieldGrowthPolicy(QFormLayout::AllNonFixedFieldsGrow);
  form_->setLabelAlignment(Qt::AlignLeading);
  form_->addRow(kind_);
  form_->addRow(purpose_);
  form_->addRow(sweep_);
  form_->addRow(fit_);
  form_->addRow(methods_);
  form_->addRow(protocols_);
  form_->addRow(tr("Horizon (s)"), horizon_);
  form_->addRow(tr("Repeats"), repeats_);
  form_->addRow(tr("Step (s)"), step_);
  form_->addRow(tr("Begins (s)"), before_);
  form_->addRow(tr("Iterations"), most_);
  form_->addRow(tr("Across"), x_);
  form_->addRow(tr("Up"), y_);
  form_->addRow(tr("Periods"), periods_);
  form_->addRow(tr("Cases"), cases_);
  form_->addRow(tr("Cells"), cells_);
  form_->addRow(tr("Outputs"), outputs_);
  form_->addRow(tr("Time (s)"), time_);
  form_->addRow(tr("Folder"), folder_);
  form_->setItem(form_->rowCount(), QFormLayout::SpanningRole,
                 new QSpacerItem(0, 0, QSizePolicy::Minimum, QSizePolicy::Expanding));
  for (QWidget* field :
       {static_cast<QWidget*>(repeats_), static_cast<QWidget*>(periods_), static_cast<QWidget*>(most_)})
    field->setSizePolicy(QSizePolicy::Expanding, QSizePolicy::Fixed);
}

void StudyChoices::connectRows() {
  connect(kind_, &QComboBox::currentIndexChanged, this, &StudyChoices::follow);
  connect(methods_, &QListWidget::itemChanged, this, [this] {
    if (checking_) return;
    own_methods_[kind()] = methods();
    Q_EMIT changed();
  });
  connect(protocols_, &QListWidget::itemChanged, this, &StudyChoices::changed);
  connect(sweep_, &SweepChoices::changed, this, &StudyChoices::changed);
  connect(fit_, &FitChoices::changed, this, &StudyChoices::changed);
  connect(horizon_, &QLineEdit::textChanged, this, &StudyChoices::changed);
  connect(repeats_, &QSpinBox::valueChanged, this, &StudyChoices::changed);
  connect(x_, &AxisChoice::changed, this, &StudyChoices::changed);
  connect(y_, &AxisChoice::changed, this, &StudyChoices::changed);
  connect(periods_, &QSpinBox::valueChanged, this, &StudyChoices::changed);
  connect(step_, &QLineEdit::textChanged, this, &StudyChoices::changed);
  connect(before_, &QLineEdit::textChanged, this, &StudyChoices::changed);
  connect(most_, &QSpinBox::valueChanged, this, &StudyChoices::changed);
  connect(cases_, &QComboBox::currentIndexChanged, this, &StudyChoices::changed);
  connect(cells_, &QLineEdit::textChanged, this, &StudyChoices::changed);
  connect(outputs_, &OutputsChoice::changed, this, &StudyChoices::changed);
  connect(time_, &QLineEdit::textChanged, this, &StudyChoices::changed);
}

StudyChoices::Kind StudyChoices::kind() const {
  return static_cast<Kind>(kind_->currentIndex());
}

void StudyChoices::choose(Kind kind) {
  kind_->setCurrentIndex(static_cast<int>(kind));
}

void StudyChoices::follow() {
  const Kind now = kind();
  purpose_->setText(purpose_of(now));
  keepPurposeWhole();
  for (QWidget* field : {static_cast<QWidget*>(horizon_), static_cast<QWidget*>(repeats_)})
    form_->setRowVisible(field, now == Kind::work_precision);
  for (QWidget* field :
       {static_cast<QWidget*>(x_), static_cast<QWidget*>(y_), static_cast<QWidget*>(periods_)})
    form_->setRowVisible(field, now == Kind::stability);
  for (QWidget* field :
       {static_cast<QWidget*>(step_), static_cast<QWidget*>(before_), static_cast<QWidget*>(most_)})
    form_->setRowVisible(field, now == Kind::iterations);
  form_->setRowVisible(cases_, now == Kind::extremes);
  for (QWidget* field :
       {static_cast<QWidget*>(cells_), static_cast<QWidget*>(outputs_), static_cast<QWidget*>(time_)})
    form_->setRowVisible(field, now == Kind::convergence);
  form_->setRowVisible(sweep_, now == Kind::sweep);
  form_->setRowVisible(fit_, now == Kind::fit);
  const bool any_method =
      now == Kind::work_precision || now == Kind::stability || now == Kind::extremes;  // or their own
  form_->setRowVisible(methods_, any_method || now == Kind::iterations);
  offerMethods(now == Kind::iterations ? cloth::iterated_methods() : cloth::integrator_names());
  form_->setRowVisible(protocols_, now == Kind::validation);
  const auto own = own_methods_.find(now);
  if (own != own_methods_.end())
    checkMethods(own->second);
  else
    checkMethods(now == Kind::stability    ? cloth::methods_with_a_limit()
                 : now == Kind::iterations ? cloth::iterated_methods()
                                           : cloth::integrator_names());
  Q_EMIT changed();
}

/// A label's least height is that of a single line, and its usual one that of a narrow column: rows below it
/// would be squeezed before the form scrolls, or leave a gap.
void StudyChoices::keepPurposeWhole() {
  purpose_->setMinimumHeight(0);  // a label says that it needs no less than it had
  const int height = purpose_->heightForWidth(width());
  QSizePolicy policy = purpose_->sizePolicy();
  policy.setHeightForWidth(false);  // the form would ask for the height beside its labels
  purpose_->setSizePolicy(policy);
  purpose_->setFixedHeight(height);
}

void StudyChoices::resizeEvent(QResizeEvent* event) {
  QWidget::resizeEvent(event);
  keepPurposeWhole();
}

/// Others have no box.
void StudyChoices::offerMethods(const std::vector<std::string>& names) {
  int offered = 0;
  for (int row = 0; row < methods_->count(); ++row) {
    const std::string name = methods_->item(row)->data(Qt::UserRole).toString().toStdString();
    const bool is_offered = std::find(names.begin(), names.end(), name) != names.end();
    methods_->item(row)->setHidden(!is_offered);
    offered += is_offered ? 1 : 0;
  }
  methods_->setFixedHeight((offered + 1) / 2 * method_height + spacing);
}

void StudyChoices::checkMethods(const std::vector<std::string>& names) {
  const QScopedValueRollback checking(checking_, true);
  for (int row = 0; row < methods_->count(); ++row) {
    const std::string name = methods_->item(row)->data(Qt::UserRole).toString().toStdString();
    const bool on = std::find(names.begin(), names.end(), name) != names.end();
    methods_->item(row)->setCheckState(on ? Qt::Checked : Qt::Unchecked);
  }
}

void StudyChoices::setScene(const cloth::Scene& scene) {
  scene_ = scene;
  horizon_->setPlaceholderText(number_text(cloth::default_horizon(cloth::studied_scene(scene)), 4));
  x_->setScene(scene, cloth::default_time_axis(scene, cloth::methods_with_a_limit()));
  y_->setScene(scene, cloth::default_stiffness_axis(scene));
  cells_->setPlaceholderText(cloth::refinement_problem(scene) ? QString()
                                                              : cells_text(cloth::default_cells(scene)));
  outputs_->setScene(scene);
  step_->setPlaceholderText(number_text(cloth::plan_iterations_study(scene, {}).step, 4));
  sweep_->refresh();
  fit_->refresh();
  time_->setPlaceholderText(number_text(scene.duration, 4));
  Q_EMIT changed();
}

void StudyChoices::keepAxes() {
  if (kind() != Kind::stability) return;
  x_->keep();
  y_->keep();
}

}  // namespace clothlab

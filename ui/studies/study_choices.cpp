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
#include "studies/study_inputs.h"
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
const char* const made_by = "the Studies window of clothlab";

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

/// nullopt: an entry is no whole number.
std::optional<std::vector<int>> cells_from(const QString& text) {
  std::vector<int> cells;
  for (const QString& entry : text.split(',')) {
    bool is_whole = false;
    cells.push_back(entry.trimmed().toInt(&is_whole));
    if (!is_whole) return std::nullopt;
  }
  return cells;
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

std::vector<std::string> checked(const QListWidget& list) {
  std::vector<std::string> names;
  for (int row = 0; row < list.count(); ++row)
    if (list.item(row)->checkState() == Qt::Checked)
      names.push_back(list.item(row)->data(Qt::UserRole).toString().toStdString());
  return names;
}

}  // namespace

StudyChoices::StudyChoices(LabDocument& document, QWidget* parent) : QWidget(parent) {
  kind_ = named("studyKind", new QComboBox(this));
  sweep_ = new SweepChoices(document, this);
  fit_ = new FitChoices(document, this);
  kind_->addItems({tr("Sweep"), tr("Fit to measured values"), tr("Work-precision"), tr("Stability map"),
                   tr("Extreme cases"), tr("Grid convergence"), tr("Materials against exact solutions")});
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
  for (QWidget* field : {static_cast<QWidget*>(repeats_), static_cast<QWidget*>(periods_)})
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
  form_->setRowVisible(cases_, now == Kind::extremes);
  for (QWidget* field :
       {static_cast<QWidget*>(cells_), static_cast<QWidget*>(outputs_), static_cast<QWidget*>(time_)})
    form_->setRowVisible(field, now == Kind::convergence);
  form_->setRowVisible(sweep_, now == Kind::sweep);
  form_->setRowVisible(fit_, now == Kind::fit);
  form_->setRowVisible(folder_, now != Kind::fit);
  const bool any_method =
      now == Kind::work_precision || now == Kind::stability || now == Kind::extremes;  // or their own
  form_->setRowVisible(methods_, any_method);
  form_->setRowVisible(protocols_, now == Kind::validation);
  const auto own = own_methods_.find(now);
  if (own != own_methods_.end())
    checkMethods(own->second);
  else
    checkMethods(now == Kind::stability ? cloth::methods_with_a_limit() : cloth::integrator_names());
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

std::vector<std::string> StudyChoices::methods() const {
  return checked(*methods_);
}

std::variant<StudyOrder, QString> StudyChoices::validationInputs() const {
  const cloth::ValidationOptions options{.protocols = checked(*protocols_)};
  if (options.protocols.empty()) return tr("Choose at least one protocol.");
  return StudyOrder{scene_, options, {}, made_by};
}

std::variant<StudyOrder, QString> StudyChoices::stabilityInputs() const {
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

std::variant<StudyOrder, QString> StudyChoices::precisionInputs() const {
  cloth::WorkPrecisionOptions options;
  options.methods = methods();
  options.repeats = repeats_->value();
  if (const QString text = horizon_->text().trimmed(); !text.isEmpty()) {
    const cloth::Quantity typed = typed_quantity(text, "s");
    options.horizon = typed.value;
    if (!typed.ok() || !(typed.value > 0))
      return tr("Horizon: \"%1\" must be a time in s, more than 0.").arg(text);
  }
  return StudyOrder{scene_, options, {}, made_by};
}

std::variant<StudyOrder, QString> StudyChoices::convergenceInputs() const {
  cloth::GridConvergenceOptions options;
  options.outputs = outputs_->outputs();
  if (const QString text = cells_->text().trimmed(); !text.isEmpty()) {
    const auto cells = cells_from(text);
    if (!cells) return tr("Cells: \"%1\" must be whole numbers between commas.").arg(text);
    options.cells = *cells;
  }
  if (const QString text = time_->text().trimmed(); !text.isEmpty()) {
    const cloth::Quantity typed = typed_quantity(text, "s");
    options.time = typed.value;
    if (!typed.ok() || !(typed.value > 0))
      return tr("Time: \"%1\" must be a time in s, more than 0.").arg(text);
  }
  const auto problems = cloth::find_problems(scene_, options);
  if (problems.empty()) return StudyOrder{scene_, options, {}, made_by};
  const cloth::Problem& first = problems.front();
  const QString rule = QString::fromStdString(first.rule);
  if (first.path == "--cells") return tr("Cells: %1").arg(rule);
  if (first.path == "--output") return tr("Outputs: %1").arg(rule);
  if (first.path == "--time") return tr("Time: %1").arg(rule);
  return QString::fromStdString(first.text());
}

std::variant<StudyOrder, QString> StudyChoices::inputs() const {
  if (kind() == Kind::sweep || kind() == Kind::fit) return QString();  // by other runners
  if (kind() == Kind::convergence) return convergenceInputs();
  if (kind() == Kind::validation) return validationInputs();
  if (methods().empty()) return tr("Choose at least one method.");
  if (kind() == Kind::stability) return stabilityInputs();
  if (kind() == Kind::work_precision) return precisionInputs();
  cloth::ExtremesOptions options{.methods = methods()};
  if (cases_->currentIndex() == 0) options.scene = scene_;
  return StudyOrder{scene_, options, {}, made_by};
}

/// As typed, else a new one.
std::filesystem::path StudyChoices::folder() const {
  const QString typed = path_from(folder_->text().trimmed());
  const QString title = kind() == Kind::validation ? QString() : QString::fromStdString(scene_.title);
  return (typed.isEmpty() ? new_study_folder(kind_->currentText(), title) : typed).toStdString();
}

std::variant<StudyOrder, QString> StudyChoices::order() const {
  auto result = inputs();
  if (auto* order = std::get_if<StudyOrder>(&result)) order->folder = folder();
  return result;
}

std::variant<SweepOrder, QString> StudyChoices::sweepOrder() const {
  auto plan = sweep_->plan();
  if (auto* problem = std::get_if<QString>(&plan)) return *problem;
  return SweepOrder{folder(), std::get<cloth::SweepPlan>(std::move(plan))};
}

bool StudyChoices::describes(const cloth::StudyTable& table) const {
  const auto now = inputs();
  const auto* order = std::get_if<StudyOrder>(&now);
  return order && has_inputs(table, *order);
}

}  // namespace clothlab

// StudyChoices: from what is chosen to what is run.
#include <QComboBox>
#include <QLineEdit>
#include <QListWidget>
#include <QSpinBox>

#include "studies/axis_choice.h"
#include "studies/fit_choices.h"
#include "studies/outputs_choice.h"
#include "studies/study_choices.h"
#include "studies/study_inputs.h"
#include "studies/study_library.h"
#include "studies/sweep_choices.h"
#include "study/stability_map.h"
#include "widgets/numbers.h"

namespace clothlab {
namespace {

const char* const made_by = "the Studies window of clothlab";

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

std::vector<std::string> checked(const QListWidget& list) {
  std::vector<std::string> names;
  for (int row = 0; row < list.count(); ++row)
    if (list.item(row)->checkState() == Qt::Checked)
      names.push_back(list.item(row)->data(Qt::UserRole).toString().toStdString());
  return names;
}

}  // namespace

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

std::variant<StudyOrder, QString> StudyChoices::iterationsInputs() const {
  cloth::IterationsOptions options{.methods = methods(), .most = most_->value()};
  if (const QString text = step_->text().trimmed(); !text.isEmpty()) {
    const cloth::Quantity typed = typed_quantity(text, "s");
    options.step = typed.value;
    if (!typed.ok() || !(typed.value > 0))
      return tr("Step: \"%1\" must be a time in s, more than 0.").arg(text);
  }
  if (const QString text = before_->text().trimmed(); !text.isEmpty()) {
    const cloth::Quantity typed = typed_quantity(text, "s");
    options.time = typed.value;
    if (!typed.ok() || !(typed.value >= 0))
      return tr("Begins: \"%1\" must be a time in s, at least 0.").arg(text);
  }
  const auto problems = cloth::find_problems(scene_, options);
  if (!problems.empty()) return tr("The scene %1.").arg(QString::fromStdString(problems.front().rule));
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
  if (kind() == Kind::iterations) return iterationsInputs();
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

std::variant<FitOrder, QString> StudyChoices::fitOrder() const {
  auto plan = fit_->plan();
  if (auto* problem = std::get_if<QString>(&plan)) return *problem;
  FitOrder order{folder(), std::get<cloth::IdentifyPlan>(std::move(plan)), fit_->tableFile().toStdString()};
  order.plan.command = made_by;
  return order;
}

bool StudyChoices::describes(const cloth::StudyTable& table) const {
  const auto now = inputs();
  const auto* order = std::get_if<StudyOrder>(&now);
  return order && has_inputs(table, *order);
}

}  // namespace clothlab

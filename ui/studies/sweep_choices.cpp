#include "studies/sweep_choices.h"

#include <QLabel>
#include <QListWidget>
#include <QScopedValueRollback>
#include <QVBoxLayout>
#include <algorithm>

#include "document/varied_ranges.h"
#include "scene/probe.h"
#include "simulation/step_batches.h"
#include "studies/sweep_diagrams.h"
#include "studies/varied_list.h"
#include "study/run_output.h"
#include "study/study_axis.h"
#include "sweep/sweep_points.h"
#include "theme/theme.h"
#include "widgets/building.h"
#include "widgets/numbers.h"

namespace clothlab {
namespace {

constexpr int output_rows = 5, output_height = 22;         // px
constexpr int pause_of_typing = 250, time_interval = 100;  // ms

/// What a person asks of most scenes comes first.
std::vector<cloth::RunOutput> outputs_of(const cloth::Scene& scene) {
  using cloth::Reduction;
  std::vector<cloth::RunOutput> all;
  const auto offer = [&](const std::string& name, const std::string& of, Reduction reduce) {
    all.push_back({.name = name, .of = of, .reduce = reduce});
  };
  const bool is_pinned = !scene.cloth.pins.empty();
  if (is_pinned) offer("sag", "sag", Reduction::final_value);
  offer("lowest_point", "lowest_point", Reduction::final_value);
  offer("max_strain", "max_strain", Reduction::maximum);
  offer("extent", "extent", Reduction::final_value);
  if (is_pinned) offer("droop_ratio", "droop_ratio", Reduction::final_value);
  if (is_pinned) offer("sag_max", "sag", Reduction::maximum);
  offer("lowest_point_min", "lowest_point", Reduction::minimum);
  for (const std::string& probe : cloth::probe_columns(scene.probes)) {
    offer(probe + "_final", probe, Reduction::final_value);
    offer(probe + "_max", probe, Reduction::maximum);
  }
  for (const std::string& column : cloth::output_sources(scene)) {
    const bool known =
        std::any_of(all.begin(), all.end(), [&](const auto& output) { return output.of == column; });
    if (known || column == "time_s" || column == "step") continue;
    offer(column + "_final", column, Reduction::final_value);
    offer(column + "_max", column, Reduction::maximum);
  }
  return all;
}

bool is_usual(const std::string& name, const std::vector<cloth::RunOutput>& offered) {
  return name == offered.front().name || name == "max_strain";
}

QString time_words(double seconds) {
  if (seconds < 1) return QObject::tr("less than 1 s");
  if (seconds < 60) return QObject::tr("about %1 s").arg(qRound(seconds));
  if (seconds < 3600) return QObject::tr("about %1 min").arg(number_text(seconds / 60, 2));
  return QObject::tr("about %1 h").arg(number_text(seconds / 3600, 2));
}

}  // namespace

std::vector<std::string> varied_paths(const cloth::SweepPlan& plan, const cloth::Scene& scene) {
  std::vector<std::string> paths;
  for (const std::string& path : paths_of(plan))
    for (const cloth::Parameter& parameter : cloth::parameters_of(scene))
      if (parameter.path == path || (path == cloth::all_stiffnesses_path &&
                                     parameter.path.starts_with("springs.") && can_be_varied(parameter.info)))
        paths.push_back(parameter.path);
  return paths;
}

void copy_varied(const cloth::SweepPlan& plan, const cloth::Scene& from, cloth::Scene& scene) {
  for (const std::string& path : varied_paths(plan, from)) {
    const auto parameter = find_parameter(scene, path);
    if (parameter) parameter->set(scene, parameter->get(from));
  }
}

SweepChoices::SweepChoices(LabDocument& document, QWidget* parent) : QWidget(parent), document_(document) {
  setObjectName("sweepChoices");
  auto* column = spaced(new QVBoxLayout(this), spacing / 2);
  varied_ = new VariedList(document, RangeRow::Place::dock, this);
  column->addWidget(varied_);
  makeOutputs();
  time_ = named("sweepTime", new QLabel(this));
  time_->setWordWrap(true);
  ask_.setSingleShot(true);
  ask_.setInterval(pause_of_typing);
  take_.setInterval(time_interval);
  connect(&ask_, &QTimer::timeout, this, &SweepChoices::askForTime);
  connect(&take_, &QTimer::timeout, this, &SweepChoices::takeTime);
  connect(varied_, &VariedList::changed, this, &SweepChoices::changed);
  connect(varied_, &VariedList::ruleBroken, this, &SweepChoices::showRule);
  connect(this, &SweepChoices::changed, this, [this] {
    showTime(std::nullopt);
    if (isVisible()) ask_.start();
  });
}

void SweepChoices::makeOutputs() {
  layout()->addWidget(new QLabel(tr("Outputs"), this));
  list_ = named("sweepOutputs", new QListWidget(this));
  list_->setAccessibleName(tr("Outputs to keep of each run"));
  list_->setFixedHeight(output_rows * output_height + spacing);
  list_->setHorizontalScrollBarPolicy(Qt::ScrollBarAlwaysOff);
  list_->setUniformItemSizes(true);
  layout()->addWidget(list_);
  connect(list_, &QListWidget::itemChanged, this, [this] {
    if (offering_) return;
    has_own_ = true;
    own_.clear();
    for (const cloth::RunOutput& output : outputs()) own_.insert(output.name);
    Q_EMIT changed();
  });
}

void SweepChoices::showRule(const QString& rule) {
  if (rule.isEmpty()) return showTime(std::nullopt);
  time_->setProperty("state", "error");
  time_->style()->polish(time_);
  time_->setText(tr("The range %1.").arg(rule));
}

void SweepChoices::refresh() {
  offerOutputs();
  varied_->refresh();
}

/// Ticks the usual outputs, or those that the user ticked as far as the scene has them.
void SweepChoices::offerOutputs() {
  std::vector<cloth::RunOutput> offers = outputs_of(document_.scene());
  const QScopedValueRollback offering(offering_, true);
  const bool same = std::equal(offers.begin(), offers.end(), offered_.begin(), offered_.end(),
                               [](const auto& a, const auto& b) { return a.name == b.name; });
  if (same) return;
  offered_ = std::move(offers);
  list_->clear();
  for (const cloth::RunOutput& output : offered_) {
    auto* item = new QListWidgetItem(output_words(output), list_);
    item->setData(Qt::UserRole, QString::fromStdString(output.name));
    item->setFlags(Qt::ItemIsEnabled | Qt::ItemIsUserCheckable | Qt::ItemIsSelectable);
    const bool on = has_own_ ? own_.count(output.name) > 0 : is_usual(output.name, offered_);
    item->setCheckState(on ? Qt::Checked : Qt::Unchecked);
  }
}

std::vector<cloth::RunOutput> SweepChoices::outputs() const {
  std::vector<cloth::RunOutput> checked;
  for (int row = 0; row < list_->count(); ++row)
    if (list_->item(row)->checkState() == Qt::Checked)
      checked.push_back(offered_[static_cast<std::size_t>(row)]);
  return checked;
}

std::variant<cloth::SweepPlan, QString> SweepChoices::plan() const {
  cloth::SweepPlan plan{.scene = document_.scene()};
  plan.title = plan.scene.title;
  for (const VariedRange& range : document_.varied().list())
    plan.axes.push_back({.paths = {range.path},
                         .from = {range.from},
                         .to = {range.to},
                         .count = range.count,
                         .scale = range.scale});
  if (plan.axes.empty()) return tr("Choose at least one parameter to vary.");
  plan.outputs = outputs();
  if (plan.outputs.empty()) return tr("Tick at least one output.");
  double points = 1;
  for (const cloth::SweepAxis& axis : plan.axes) points *= axis.count;
  if (points > static_cast<double>(cloth::most_sweep_points))
    return tr("These are %1 points, and at most %2 are run.")
        .arg(number_text(points, 3), count_text(static_cast<double>(cloth::most_sweep_points)));
  return plan;
}

bool SweepChoices::describes(const cloth::SweepPlan& shown) const {
  const auto now = plan();
  const auto* form = std::get_if<cloth::SweepPlan>(&now);
  if (!form || form->axes.size() != shown.axes.size()) return false;
  for (std::size_t k = 0; k < form->axes.size(); ++k) {
    const cloth::SweepAxis &a = form->axes[k], &b = shown.axes[k];
    if (a.paths != b.paths || a.from != b.from || a.to != b.to || a.count != b.count || a.scale != b.scale)
      return false;
  }
  const bool same_outputs =
      std::equal(form->outputs.begin(), form->outputs.end(), shown.outputs.begin(), shown.outputs.end(),
                 [](const auto& a, const auto& b) { return a.of == b.of && a.reduce == b.reduce; });
  cloth::Scene scene = form->scene;
  copy_varied(shown, shown.scene, scene);
  scene.folder = shown.scene.folder;
  return same_outputs && scene == shown.scene;
}

void SweepChoices::askForTime() {
  const auto now = plan();
  if (const auto* plan = std::get_if<cloth::SweepPlan>(&now)) {
    estimator_.ask(*plan, cloth::machine_threads());
    take_.start();
  }
}

void SweepChoices::takeTime() {
  const auto answer = estimator_.take();
  if (!answer) return;
  take_.stop();
  showTime(answer);
}

/// Before there is an estimate: the number of points alone.
void SweepChoices::showTime(const std::optional<SweepEstimate>& estimate) {
  const auto now = plan();
  const auto* plan = std::get_if<cloth::SweepPlan>(&now);
  time_->setProperty("state", "");
  time_->style()->polish(time_);
  if (!plan) return time_->setText(document_.varied().list().empty() ? QString() : std::get<QString>(now));
  std::int64_t points = 1;
  for (const cloth::SweepAxis& axis : plan->axes) points *= axis.count;
  QString text = tr("%1 runs").arg(count_text(static_cast<double>(points)));
  if (!estimate) return time_->setText(text + tr(": a run is timed…"));
  if (estimate->refused == estimate->looked_at)
    return time_->setText(text + tr(": none of those looked at can be run"));
  const int cores = cloth::machine_threads();
  text += cores > 1 ? tr(": %1 on %2 cores").arg(time_words(estimate->whole)).arg(cores)
                    : tr(": %1").arg(time_words(estimate->whole));
  text += tr(", %1 each").arg(quantity_text(estimate->point, "s", 2));
  if (estimate->refused > 0)
    text += tr("; %1 of %2 looked at cannot be run").arg(estimate->refused).arg(estimate->looked_at);
  time_->setText(text);
}

void SweepChoices::showEvent(QShowEvent* event) {
  QWidget::showEvent(event);
  ask_.start();
}

void SweepChoices::hideEvent(QHideEvent* event) {
  QWidget::hideEvent(event);
  ask_.stop();
  take_.stop();
  estimator_.forget();
}

}  // namespace clothlab

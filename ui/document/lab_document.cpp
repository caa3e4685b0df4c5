#include "document/lab_document.h"

#include <QFileInfo>
#include <algorithm>
#include <utility>

#include "document/cloth_edits.h"
#include "document/varied_ranges.h"
#include "scene/scene_checks.h"
#include "scene/scene_edits.h"

namespace clothlab {
namespace {

using cloth::Comparison;
using cloth::ParameterValue;
using cloth::Scene;
using Effect = SceneChange::Effect;

constexpr int following = -1;  // the drag number of edits that follow the run

/// What one value of a material or of its grid's cells asks of the others, and what a cut asks.
QString broken_rule_of_material(const Scene& edited) {
  if (!edited.material && !edited.cloth.is_cut()) return {};
  for (const cloth::Problem& problem : find_problems(edited)) {
    const bool of_cloth = problem.path == "cloth.down" || problem.path == "cloth.cut";
    if (problem.path.rfind("material", 0) == 0 || of_cloth)
      return QString::fromStdString(of_cloth ? problem.rule : problem.text());
  }
  return {};
}

/// The first rule that a probe breaks.
QString broken_rule_of_probes(const Scene& edited) {
  const auto problems = find_probe_problems(edited);
  return problems.empty() ? QString() : QString::fromStdString(problems.front().rule);
}

/// Of comparisons: own values of parameters that went with their block or method go too. What has one pane
/// left is that pane's scene.
void make_consistent(Comparison& comparison) {
  if (comparison.panes.size() == 1) {
    comparison = cloth::comparison_of_one(scene_of(comparison, 0));
    return;
  }
  for (std::size_t i = 0; i < comparison.panes.size(); ++i) {
    const Scene scene = scene_of(comparison, i);
    std::erase_if(comparison.panes[i].own,
                  [&](const cloth::OwnValue& own) { return !find_parameter(scene, own.path); });
  }
}

/// Whether both run the same: what a session logs as an edit differs in no pane.
bool run_alike(const Comparison& one, const Comparison& other) {
  for (std::size_t i = 0; i < one.panes.size(); ++i)
    if (!edits_between(scene_of(one, i), scene_of(other, i)).empty()) return false;
  return true;
}

bool have_same_panes(const Comparison& one, const Comparison& other) {
  return std::equal(one.panes.begin(), one.panes.end(), other.panes.begin(), other.panes.end(),
                    [](const cloth::Pane& a, const cloth::Pane& b) { return a.name == b.name; });
}

bool names_unread_mesh(const Scene& scene) {
  const auto is_unread = [](const cloth::MeshChoice& mesh) {
    return !mesh.file.empty() && !mesh.is_loaded();
  };
  return is_unread(scene.cloth.mesh) ||
         std::any_of(scene.obstacles.begin(), scene.obstacles.end(),
                     [&](const cloth::Obstacle& obstacle) { return is_unread(obstacle.mesh); });
}

}  // namespace

/// A comparison is a small value, so a command keeps it whole before and after: undo is exact by
/// construction.
class LabDocument::EditCommand : public QUndoCommand {
 public:
  EditCommand(LabDocument& document, const QString& text, Comparison after, SceneChange change, int drag)
      : QUndoCommand(text),
        document_(document),
        before_(document.comparison_),
        after_(std::move(after)),
        change_(std::move(change)),
        scope_(document.scope_),
        drag_(drag) {}

  void undo() override { document_.apply(before_, change_); }
  void redo() override {
    // The run already has this now; a later redo must apply it to the run.
    const bool is_in_force = std::exchange(is_new_, false) && drag_ == following;
    document_.apply(after_, is_in_force ? SceneChange{Effect::none, change_.path} : change_);
  }
  int id() const override { return 1; }

  bool mergeWith(const QUndoCommand* other) override {
    const auto* next = static_cast<const EditCommand*>(other);
    if (!belongs_to(next->drag_, next->change_.path, next->scope_)) return false;
    after_ = next->after_;
    change_.effect = std::max(change_.effect, next->change_.effect);
    setObsolete(after_ == before_);
    return true;
  }

  bool belongs_to(int drag, const std::string& path, std::optional<std::size_t> scope) const {
    return drag_ != 0 && drag_ == drag && change_.path == path && scope_ == scope;
  }
  const Comparison& before() const { return before_; }

 private:
  LabDocument& document_;
  Comparison before_, after_;
  SceneChange change_;
  std::optional<std::size_t> scope_;
  int drag_;
  bool is_new_ = true;
};

LabDocument::LabDocument(QObject* parent) : QObject(parent), comparison_(cloth::comparison_of_one({})) {
  qRegisterMetaType<SceneChange>();
  varied_ = std::make_unique<VariedRanges>(*this);
  connect(&undo_stack_, &QUndoStack::indexChanged, this, &LabDocument::noteModified);
  connect(&undo_stack_, &QUndoStack::cleanChanged, this, &LabDocument::noteModified);
}

LabDocument::~LabDocument() {
  // The stack is cleared after this body, when no signal may be sent any more.
  undo_stack_.disconnect(this);
}

/// Edits beside the scene do not count.
bool LabDocument::isModified() const {
  if (unsaved_) return true;
  const int clean = undo_stack_.cleanIndex(), now = undo_stack_.index();
  if (clean < 0) return true;
  for (int k = std::min(clean, now); k < std::max(clean, now); ++k)
    if (!dynamic_cast<const SideCommand*>(undo_stack_.command(k))) return true;
  return false;
}

void LabDocument::noteModified() {
  const bool modified = isModified();
  if (std::exchange(announced_modified_, modified) != modified) Q_EMIT modifiedChanged(modified);
}

void LabDocument::markSaved(const QString& path) {
  path_ = path;
  path_is_comparison_ = isComparison();
  undo_stack_.setClean();
  setUnsaved(false);
  Q_EMIT titleChanged();
}

void LabDocument::setUnsaved(bool unsaved) {
  if (unsaved == unsaved_) return;
  unsaved_ = unsaved;
  noteModified();
}

QString LabDocument::title() const {
  for (const std::string& title : {comparison_.title, comparison_.scene.title})
    if (!title.empty()) return QString::fromStdString(title);
  const QString name = QFileInfo(path()).fileName();
  if (name.isEmpty()) return tr("Untitled");
  for (const char* suffix : {".scene.json", ".compare.json"})
    if (name.endsWith(QLatin1String(suffix))) return name.chopped(qstrlen(suffix));
  return name;
}

void LabDocument::load(Scene scene, const QString& path, bool unsaved) {
  load(cloth::comparison_of_one(std::move(scene)), path, unsaved);
}

void LabDocument::load(Comparison comparison, const QString& path, bool unsaved) {
  drag_ = 0;
  loaded_ = true;
  comparison_ = std::move(comparison);
  scope_.reset();
  scene_ = comparison_.scene;
  path_ = path;
  path_is_comparison_ = isComparison();
  undo_stack_.clear();
  setUnsaved(unsaved);
  Q_EMIT loaded();
  Q_EMIT titleChanged();
}

void LabDocument::setScope(std::optional<std::size_t> pane) {
  if (pane == scope_ || !isComparison()) return;
  drag_ = 0;
  scope_ = pane;
  scene_ = sceneOfScope();
  Q_EMIT scopeChanged();
}

Scene LabDocument::sceneOfScope() const {
  return scope_ ? scene_of(comparison_, *scope_) : comparison_.scene;
}

std::optional<ParameterValue> LabDocument::value(const std::string& path) const {
  const auto parameter = find_parameter(scene_, path);
  if (!parameter) return std::nullopt;
  return parameter->get(scene_);
}

QString LabDocument::setParameter(const std::string& path, const ParameterValue& value) {
  return change(path, value, tr("Change %1"));
}

QString LabDocument::resetParameter(const std::string& path) {
  const auto value = cloth::default_of(scene_, path);
  if (!value) return tr("has no default");
  return change(path, *value, tr("Reset %1"));
}

/// Why the meshes cannot be used, or nothing.
QString LabDocument::readMeshes(cloth::Scene& edited) const {
  const bool here = !mesh_reader_ || !names_unread_mesh(edited);
  const auto problems = here ? load_meshes(edited, &scene_) : mesh_reader_(edited, scene_);
  return problems.empty() ? QString() : QString::fromStdString(problems.front().rule);
}

QString LabDocument::change(const std::string& path, const ParameterValue& value, const QString& verb) {
  const auto parameter = find_parameter(scene_, path);
  if (!parameter) return tr("is not a parameter of this scene");
  if (const QString rule = broken_kind(parameter->info, value); !rule.isEmpty()) return rule;
  if (const auto rule = broken_rule(parameter->info, value)) return QString::fromStdString(*rule);
  if (parameter->get(scene_) == value) return {};

  const bool is_own = scope_ && !cloth::must_be_shared(path);
  Comparison after = comparisonBefore(path);
  Scene edited = is_own ? scene_of(after, *scope_) : after.scene;
  const cloth::ClothSheet before = edited.cloth;
  parameter->set(edited, value);
  if (const QString rule = readMeshes(edited); !rule.isEmpty()) return rule;
  if (const QString rule = broken_rule_of_material(edited); !rule.isEmpty()) return rule;
  if (edited.cloth.rows != before.rows || edited.cloth.columns != before.columns ||
      edited.cloth.cut != before.cut) {
    edited.cloth.pins = pins_inside(edited.cloth);
    edited.probes = probes_inside(edited.cloth, edited.probes);
  }
  if (const QString rule = broken_rule_of_probes(edited); !rule.isEmpty()) return rule;
  QString text = verb.arg(in_sentence(parameter->info.label));
  if (is_own) {
    set_own(after.panes[*scope_], path, value);
    text += tr(" of %1").arg(QString::fromStdString(after.panes[*scope_].name));
  } else {
    after.scene = std::move(edited);
  }
  push(text, std::move(after), {effect_of(parameter->info.cost), path}, drag_);
  return {};
}

/// Within a drag each edit starts from what was there before the drag, so that pins which a small grid lost
/// on the way are there again when the drag ends on a larger one.
Comparison LabDocument::comparisonBefore(const std::string& path) const {
  if (drag_ == 0 || undo_stack_.index() == 0 || undo_stack_.isClean()) return comparison_;
  const auto* last = dynamic_cast<const EditCommand*>(undo_stack_.command(undo_stack_.index() - 1));
  return last && last->belongs_to(drag_, path, scope_) ? last->before() : comparison_;
}

bool LabDocument::addBlock(const std::string& offer_path) {
  const Scene& shared = comparison_.scene;
  for (const cloth::BlockOffer& offer : offers_for(shared)) {
    if (offer.path != offer_path) continue;
    Scene after = shared;
    offer.add(after);
    const auto block = added_block(shared, after);
    if (!block) return false;
    pushShared(tr("Add %1").arg(in_sentence(offer.title)), std::move(after),
               {effect_of(*block), block->path});
    return true;
  }
  return false;
}

bool LabDocument::removeBlock(const std::string& block_path) {
  const auto block = find_block(comparison_.scene, block_path);
  if (!block || !block->removable) return false;
  Scene after = comparison_.scene;
  remove_block(after, block_path);
  pushShared(tr("Remove %1").arg(in_sentence(block->title)), std::move(after),
             {effect_of(*block), block_path});
  return true;
}

QString LabDocument::replaceScene(const QString& text, Scene after) {
  const Scene& shared = comparison_.scene;
  if (const auto problems = find_problems(after); !problems.empty())
    return QString::fromStdString(problems.front().text());
  const auto block = added_block(shared, after);
  const SceneChange::Effect effect =
      std::max(effect_between(shared, after), block ? Effect::restart : Effect::live);
  pushShared(text, std::move(after), {effect, block ? block->path : ""});
  return {};
}

QString LabDocument::setClothMesh(const std::string& file) {
  const Scene& shared = comparison_.scene;
  Scene after = shared;
  if (file.empty()) {
    after.cloth = grid_in_place_of(shared.cloth);
  } else {
    after.cloth.mesh.file = file;
    if (const QString rule = readMeshes(after); !rule.isEmpty()) return rule;
    after.cloth.pins.clear();
    after.cloth.origin = middle_of(shared.cloth) - after.cloth.mesh.loaded->bounds.center();
  }
  std::erase_if(after.probes,
                [](const cloth::Probe& probe) { return facts_of(probe.measure).is_of_particles(); });
  after.probes = probes_inside(after.cloth, after.probes);
  pushShared(file.empty() ? tr("Make the cloth a grid") : tr("Make the cloth a mesh"), std::move(after),
             {Effect::restart, "cloth.mesh"});
  return {};
}

void LabDocument::moveObstacle(int number, const cloth::Obstacle& moved) {
  const auto k = static_cast<std::size_t>(number);
  Scene after = comparison_.scene;
  if (k >= after.obstacles.size()) return;
  const std::string path = "obstacles." + std::to_string(k);
  after.obstacles[k] = moved;
  const QString text = tr("Move %1").arg(in_sentence(find_block(after, path)->title));
  pushShared(text, std::move(after), {Effect::live, path}, drag_);
}

void LabDocument::togglePin(int row, int column) {
  Scene after = comparison_.scene;
  const bool pinned = is_pinned(after.cloth, row, column);
  after.cloth.pins = toggled_pins(after.cloth, row, column);
  pushShared(pinned ? tr("Free particle") : tr("Pin particle"), std::move(after),
             {Effect::live, "cloth.pins"});
}

QString LabDocument::addProbe(cloth::Probe probe) {
  Scene after = comparison_.scene;
  if (probe.name.empty()) probe.name = free_probe_name(after.probes, probe.measure);
  const QString name = QString::fromStdString(probe.name);
  const std::string path = "probes." + std::to_string(after.probes.size());
  after.probes.push_back(std::move(probe));
  if (const QString rule = broken_rule_of_probes(after); !rule.isEmpty()) return rule;
  pushShared(tr("Add probe %1").arg(name), std::move(after), {Effect::live, path});
  return {};
}

QString LabDocument::setOwn(std::size_t pane, const std::string& path, const ParameterValue& value) {
  if (!isComparison()) return setParameter(path, value);
  const auto parameter = cloth::find_parameter(scene_of(comparison_, pane), path);
  if (!parameter) return tr("is not a parameter of this pane");
  if (const auto rule = broken_rule(parameter->info, value)) return QString::fromStdString(*rule);
  Comparison after = comparison_;
  set_own(after.panes[pane], path, value);
  push(tr("Change %1 of %2")
           .arg(in_sentence(parameter->info.label), QString::fromStdString(comparison_.panes[pane].name)),
       std::move(after), {effect_of(parameter->info.cost), path});
  return {};
}

void LabDocument::useShared(std::size_t pane, const std::string& path) {
  Comparison after = comparison_;
  set_shared(after.panes[pane], path);
  push(tr("Use the shared value in %1").arg(QString::fromStdString(comparison_.panes[pane].name)),
       std::move(after), {Effect::live, path});
}

void LabDocument::duplicatePane(std::size_t pane) {
  if (paneCount() >= cloth::max_panes) return;
  Comparison after = comparison_;
  const QString name = QString::fromStdString(after.panes[pane].name);
  if (!isComparison()) after.reference = after.panes[pane].name;
  duplicate_pane(after, pane);
  push(isComparison() ? tr("Duplicate pane %1").arg(name) : tr("Compare with a copy"), std::move(after), {});
}

void LabDocument::removePane(std::size_t pane) {
  if (!isComparison()) return;
  Comparison after = comparison_;
  remove_pane(after, pane);
  push(tr("Remove pane %1").arg(QString::fromStdString(comparison_.panes[pane].name)), std::move(after), {});
}

void LabDocument::setReference(const std::string& reference) {
  Comparison after = comparison_;
  after.reference = reference;
  push(tr("Change the reference"), std::move(after), {});
}

void LabDocument::setPaneTitle(std::size_t pane, const QString& title) {
  Comparison after = comparison_;
  after.panes[pane].title = title.toStdString();
  push(tr("Name pane %1").arg(QString::fromStdString(comparison_.panes[pane].name)), std::move(after), {});
}

void LabDocument::follow(const Comparison& run) {
  if (!have_same_panes(comparison_, run) || run_alike(comparison_, run)) return;
  drag_ = 0;
  Comparison after = comparison_;
  after.scene = run.scene;
  after.panes = run.panes;
  if (undo_stack_.count() == 0) return apply(after, {Effect::none, {}});
  Effect effect = Effect::live;
  for (std::size_t i = 0; i < paneCount(); ++i)
    effect = std::max(effect, effect_between(scene_of(comparison_, i), scene_of(after, i)));
  push(tr("Go to another time"), std::move(after), {effect, {}}, following);
}

void LabDocument::pushShared(const QString& text, Scene after, SceneChange change, int drag) {
  Comparison target = comparison_;
  target.scene = std::move(after);
  push(text, std::move(target), std::move(change), drag);
}

void LabDocument::push(const QString& text, Comparison after, SceneChange change, int drag) {
  make_consistent(after);
  if (after == comparison_) return;
  undo_stack_.push(new EditCommand(*this, text, std::move(after), std::move(change), drag));
}

void LabDocument::apply(const Comparison& target, const SceneChange& change) {
  // A copy, because a listener may edit again and so move the commands that own the arguments.
  const SceneChange announced = change;
  const QString title_before = title();
  const std::string scope_name = scope_ ? comparison_.panes[*scope_].name : "";
  const Scene before = std::move(scene_);
  comparison_ = target;
  const auto scope = scope_ && isComparison() ? find_pane(comparison_, scope_name) : std::nullopt;
  const bool is_other_scope = std::exchange(scope_, scope) != scope;
  scene_ = sceneOfScope();
  if (is_other_scope) {
    Q_EMIT scopeChanged();
  } else {
    if (!have_same_rows(before, scene_)) Q_EMIT blocksChanged();
    for (const std::string& path : differing_parameters(before, scene_)) Q_EMIT parameterChanged(path);
  }
  if (title() != title_before) Q_EMIT titleChanged();
  Q_EMIT sceneChanged(announced);
}

}  // namespace clothlab

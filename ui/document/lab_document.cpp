#include "document/lab_document.h"

#include <QFileInfo>
#include <algorithm>
#include <utility>

#include "document/cloth_edits.h"
#include "scene/scene_edits.h"

namespace clothlab {
namespace {

using cloth::Block;
using cloth::Kind;
using cloth::Parameter;
using cloth::ParameterInfo;
using cloth::ParameterValue;
using cloth::Scene;
using Effect = SceneChange::Effect;

constexpr int following = -1;  // the drag number of scenes that follow the run

Effect effect_of(cloth::EditCost cost) {
  return cost == cloth::EditCost::restart ? Effect::restart : Effect::live;
}

Effect effect_of(const Block& block) {
  const bool restart = std::any_of(block.parameters.begin(), block.parameters.end(), [](const Parameter& p) {
    return p.info.cost == cloth::EditCost::restart;
  });
  return restart ? Effect::restart : Effect::live;
}

std::optional<Block> find_block(const Scene& scene, const std::string& path) {
  for (Block& block : blocks_of(scene))
    if (block.path == path) return std::move(block);
  return std::nullopt;
}

/// The block that `after` has and `before` has not.
std::optional<Block> added_block(const Scene& before, const Scene& after) {
  for (Block& block : blocks_of(after))
    if (!find_block(before, block.path)) return std::move(block);
  return std::nullopt;
}

/// "must be ..." if the value is of another type than the parameter's.
QString broken_kind(const ParameterInfo& info, const ParameterValue& value) {
  if (info.auto_allowed && value == ParameterValue(std::string("auto"))) return {};
  const auto unless = [](bool holds, const char* rule) {
    return holds ? QString() : QString::fromLatin1(rule);
  };
  switch (info.kind) {
    case Kind::number:
      return unless(std::holds_alternative<double>(value), "must be a number");
    case Kind::integer:
      return unless(std::holds_alternative<std::int64_t>(value), "must be a whole number");
    case Kind::vector:
      return unless(std::holds_alternative<cloth::Vec3>(value), "must be three numbers");
    case Kind::choice:
    case Kind::text:
      return unless(std::holds_alternative<std::string>(value), "must be a text");
    case Kind::words:
      return unless(std::holds_alternative<cloth::Words>(value), "must be a list of words");
  }
  return {};
}

/// A label inside a sentence: "Structural stiffness" -> "structural stiffness"; abbreviations keep their
/// capitals.
QString in_sentence(const std::string& label) {
  QString text = QString::fromStdString(label);
  if (text.size() > 1 && text[1].isLower()) text[0] = text[0].toLower();
  return text;
}

std::vector<std::string> shape_of(const std::vector<Block>& blocks) {
  std::vector<std::string> names;
  for (const Block& block : blocks) {
    names.push_back(block.path + " " + block.title);
    for (const Parameter& parameter : block.parameters) names.push_back(parameter.path);
  }
  return names;
}

/// The parameters that both scenes have, with different values.
std::vector<std::string> differing_parameters(const Scene& before, const Scene& after) {
  const std::vector<Parameter> old_parameters = parameters_of(before);
  std::vector<std::string> paths;
  for (const Parameter& parameter : parameters_of(after)) {
    const auto same = std::find_if(old_parameters.begin(), old_parameters.end(),
                                   [&](const Parameter& old) { return old.path == parameter.path; });
    if (same != old_parameters.end() && same->get(before) != parameter.get(after))
      paths.push_back(parameter.path);
  }
  return paths;
}

}  // namespace

/// A scene is a small value, so a command keeps it whole before and after: undo is exact by construction.
class LabDocument::EditCommand : public QUndoCommand {
 public:
  EditCommand(LabDocument& document, const QString& text, Scene before, Scene after, SceneChange change,
              int drag)
      : QUndoCommand(text),
        document_(document),
        before_(std::move(before)),
        after_(std::move(after)),
        change_(std::move(change)),
        drag_(drag) {}

  void undo() override { document_.apply(before_, change_); }
  void redo() override {
    // The run already has this scene now; a later redo must apply it to the run.
    const bool is_in_force = std::exchange(is_new_, false) && drag_ == following;
    document_.apply(after_, is_in_force ? SceneChange{Effect::none, change_.path} : change_);
  }
  int id() const override { return 1; }

  bool mergeWith(const QUndoCommand* other) override {
    const auto* next = static_cast<const EditCommand*>(other);
    if (!belongs_to(next->drag_, next->change_.path)) return false;
    after_ = next->after_;
    change_.effect = std::max(change_.effect, next->change_.effect);
    setObsolete(after_ == before_);
    return true;
  }

  bool belongs_to(int drag, const std::string& path) const {
    return drag_ != 0 && drag_ == drag && change_.path == path;
  }
  const Scene& before() const { return before_; }

 private:
  LabDocument& document_;
  Scene before_, after_;
  SceneChange change_;
  int drag_;
  bool is_new_ = true;
};

LabDocument::LabDocument(QObject* parent) : Document(parent) {
  qRegisterMetaType<SceneChange>();
}

std::optional<ParameterValue> LabDocument::value(const std::string& path) const {
  const auto parameter = find_parameter(scene_, path);
  if (!parameter) return std::nullopt;
  return parameter->get(scene_);
}

QString LabDocument::title() const {
  if (!scene_.title.empty()) return QString::fromStdString(scene_.title);
  if (path().isEmpty()) return tr("Untitled");
  const QString name = QFileInfo(path()).fileName();
  return name.endsWith(".scene.json") ? name.chopped(11) : name;
}

void LabDocument::load(Scene scene, const QString& path) {
  drag_ = 0;
  scene_ = std::move(scene);
  beginHistory(path, false);
  Q_EMIT loaded();
  Q_EMIT titleChanged();
}

QString LabDocument::setParameter(const std::string& path, const ParameterValue& value) {
  return change(path, value, tr("Change %1"));
}

QString LabDocument::resetParameter(const std::string& path) {
  const auto value = cloth::default_of(scene_, path);
  if (!value) return tr("has no default");
  return change(path, *value, tr("Reset %1"));
}

QString LabDocument::change(const std::string& path, const ParameterValue& value, const QString& verb) {
  const auto parameter = find_parameter(scene_, path);
  if (!parameter) return tr("is not a parameter of this scene");
  if (const QString rule = broken_kind(parameter->info, value); !rule.isEmpty()) return rule;
  if (const auto rule = broken_rule(parameter->info, value)) return QString::fromStdString(*rule);
  if (parameter->get(scene_) == value) return {};

  Scene after = sceneBefore(path);
  parameter->set(after, value);
  if (const auto problems = load_meshes(after, &scene_); !problems.empty())
    return QString::fromStdString(problems.front().rule);
  if (after.cloth.rows != scene_.cloth.rows || after.cloth.columns != scene_.cloth.columns)
    after.cloth.pins = pins_inside(after.cloth);
  push(verb.arg(in_sentence(parameter->info.label)), std::move(after),
       {effect_of(parameter->info.cost), path}, drag_);
  return {};
}

/// Within a drag each edit starts from the scene before the drag, so that pins which a small grid lost on the
/// way are there again when the drag ends on a larger one.
const Scene& LabDocument::sceneBefore(const std::string& path) const {
  const QUndoStack& edits = undoStack();
  if (drag_ == 0 || edits.index() == 0 || edits.isClean()) return scene_;
  const auto* last = static_cast<const EditCommand*>(edits.command(edits.index() - 1));
  return last->belongs_to(drag_, path) ? last->before() : scene_;
}

bool LabDocument::addBlock(const std::string& offer_path) {
  for (const cloth::BlockOffer& offer : offers_for(scene_)) {
    if (offer.path != offer_path) continue;
    Scene after = scene_;
    offer.add(after);
    const auto block = added_block(scene_, after);
    if (!block) return false;
    push(tr("Add %1").arg(in_sentence(offer.title)), std::move(after), {effect_of(*block), block->path});
    return true;
  }
  return false;
}

bool LabDocument::removeBlock(const std::string& block_path) {
  const auto block = find_block(scene_, block_path);
  if (!block || !block->removable) return false;
  Scene after = scene_;
  remove_block(after, block_path);
  push(tr("Remove %1").arg(in_sentence(block->title)), std::move(after), {effect_of(*block), block_path});
  return true;
}

QString LabDocument::setClothMesh(const std::string& file) {
  Scene after = scene_;
  if (file.empty()) {
    after.cloth = grid_in_place_of(scene_.cloth);
  } else {
    after.cloth.mesh.file = file;
    if (const auto problems = load_meshes(after, &scene_); !problems.empty())
      return QString::fromStdString(problems.front().rule);
    after.cloth.pins.clear();
    after.cloth.origin = middle_of(scene_.cloth) - after.cloth.mesh.loaded->bounds.center();
  }
  push(file.empty() ? tr("Make the cloth a grid") : tr("Make the cloth a mesh"), std::move(after),
       {Effect::restart, "cloth.mesh"});
  return {};
}

void LabDocument::moveObstacle(int number, const cloth::Obstacle& moved) {
  const auto k = static_cast<std::size_t>(number);
  if (k >= scene_.obstacles.size()) return;
  const std::string path = "obstacles." + std::to_string(k);
  Scene after = scene_;
  after.obstacles[k] = moved;
  push(tr("Move %1").arg(in_sentence(find_block(scene_, path)->title)), std::move(after),
       {Effect::live, path}, drag_);
}

void LabDocument::togglePin(int row, int column) {
  const bool pinned = is_pinned(scene_.cloth, row, column);
  Scene after = scene_;
  after.cloth.pins = toggled_pins(scene_.cloth, row, column);
  push(pinned ? tr("Free particle") : tr("Pin particle"), std::move(after), {Effect::live, "cloth.pins"});
}

void LabDocument::follow(const Scene& scene) {
  if (edits_between(scene_, scene).empty()) return;
  drag_ = 0;
  if (undoStack().count() == 0) return apply(scene, {Effect::none, {}});
  Effect effect = Effect::live;
  for (const std::string& path : differing_parameters(scene_, scene))
    effect = std::max(effect, effect_of(find_parameter(scene, path)->info.cost));
  push(tr("Go to another time"), scene, {effect, {}}, following);
}

void LabDocument::push(const QString& text, Scene after, SceneChange change, int drag) {
  if (after == scene_) return;
  const Scene before = drag == following ? scene_ : sceneBefore(change.path);
  undoStack().push(new EditCommand(*this, text, before, std::move(after), std::move(change), drag));
}

void LabDocument::apply(const Scene& target, const SceneChange& change) {
  // A copy, because a listener may edit again and so move the commands that own the arguments.
  const SceneChange announced = change;
  const Scene before = std::exchange(scene_, target);
  if (shape_of(blocks_of(before)) != shape_of(blocks_of(scene_))) Q_EMIT blocksChanged();
  for (const std::string& path : differing_parameters(before, scene_)) Q_EMIT parameterChanged(path);
  if (before.title != scene_.title) Q_EMIT titleChanged();
  Q_EMIT sceneChanged(announced);
}

}  // namespace clothlab

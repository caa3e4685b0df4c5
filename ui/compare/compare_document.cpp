#include "compare/compare_document.h"

#include <QFileInfo>
#include <utility>

#include "document/cloth_edits.h"
#include "scene/scene_parameters.h"

namespace clothlab {
namespace {

using cloth::Comparison;
using cloth::ParameterValue;

/// Own values of parameters that went with their block or method go too.
void drop_orphans(Comparison& comparison) {
  for (std::size_t i = 0; i < comparison.panes.size(); ++i) {
    const cloth::Scene scene = scene_of(comparison, i);
    std::erase_if(comparison.panes[i].own,
                  [&](const cloth::OwnValue& own) { return !find_parameter(scene, own.path); });
  }
}

}  // namespace

/// A comparison is a small value, so a command keeps it whole before and after.
class CompareDocument::EditCommand : public QUndoCommand {
 public:
  EditCommand(CompareDocument& document, const QString& text, Comparison after, int drag, std::string place)
      : QUndoCommand(text),
        document_(document),
        before_(document.comparison_),
        after_(std::move(after)),
        drag_(drag),
        place_(std::move(place)) {}

  void undo() override { document_.apply(before_); }
  void redo() override { document_.apply(after_); }
  int id() const override { return 1; }

  bool mergeWith(const QUndoCommand* other) override {
    const auto* next = static_cast<const EditCommand*>(other);
    if (drag_ == 0 || drag_ != next->drag_ || place_ != next->place_) return false;
    after_ = next->after_;
    setObsolete(after_ == before_);
    return true;
  }

 private:
  CompareDocument& document_;
  Comparison before_, after_;
  int drag_;           ///< of the form; 0: none
  std::string place_;  ///< scope and parameter
};

CompareDocument::CompareDocument(QObject* parent) : Document(parent) {
  connect(&form_, &LabDocument::sceneChanged, this, &CompareDocument::takeFormEdit);
}

QString CompareDocument::title() const {
  if (!comparison_.title.empty()) return QString::fromStdString(comparison_.title);
  if (!comparison_.scene.title.empty()) return QString::fromStdString(comparison_.scene.title);
  return path().isEmpty() ? tr("Untitled") : QFileInfo(path()).baseName();
}

void CompareDocument::load(Comparison comparison, const QString& path, bool unsaved) {
  comparison_ = std::move(comparison);
  beginHistory(path, unsaved);
  scope_.reset();
  showScope();
  Q_EMIT loaded();
  Q_EMIT scopeChanged();
  Q_EMIT titleChanged();
}

void CompareDocument::setScope(std::optional<std::size_t> pane) {
  if (pane == scope_) return;
  scope_ = pane;
  showScope();
  Q_EMIT scopeChanged();
}

void CompareDocument::showScope() {
  const cloth::Scene scene = scope_ ? scene_of(comparison_, *scope_) : comparison_.scene;
  if (form_.scene() == scene) return;
  form_.load(scene);
}

/// What the form did to its scene, done to the comparison.
void CompareDocument::takeFormEdit(const SceneChange& change) {
  Comparison after = comparison_;
  const auto parameter = cloth::find_parameter(form_.scene(), change.path);
  QString text = tr("Change the scene");
  if (parameter) text = tr("Change %1").arg(QString::fromStdString(parameter->info.label).toLower());
  if (!scope_) {
    after.scene = form_.scene();
  } else if (parameter && !cloth::must_be_shared(change.path)) {
    set_own(after.panes[*scope_], change.path, parameter->get(form_.scene()));
    text += tr(" of %1").arg(QString::fromStdString(after.panes[*scope_].name));
  } else {
    if (parameter) set_shared_value(after, change.path, parameter->get(form_.scene()));
    after.scene.cloth.pins = form_.scene().cloth.pins;
  }
  const std::string place = (scope_ ? after.panes[*scope_].name : "") + "/" + change.path;
  const bool was_following = std::exchange(following_form_, true);
  push(text, std::move(after), form_.presentDrag(), place);
  following_form_ = was_following;
}

QString CompareDocument::setOwn(std::size_t pane, const std::string& path, const ParameterValue& value) {
  const auto parameter = cloth::find_parameter(scene_of(comparison_, pane), path);
  if (!parameter) return tr("is not a parameter of this pane");
  if (const auto rule = broken_rule(parameter->info, value)) return QString::fromStdString(*rule);
  Comparison after = comparison_;
  set_own(after.panes[pane], path, value);
  push(tr("Change %1 of %2")
           .arg(QString::fromStdString(parameter->info.label).toLower(),
                QString::fromStdString(comparison_.panes[pane].name)),
       std::move(after));
  return {};
}

void CompareDocument::useShared(std::size_t pane, const std::string& path) {
  Comparison after = comparison_;
  set_shared(after.panes[pane], path);
  push(tr("Use the shared value in %1").arg(QString::fromStdString(comparison_.panes[pane].name)),
       std::move(after));
}

void CompareDocument::duplicatePane(std::size_t pane) {
  if (paneCount() >= cloth::max_panes) return;
  Comparison after = comparison_;
  duplicate_pane(after, pane);
  push(tr("Duplicate pane %1").arg(QString::fromStdString(comparison_.panes[pane].name)), std::move(after));
}

void CompareDocument::removePane(std::size_t pane) {
  if (paneCount() <= cloth::least_panes) return;
  Comparison after = comparison_;
  remove_pane(after, pane);
  push(tr("Remove pane %1").arg(QString::fromStdString(comparison_.panes[pane].name)), std::move(after));
}

void CompareDocument::setReference(const std::string& reference) {
  Comparison after = comparison_;
  after.reference = reference;
  push(tr("Change the reference"), std::move(after));
}

void CompareDocument::togglePin(int row, int column) {
  Comparison after = comparison_;
  after.scene.cloth.pins = toggled_pins(comparison_.scene.cloth, row, column);
  push(is_pinned(comparison_.scene.cloth, row, column) ? tr("Free particle") : tr("Pin particle"),
       std::move(after));
}

void CompareDocument::push(const QString& text, Comparison after, int drag, const std::string& place) {
  drop_orphans(after);
  if (after == comparison_) return;
  undoStack().push(new EditCommand(*this, text, std::move(after), drag, place));
}

void CompareDocument::apply(const Comparison& target) {
  std::string scope_name;
  if (scope_) scope_name = comparison_.panes[*scope_].name;
  comparison_ = target;
  const auto scope = scope_ ? find_pane(comparison_, scope_name) : scope_;
  const bool moved = scope != scope_;
  scope_ = scope;
  if (!following_form_) showScope();
  Q_EMIT changed();
  if (moved) Q_EMIT scopeChanged();
}

}  // namespace clothlab

// The scene being edited, its file and its undo history. All other parts of the window read the scene from
// here. Every edit is an undoable command, and every change, undo and redo included, emits the same signals.
// It depends on no worker and no widget.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "document/document.h"
#include "scene/scene.h"
#include "scene/scene_parameters.h"

namespace clothlab {

/// How a running simulation applies an edit, from ParameterInfo::cost: a live edit before the next step, a
/// restart by starting again at t = 0. Adding or removing a block is a restart if an edit of one of its
/// parameters is.
struct SceneChange {
  /// `none`: the run already has the change, see LabDocument::follow().
  enum class Effect { none, live, restart } effect = Effect::live;
  std::string path;  ///< of the parameter or block; "cloth.pins" for pins; empty after follow()
};

class LabDocument : public Document {
  Q_OBJECT

 public:
  explicit LabDocument(QObject* parent = nullptr);

  const cloth::Scene& scene() const { return scene_; }
  /// The value at `path`, if the scene has that parameter.
  std::optional<cloth::ParameterValue> value(const std::string& path) const;

  QString title() const override;
  LabDocument& form() override { return *this; }

  /// Replaces the scene and clears the undo history.
  void load(cloth::Scene scene, const QString& path = {});

  /// Changes one parameter. On error returns the rule that `value` breaks ("must be >= 0") and changes
  /// nothing; returns an empty string on success. Setting an equal value is not an edit.
  QString setParameter(const std::string& path, const cloth::ParameterValue& value);
  /// Sets the declared default, if there is one. Returns like setParameter().
  QString resetParameter(const std::string& path);

  /// Between beginDrag() and endDrag(), all edits of one parameter are one undo step, or none if the value
  /// ends where it began.
  void beginDrag() { drag_ = ++last_drag_; }
  void endDrag() { drag_ = 0; }
  int presentDrag() const { return drag_; }  ///< number of the present drag; 0: none

  /// Adds the block of a cloth::BlockOffer with this path ("air", "sphere"); false if the scene has no such
  /// offer.
  bool addBlock(const std::string& offer_path);
  /// Removes the removable cloth::Block with this path; false if there is none.
  bool removeBlock(const std::string& block_path);

  /// Replaces the cloth by a mesh, or by a grid if `file` is empty, at about the same place and without pins.
  /// On error returns why the file cannot be used and changes nothing; returns an empty string on success.
  QString setClothMesh(const std::string& file);

  /// Replaces the obstacle with index `number` by `moved`, as a live edit; within a drag all moves are one
  /// undo step. `moved` must satisfy the rules of the block's parameters.
  void moveObstacle(int number, const cloth::Obstacle& moved);

  /// Pins a free particle or frees a pinned one; see toggled_pins().
  void togglePin(int row, int column);

  /// Adopts the scene of a run that has moved in its own history. Consecutive calls are one undo step, or
  /// none if the scene ends where it began. If there are no edits to undo, as after opening a session, the
  /// scene is replaced without an undo step.
  void follow(const cloth::Scene& scene);

 Q_SIGNALS:
  void parameterChanged(const std::string& path);
  void blocksChanged();  ///< blocks or parameters were added or removed; emitted before parameterChanged of
                         ///< the same edit
  void sceneChanged(const clothlab::SceneChange&
                        change);  ///< emitted once for each edit, undo and redo, after the other signals

 private:
  class EditCommand;

  void apply(const cloth::Scene& target, const SceneChange& change);
  void push(const QString& text, cloth::Scene after, SceneChange change, int drag = 0);
  QString change(const std::string& path, const cloth::ParameterValue& value, const QString& verb);
  const cloth::Scene& sceneBefore(const std::string& path) const;

  cloth::Scene scene_;
  int drag_ = 0;  ///< number of the present drag; 0: none
  int last_drag_ = 0;
};

}  // namespace clothlab

Q_DECLARE_METATYPE(clothlab::SceneChange)

// The one home for state: the scene being edited, its file and its undo history. Every edit is an undoable
// command, and every change, undo and redo included, is announced by the same signals. It knows no worker and
// no widget.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "document/document.h"
#include "scene/scene.h"
#include "scene/scene_parameters.h"

namespace clothlab {

/// What an edit asks of a running simulation, from ParameterInfo::cost: the next step takes a live edit over,
/// a restart needs a new start. A block that comes or goes demands a restart if one of its parameters does.
struct SceneChange {
  /// `none`: the run has it already, see LabDocument::follow().
  enum class Effect { none, live, restart } effect = Effect::live;
  std::string path;  ///< of the parameter or block; "cloth.pins" for pins; empty for a scene followed
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

  /// Takes another scene over and forgets the history.
  void load(cloth::Scene scene, const QString& path = {});

  /// Changes one parameter. Returns the rule that `value` breaks ("must be >= 0") and then changes nothing;
  /// returns an empty string when done. An equal value is no edit.
  QString setParameter(const std::string& path, const cloth::ParameterValue& value);
  /// Back to the declared default, as far as there is one.
  QString resetParameter(const std::string& path);

  /// Between the two, edits of one parameter are one undo step, and none at all if the value comes back.
  void beginDrag() { drag_ = ++last_drag_; }
  void endDrag() { drag_ = 0; }
  int presentDrag() const { return drag_; }  ///< its number; 0: none

  /// By the path of a cloth::BlockOffer ("air", "sphere"); false if the scene is not offered it.
  bool addBlock(const std::string& offer_path);
  /// By the path of a removable cloth::Block; false if there is none.
  bool removeBlock(const std::string& block_path);

  /// Makes the cloth a mesh, or with no file a grid, about where the cloth was and without pins. Returns why
  /// a file cannot be used, and then changes nothing.
  QString setClothMesh(const std::string& file);

  /// The obstacle of this number is now where, and what, `moved` says: a live edit, which a drag makes one
  /// undo step of. Of its block's parameters it must keep the rules.
  void moveObstacle(int number, const cloth::Obstacle& moved);

  /// Pins a free particle and frees a pinned one; see toggled_pins().
  void togglePin(int row, int column);

  /// Takes up the scene of a run that has gone back or forth in its own history: one undo step, however often
  /// it goes to and fro, and none if it comes back to where it was. Without edits to undo, as after opening a
  /// session, the document just becomes that scene.
  void follow(const cloth::Scene& scene);

 Q_SIGNALS:
  void parameterChanged(const std::string& path);
  void
  blocksChanged();  ///< blocks or parameters came or went; comes before parameterChanged of the same edit
  void sceneChanged(const clothlab::SceneChange& change);  ///< once for each edit, undo and redo; last

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

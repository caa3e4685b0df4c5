// The document of a window: a scene, or a comparison of two to four panes, with its file and its undo
// history. A scene is a comparison with one pane, which has no values of its own. All other parts of the
// window read it from here. Every edit is an undoable command, and every change, undo and redo included,
// emits the same signals. The form edits one scene at a time, that of the scope: what all panes share, or one
// pane's; an edit of a pane's scene becomes the pane's own value. It depends on no worker and no widget; GUI
// thread only.
#pragma once

#include <QObject>
#include <QUndoStack>
#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "compare/comparison.h"
#include "document/scene_change.h"

namespace clothlab {

class VariedRanges;

class LabDocument : public QObject {
  Q_OBJECT

 public:
  explicit LabDocument(QObject* parent = nullptr);
  ~LabDocument() override;

  // --- File and undo history ---

  QUndoStack& undoStack() { return undo_stack_; }
  const QUndoStack& undoStack() const { return undo_stack_; }
  /// Of the file; empty for a built-in document, for one that was never saved, and for a scene that became a
  /// comparison since, or a comparison that became a scene.
  QString path() const { return path_is_comparison_ == isComparison() ? path_ : QString(); }
  /// The document's title, else the file's name, else "Untitled".
  QString title() const;
  bool isModified() const;
  /// Records that the file `path` contains the document as it is now.
  void markSaved(const QString& path);

  // --- Content ---

  const cloth::Comparison& comparison() const { return comparison_; }
  bool isLoaded() const { return loaded_; }  ///< false until the first load()
  std::size_t paneCount() const { return comparison_.panes.size(); }
  bool isComparison() const { return paneCount() > 1; }
  /// The scene that the form edits: that of the scope.
  const cloth::Scene& scene() const { return scene_; }
  /// Whose scene that is: a pane's index, or nothing for what all panes share. In a scene always nothing.
  std::optional<std::size_t> scope() const { return scope_; }
  void setScope(std::optional<std::size_t> pane);
  /// The value at `path`, if the scene has that parameter.
  std::optional<cloth::ParameterValue> value(const std::string& path) const;

  /// Replaces the content and clears the undo history. `unsaved`: no file contains it yet.
  void load(cloth::Scene scene, const QString& path = {}, bool unsaved = false);
  void load(cloth::Comparison comparison, const QString& path = {}, bool unsaved = false);

  /// What a sweep of the scene in scope would vary.
  VariedRanges& varied() { return *varied_; }

  // --- Edits of the scene in scope ---

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

  /// Reads the meshes that an edit newly names, in place of cloth::load_meshes(): as that does, or beside the
  /// window.
  using MeshReader =
      std::function<std::vector<cloth::Problem>(cloth::Scene& scene, const cloth::Scene& known)>;
  void setMeshReader(MeshReader reader) { mesh_reader_ = std::move(reader); }

  // --- Edits of what all panes share ---

  /// Adds the block of a cloth::BlockOffer with this path ("air", "sphere"); false if the scene has no such
  /// offer.
  bool addBlock(const std::string& offer_path);
  /// Removes the removable cloth::Block with this path; false if there is none.
  bool removeBlock(const std::string& block_path);
  /// Replaces the scene by another of the same title and folder, as one undo step: another material, or
  /// springs in place of one. On error returns what is wrong with it and changes nothing; returns an empty
  /// string on success.
  QString replaceScene(const QString& text, cloth::Scene after);
  /// Replaces the cloth by a mesh, or by a grid if `file` is empty, at about the same place and without pins.
  /// On error returns why the file cannot be used and changes nothing; returns an empty string on success.
  QString setClothMesh(const std::string& file);
  /// Replaces the obstacle with index `number` by `moved`, as a live edit; within a drag all moves are one
  /// undo step. `moved` must satisfy the rules of the block's parameters.
  void moveObstacle(int number, const cloth::Obstacle& moved);
  /// Pins a free particle or frees a pinned one; see toggled_pins().
  void togglePin(int row, int column);
  /// Adds a probe, with a name of its own where it has none. On error returns what is wrong with it and
  /// changes nothing; returns an empty string on success.
  QString addProbe(cloth::Probe probe);

  // --- Panes ---

  /// Sets the pane's own value; in a scene the scene's. Returns like setParameter().
  QString setOwn(std::size_t pane, const std::string& path, const cloth::ParameterValue& value);
  /// Removes the pane's own value, so that it has the shared one.
  void useShared(std::size_t pane, const std::string& path);
  /// Adds a copy of the pane after it; nothing if there are max_panes. A scene becomes a comparison, measured
  /// against what was there.
  void duplicatePane(std::size_t pane);
  /// Nothing if it is the only one. The last one that stays is a scene.
  void removePane(std::size_t pane);
  void setReference(const std::string& reference);
  /// What the pane is called beside its letter; empty: its method.
  void setPaneTitle(std::size_t pane, const QString& title);

  /// Adopts what the run has in force after it has moved in its own history. Consecutive calls are one undo
  /// step, or none if the document ends where it began. If there are no edits to undo, as after opening a
  /// session, the document is replaced without an undo step.
  void follow(const cloth::Comparison& run);

 Q_SIGNALS:
  void loaded();  ///< the whole content was replaced; no other signal is emitted for it
  void titleChanged();
  void modifiedChanged(bool modified);
  void scopeChanged();  ///< the form has another scene to edit; also when the scope's pane went
  void parameterChanged(const std::string& path);
  void blocksChanged();  ///< blocks or parameters were added or removed; emitted before parameterChanged of
                         ///< the same edit
  void sceneChanged(const clothlab::SceneChange& change);  ///< emitted once for each edit, undo and redo,
                                                           ///< after the other signals

 private:
  class EditCommand;

  QString readMeshes(cloth::Scene& edited) const;
  QString change(const std::string& path, const cloth::ParameterValue& value, const QString& verb);
  cloth::Comparison comparisonBefore(const std::string& path) const;
  void pushShared(const QString& text, cloth::Scene after, SceneChange change, int drag = 0);
  void push(const QString& text, cloth::Comparison after, SceneChange change, int drag = 0);
  void apply(const cloth::Comparison& target, const SceneChange& change);
  cloth::Scene sceneOfScope() const;
  void setUnsaved(bool unsaved);
  void noteModified();

  QString path_;
  bool path_is_comparison_ = false;
  bool unsaved_ = false, loaded_ = false;
  bool announced_modified_ = false;
  QUndoStack undo_stack_;
  MeshReader mesh_reader_;
  cloth::Comparison comparison_;
  std::optional<std::size_t> scope_;
  cloth::Scene scene_;  ///< of the scope
  int drag_ = 0;        ///< number of the present drag; 0: none
  int last_drag_ = 0;
  std::unique_ptr<VariedRanges> varied_;
};

}  // namespace clothlab

// The comparison being edited, its file and its undo history. Every edit is an undoable command. The form
// edits one scene at a time, that of the scope: what all panes share, or one pane's; an edit of a pane's
// becomes its own value.
#pragma once

#include <optional>

#include "compare/comparison.h"
#include "document/lab_document.h"

namespace clothlab {

class CompareDocument : public Document {
  Q_OBJECT

 public:
  explicit CompareDocument(QObject* parent = nullptr);

  const cloth::Comparison& comparison() const { return comparison_; }
  std::size_t paneCount() const { return comparison_.panes.size(); }
  QString title() const override;

  /// Replaces the comparison and clears the undo history. `unsaved`: no file contains it yet.
  void load(cloth::Comparison comparison, const QString& path = {}, bool unsaved = false);

  /// The scene that the form edits, and whose it is: a pane's index, or nothing for what all share.
  LabDocument& form() override { return form_; }
  std::optional<std::size_t> scope() const { return scope_; }
  void setScope(std::optional<std::size_t> pane);

  /// Sets the pane's own value. On error returns the rule that the value breaks; an empty string on success.
  QString setOwn(std::size_t pane, const std::string& path, const cloth::ParameterValue& value);
  /// Removes the pane's own value, so that it has the shared one.
  void useShared(std::size_t pane, const std::string& path);
  void duplicatePane(std::size_t pane);  ///< nothing if there are max_panes
  void removePane(std::size_t pane);     ///< nothing if there are least_panes
  void setReference(const std::string& reference);
  void togglePin(int row, int column);

 Q_SIGNALS:
  void changed();       ///< by an edit, undo or redo
  void scopeChanged();  ///< also when the scope's pane went

 private:
  class EditCommand;

  void takeFormEdit(const SceneChange& change);
  void push(const QString& text, cloth::Comparison after, int drag = 0, const std::string& place = {});
  void apply(const cloth::Comparison& target);
  void showScope();

  cloth::Comparison comparison_;
  LabDocument form_;
  std::optional<std::size_t> scope_;
  bool following_form_ = false;  ///< the form's scene already has the edit
};

}  // namespace clothlab

// The parameters that the next sweep varies, each with its range: chosen in the form, taken by the Studies
// dock. They belong to the document's undo history, but not to what a file of it contains.
#pragma once

#include <QObject>
#include <QUndoCommand>
#include <optional>
#include <string>
#include <vector>

#include "params/parameter.h"
#include "report/axis.h"

namespace clothlab {

class LabDocument;

/// An edit of something beside the scene: the document is as saved as before.
class SideCommand : public QUndoCommand {
 public:
  using QUndoCommand::QUndoCommand;
};

struct VariedRange {
  std::string path;
  double from = 0, to = 1;  ///< from < to, in the parameter's unit
  int count = 9;            ///< values from end to end
  cloth::AxisScale scale = cloth::AxisScale::linear;
  bool operator==(const VariedRange&) const = default;
};

/// Whether a parameter can be: a number whose declaration has a range.
bool can_be_varied(const cloth::ParameterInfo& info);

class VariedRanges : public QObject {
  Q_OBJECT

 public:
  static constexpr std::size_t most = 6;  ///< parameters
  static constexpr int most_values = 1000;

  /// The document must outlive it.
  explicit VariedRanges(LabDocument& document);

  /// Those whose parameter the scene in scope has, in the order in which they were chosen.
  std::vector<VariedRange> list() const;
  std::optional<VariedRange> find(const std::string& path) const;

  /// Begins to vary a number, around its present value. Nothing where it is varied already, is no number, or
  /// where there are `most`.
  void add(const std::string& path);
  void remove(const std::string& path);
  /// Another range of a varied parameter. Returns the rule that it breaks, and then changes nothing. Within a
  /// drag of the document all changes are one undo step.
  QString set(const VariedRange& range);

 Q_SIGNALS:
  void changed();
  void added(const std::string& path);  ///< by add(), not by undo and redo

 private:
  class Command;
  void push(const QString& text, std::vector<VariedRange> after, int drag);
  QString label(const std::string& path) const;

  LabDocument& document_;
  std::vector<VariedRange> all_;
};

}  // namespace clothlab

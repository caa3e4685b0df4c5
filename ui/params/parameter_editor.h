// The form of one parameter: label, control, reset button, a line for a note, and messages over them.
#pragma once

#include <QList>
#include <QPointer>
#include <QWidget>
#include <functional>
#include <optional>
#include <string>

#include "document/lab_document.h"

class QHBoxLayout;
class QLabel;
class QToolButton;
class QVBoxLayout;

namespace clothlab {

class ElidedLabel;
class ExactField;
class MessageBubble;
class ValueSlider;

class ParameterEditor : public QWidget {
  Q_OBJECT

 public:
  ~ParameterEditor() override;

  const std::string& path() const { return parameter_.path; }

  /// Whether title, path and help text together have every one of these words.
  bool matches(const QStringList& words) const;

  /// Shows the document's value and discards text that was not accepted.
  void refresh();
  /// Reads the default again; an obstacle's default depends on the size of the cloth.
  void refreshDefault();
  void setNote(const QString& note, const QString& button = {});
  /// For the only parameter of a section, whose header shows label and unit.
  virtual void hideTitle() { title_->hide(); }

  /// The widgets of the tab order.
  virtual QList<QWidget*> tabStops() const = 0;
  /// Discards text being typed, because the editor is about to be deleted.
  virtual void abandonEdits() {}

 Q_SIGNALS:
  void noteButtonClicked();
  void tabStopsChanged();

 protected:
  ParameterEditor(LabDocument& document, cloth::Parameter parameter, QWidget* parent);

  virtual void showValue(const cloth::ParameterValue& value) = 0;
  virtual void showDefault(const std::optional<cloth::ParameterValue>&) {}
  virtual void markInvalid(bool) {}

  /// Sets the value in the document. If it breaks a rule, shows the rule at the control and returns false. A
  /// value beyond all sense is set, with a warning.
  bool commit(const cloth::ParameterValue& value);
  void showRule(const QString& rule);     ///< empty: none
  void showMessage(const QString& rule);  ///< likewise, about another part than the value

  const cloth::ParameterInfo& info() const { return parameter_.info; }
  LabDocument& document() { return document_; }
  std::optional<cloth::ParameterValue> value() const { return document_.value(path()); }

  const cloth::Parameter& parameter() const { return parameter_; }
  QHBoxLayout& titleRow() { return *title_row_; }
  QHBoxLayout& titleEnd() { return *title_end_; }  ///< above the reset button
  QHBoxLayout& controlRow() { return *control_row_; }
  QToolButton& resetButton() const { return *reset_; }
  /// A drag of the slider, and a run of steps by key in the field, are one undo step each.
  void connectParts(ValueSlider* slider, ExactField* field, std::function<void(double position)> move,
                    std::function<void(int steps)> step);
  /// Sets the names by which screen readers and tests know a part; its tooltip follows with the default.
  void name(QWidget& part, const QString& object_name, const QString& suffix = {});

 private:
  void makeTitle(QVBoxLayout& column);
  void makeReset();
  void makeNote(QVBoxLayout& column);
  void markDoubt(const cloth::ParameterValue& value);

  LabDocument& document_;
  cloth::Parameter parameter_;
  std::optional<cloth::ParameterValue> default_;
  QWidget* title_ = nullptr;
  QHBoxLayout *title_row_ = nullptr, *title_end_ = nullptr;
  QHBoxLayout* control_row_ = nullptr;
  ElidedLabel* label_ = nullptr;
  QList<QWidget*> named_;
  QToolButton* reset_ = nullptr;
  QLabel* doubt_ = nullptr;
  QPointer<MessageBubble> message_;  ///< over the form, whose content owns it
  QLabel* note_ = nullptr;
  QToolButton* note_button_ = nullptr;
  bool stepping_ = false;
};

/// The editor for the parameter's kind.
ParameterEditor* make_editor(LabDocument& document, const cloth::Parameter& parameter, QWidget* parent);

}  // namespace clothlab

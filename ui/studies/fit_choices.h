// The form of a fit: the measured table, which of its columns is what, and the parameters to find with their
// bounds.
#pragma once

#include <QWidget>
#include <optional>
#include <variant>

#include "document/lab_document.h"
#include "studies/measured_table.h"
#include "study/identify/identify.h"

class QComboBox;
class QLabel;

namespace clothlab {

class VariedList;

class FitChoices : public QWidget {
  Q_OBJECT

 public:
  explicit FitChoices(LabDocument& document, QWidget* parent = nullptr);

  void refresh();
  /// Takes a CSV file. Where the measured column is not named as one of the record, it is likely of `column`.
  /// Empty, or what is wrong with it.
  QString openTable(const QString& file, const std::string& column = {});
  bool hasTable() const { return table_.has_value(); }
  const QString& tableFile() const { return table_file_; }

  /// The measured curve as chosen, or a sentence that says what is missing.
  std::variant<cloth::FittedCurve, QString> curve() const;
  /// The plan, or such a sentence.
  std::variant<cloth::IdentifyPlan, QString> plan() const;

 Q_SIGNALS:
  void changed();

 private:
  QComboBox* makeChoice(const char* name, const QString& label, const QString& tip);
  void chooseFile();
  void offerColumns();
  void offerQuantities(const std::string& column);

  LabDocument& document_;
  std::optional<MeasuredTable> table_;
  QString table_file_;
  QLabel *file_ = nullptr, *problem_ = nullptr;
  QComboBox *time_ = nullptr, *value_ = nullptr, *quantity_ = nullptr, *sigma_ = nullptr;
  VariedList* varied_ = nullptr;
};

}  // namespace clothlab

// The range of a varied parameter: two fields for its ends, the number of values, their scale, and a cross
// that ends the variation. In the form a slider with two handles stands above them; in the Studies dock the
// parameter's name.
#pragma once

#include <QWidget>
#include <string>

#include "document/lab_document.h"
#include "document/varied_ranges.h"
#include "params/slider_scale.h"

class QCheckBox;
class QSpinBox;
class QVBoxLayout;

namespace clothlab {

class ExactField;
class RangeSlider;

class RangeRow : public QWidget {
  Q_OBJECT

 public:
  enum class Place { form, dock, fit };  ///< of a fit a range is bounds alone: no values between them

  /// Precondition: the scene has the parameter, a number. It shows nothing until it is varied.
  RangeRow(LabDocument& document, const cloth::Parameter& parameter, Place place, QWidget* parent = nullptr);

  const std::string& path() const { return path_; }
  /// Shows the document's range, and where the present value is.
  void refresh();
  QList<QWidget*> tabStops() const;
  void abandonEdits();

 Q_SIGNALS:
  void ruleBroken(const QString& rule);  ///< by what was typed; empty: no longer

 private:
  void makeSlider();
  void makeFields(QLayout& column);
  void arrange(QVBoxLayout& column);
  void connectField(ExactField* field, double VariedRange::*end);
  void put(VariedRange range);
  void typed(ExactField* field, double VariedRange::*end, const QString& text);

  LabDocument& document_;
  std::string path_, unit_;
  QString label_;
  SliderScale scale_;
  RangeSlider* slider_ = nullptr;
  ExactField *from_ = nullptr, *to_ = nullptr;
  QSpinBox* count_ = nullptr;
  QCheckBox* logarithmic_ = nullptr;
  QWidget* cross_ = nullptr;
  bool stepping_ = false;
};

}  // namespace clothlab

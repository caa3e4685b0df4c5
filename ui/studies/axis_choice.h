// One axis of a stability map: which parameter, from where to where, how many values.
#pragma once

#include <QWidget>
#include <vector>

#include "study/study_axis.h"

class QCheckBox;
class QComboBox;
class QLineEdit;
class QSpinBox;

namespace clothlab {

class AxisChoice : public QWidget {
  Q_OBJECT

 public:
  explicit AxisChoice(QWidget* parent = nullptr);

  /// Offers the scene's numeric parameters and shows `axis`.
  void setScene(const cloth::Scene& scene, const cloth::StudyAxis& axis);

  /// As typed; low and high are NaN where a field is no number.
  cloth::StudyAxis axis() const;

 private:
  void show(const cloth::StudyAxis& axis);
  void chooseParameter(int index) { show(offers_[static_cast<std::size_t>(index)]); }

  QComboBox* parameter_;
  QLineEdit *low_, *high_;
  QSpinBox* count_;
  QCheckBox* logarithmic_;
  std::vector<cloth::StudyAxis> offers_;  ///< what each parameter begins with
};

}  // namespace clothlab

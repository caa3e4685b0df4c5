// One axis of a stability map in the form of the Studies dock.
#pragma once

#include <QWidget>
#include <vector>

#include "study/study_axis.h"

class QCheckBox;
class QComboBox;
class QLineEdit;
class QSpinBox;

namespace clothlab {

/// Which parameter, from where to where, how many values. Suggests them from the scene, and changes nothing
/// that the user has set; choosing the parameter anew asks for its suggestion.
class AxisChoice : public QWidget {
  Q_OBJECT

 public:
  explicit AxisChoice(QWidget* parent = nullptr);

  /// Offers the scene's numeric parameters and suggests `axis`.
  void setScene(const cloth::Scene& scene, const cloth::StudyAxis& axis);
  /// What is shown counts as set by the user from now on.
  void keep();

  /// As typed; low and high are NaN where a field is no number.
  cloth::StudyAxis axis() const;

 Q_SIGNALS:
  void changed();

 private:
  struct Offer {
    QString name;
    cloth::StudyAxis axis;  ///< what the parameter begins with
    std::string unit;
  };
  /// What the user has set. Both ends of the range go together.
  struct Own {
    bool parameter = false, range = false, count = false, scale = false;
  };

  static std::vector<Offer> offersOf(const cloth::Scene& scene, const cloth::StudyAxis& axis);
  void offer(std::vector<Offer> offers, std::size_t shown);
  void suggest(const cloth::StudyAxis& axis);
  void chooseParameter(int index);
  void note(bool Own::*set);

  QComboBox* parameter_;
  QLineEdit *low_, *high_;
  QSpinBox* count_;
  QCheckBox* logarithmic_;
  std::vector<Offer> offers_;
  Own own_;
  bool suggesting_ = false;
};

}  // namespace clothlab

// What a study of grid convergence reads off its runs: a line to type in, and a menu of all that there is.
#pragma once

#include <QWidget>
#include <string>
#include <vector>

#include "scene/scene.h"

class QLineEdit;
class QMenu;

namespace clothlab {

class OutputsChoice : public QWidget {
  Q_OBJECT

 public:
  explicit OutputsChoice(QWidget* parent = nullptr);

  /// Whose quantities the menu offers, when it is opened.
  void setScene(const cloth::Scene& scene) { scene_ = scene; }

  /// As typed or chosen, see study/run_output.h; empty: the usual ones.
  std::vector<std::string> outputs() const;

 Q_SIGNALS:
  void changed();

 private:
  void fillMenu();
  void toggle(const std::string& output);

  cloth::Scene scene_;
  QLineEdit* line_;
  QMenu* menu_;
};

}  // namespace clothlab

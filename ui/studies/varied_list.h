// The varied parameters with their ranges, and a menu of all that can be varied: of a sweep, and of a fit,
// where the ranges are the bounds.
#pragma once

#include <QWidget>
#include <vector>

#include "document/lab_document.h"
#include "params/range_row.h"

class QLabel;
class QMenu;
class QVBoxLayout;

namespace clothlab {

class VariedList : public QWidget {
  Q_OBJECT

 public:
  VariedList(LabDocument& document, RangeRow::Place place, QWidget* parent = nullptr);

  /// The document's scene, or what is varied of it, is another one.
  void refresh();

 Q_SIGNALS:
  void changed();
  void ruleBroken(const QString& rule);  ///< by what was typed; empty: no longer

 private:
  void fillMenu();
  void rebuild();

  LabDocument& document_;
  RangeRow::Place place_;
  std::vector<RangeRow*> rows_;
  QVBoxLayout* ranges_ = nullptr;
  QLabel* hint_ = nullptr;
  QMenu* menu_ = nullptr;
};

}  // namespace clothlab

// What a grid cloth is made of, and the way to make it a mesh instead; a mesh has an editor of its own.
#pragma once

#include <QWidget>

#include "document/lab_document.h"

class QLabel;

namespace clothlab {

class MeshButton;

class ClothShapeRow : public QWidget {
  Q_OBJECT

 public:
  explicit ClothShapeRow(LabDocument& document, QWidget* parent = nullptr);
  QWidget* tabStop() const;

 private:
  void choose(const std::string& file);

  LabDocument& document_;
  MeshButton* button_;
  QLabel* rule_;
};

}  // namespace clothlab

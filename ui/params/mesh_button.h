// A button with a menu of meshes: the built-in ones and any OBJ file; and the form row of a grid cloth that
// contains it.
#pragma once

#include <QToolButton>
#include <string>

#include "document/lab_document.h"

class QAction;
class QLabel;

namespace clothlab {

class MeshButton : public QToolButton {
  Q_OBJECT

 public:
  /// The folder that files are named from is that of the document's scene.
  explicit MeshButton(const LabDocument& document, QWidget* parent = nullptr);

  /// For a cloth: whether its menu has the grid, too.
  void offerGrid(bool offered);

 Q_SIGNALS:
  void meshChosen(const std::string& file);  ///< a built-in mesh or a file, as the scene should name it
  void gridChosen();

 private:
  void chooseFile();

  const LabDocument& document_;
  QAction* grid_ = nullptr;
};

/// How a scene names a file: from its own folder where the file is in there, else by the whole path.
std::string file_as_seen_from(const cloth::SceneFolder& folder, const QString& file);

/// What a grid cloth is made of, and the way to make it a mesh instead; a mesh has an editor of its own.
class ClothShapeRow : public QWidget {
  Q_OBJECT

 public:
  explicit ClothShapeRow(LabDocument& document, QWidget* parent = nullptr);
  QWidget* tabStop() const { return button_; }

 Q_SIGNALS:
  void meshChosen();  ///< and taken or refused

 private:
  void choose(const std::string& file);

  LabDocument& document_;
  MeshButton* button_;
  QLabel* rule_;
};

}  // namespace clothlab

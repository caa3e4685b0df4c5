// What stands above the parameters of a material: the presets by name, files, and the way to springs; above
// those of springs the way to a material.
#pragma once

#include <QWidget>

#include "document/lab_document.h"
#include "scene/material_file.h"

class QAction;
class QLabel;
class QMenu;
class QToolButton;
class QVBoxLayout;

namespace clothlab {

class QuietCombo;

class MaterialRow : public QWidget {
  Q_OBJECT

 public:
  /// Above the material of the document's scene, or above its springs.
  MaterialRow(LabDocument& document, bool of_springs, QWidget* parent = nullptr);

  QList<QWidget*> tabStops() const;
  void refresh();

 Q_SIGNALS:
  void said();  ///< something that should be in sight

 private:
  void makePresets();
  QToolButton* makeButton(const QString& text, const char* icon_name);
  QAction* addAction(QMenu& menu, const char* name, const QString& text, void (MaterialRow::*act)());
  void choosePreset(int index);
  void openFile();
  void saveFile();
  void turnIntoMaterial();
  void turnIntoSprings();
  void say(const QString& rule);

  LabDocument& document_;
  QuietCombo* presets_ = nullptr;  ///< of a material
  QToolButton* button_ = nullptr;
  QLabel *source_ = nullptr, *rule_ = nullptr;
};

}  // namespace clothlab

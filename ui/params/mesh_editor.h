// The mesh of an obstacle or a cloth: its name, a button to choose another by, and what is to say about it.
#pragma once

#include "params/text_editor.h"

class QLabel;

namespace clothlab {

class MeshButton;

class MeshEditor : public TextEditor {
  Q_OBJECT

 public:
  MeshEditor(LabDocument& document, const cloth::Parameter& parameter, QWidget* parent);

  /// Whether a cloth may become a grid again.
  void offerGrid(bool offered);
  QList<QWidget*> tabStops() const override;

 protected:
  void showValue(const cloth::ParameterValue& value) override;

 private:
  MeshButton* button_;
  QLabel* report_;
};

/// Whether a parameter names a mesh.
bool names_mesh(const cloth::Parameter& parameter);

/// How large a mesh is, whether it is closed, and what is unusual about it.
QString mesh_report(const cloth::LoadedMesh& mesh, bool is_cloth);

}  // namespace clothlab

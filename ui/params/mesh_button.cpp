#include "params/mesh_button.h"

#include <QDir>
#include <QFileDialog>
#include <QFileInfo>
#include <QMenu>

#include "geometry/builtin_meshes.h"
#include "theme/theme.h"

namespace clothlab {

std::string file_as_seen_from(const cloth::SceneFolder& folder, const QString& file) {
  const QString whole = QFileInfo(file).absoluteFilePath();
  if (folder.path.empty()) return whole.toStdString();
  const QString seen = QDir(QString::fromStdString(folder.path)).relativeFilePath(whole);
  return (seen.startsWith("..") ? whole : seen).toStdString();
}

MeshButton::MeshButton(const LabDocument& document, QWidget* parent)
    : QToolButton(parent), document_(document) {
  setObjectName("meshButton");
  setIcon(clothlab::icon("mesh"));
  setIconSize({16, 16});
  setPopupMode(QToolButton::InstantPopup);
  setFocusPolicy(Qt::TabFocus);
  setToolTip(tr("Choose a mesh"));
  setAccessibleName(tr("Choose a mesh"));
  auto* menu = new QMenu(this);
  menu->setObjectName("meshMenu");
  grid_ = menu->addAction(tr("Grid"), this, &MeshButton::gridChosen);
  grid_->setObjectName("mesh:grid");
  grid_->setVisible(false);
  for (const cloth::BuiltinMesh& mesh : cloth::builtin_meshes()) {
    QAction* action = menu->addAction(QString::fromStdString(mesh.title), this,
                                      [this, name = mesh.name] { Q_EMIT meshChosen(name); });
    action->setObjectName("mesh:" + QString::fromStdString(mesh.name));
  }
  menu->addSeparator();
  menu->addAction(clothlab::icon("open"), tr("From an OBJ file…"), this, &MeshButton::chooseFile)
      ->setObjectName("mesh:file");
  setMenu(menu);
}

void MeshButton::offerGrid(bool offered) {
  grid_->setVisible(offered);
}

void MeshButton::chooseFile() {
  const QString folder = QString::fromStdString(document_.scene().folder.path);
  const QString file = QFileDialog::getOpenFileName(window(), tr("Choose a mesh"), folder,
                                                    tr("Meshes (*.obj);;All files (*)"));
  if (!file.isEmpty()) Q_EMIT meshChosen(file_as_seen_from(document_.scene().folder, file));
}

}  // namespace clothlab

#include "params/mesh_button.h"

#include <QDir>
#include <QFileDialog>
#include <QFileInfo>
#include <QLabel>
#include <QMenu>
#include <QVBoxLayout>

#include "geometry/builtin_meshes.h"
#include "params/panel_parts.h"
#include "params/wording.h"
#include "theme/theme.h"
#include "widgets/building.h"

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
  auto* menu = named("meshMenu", new QMenu(this));
  // Queued: until the menu is gone. A choice may take the button away, or open a dialog with a loop of its
  // own.
  grid_ = menu->addAction(tr("Grid"));
  grid_->setObjectName("mesh:grid");
  grid_->setVisible(false);
  connect(grid_, &QAction::triggered, this, &MeshButton::gridChosen, Qt::QueuedConnection);
  for (const cloth::BuiltinMesh& mesh : cloth::builtin_meshes()) {
    QAction* action = menu->addAction(QString::fromStdString(mesh.title));
    action->setObjectName("mesh:" + QString::fromStdString(mesh.name));
    connect(
        action, &QAction::triggered, this, [this, name = mesh.name] { Q_EMIT meshChosen(name); },
        Qt::QueuedConnection);
  }
  menu->addSeparator();
  QAction* file = menu->addAction(clothlab::icon("open"), tr("From an OBJ file…"));
  file->setObjectName("mesh:file");
  connect(file, &QAction::triggered, this, &MeshButton::chooseFile, Qt::QueuedConnection);
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

ClothShapeRow::ClothShapeRow(LabDocument& document, QWidget* parent)
    : QWidget(parent), document_(document), button_(new MeshButton(document, this)), rule_(new QLabel(this)) {
  setObjectName("clothShape");
  auto* column = spaced(new QVBoxLayout(this), spacing / 4);
  auto* row = new QHBoxLayout;
  row->setContentsMargins(0, 0, 24 + spacing / 2, 0);  // ends where the controls below end
  row->addWidget(new ElidedLabel(tr("Grid of particles"), this), 1);
  button_->setText(tr("Mesh"));
  button_->setToolButtonStyle(Qt::ToolButtonTextBesideIcon);
  button_->setToolTip(tr("Make the cloth of a triangle mesh; restarts the simulation"));
  row->addWidget(button_);
  column->addLayout(row);
  rule_->setObjectName("rule");
  rule_->setProperty("state", "error");
  rule_->setWordWrap(true);
  rule_->setTextFormat(Qt::PlainText);
  rule_->hide();
  column->addWidget(rule_);
  connect(button_, &MeshButton::meshChosen, this, &ClothShapeRow::choose);
}

void ClothShapeRow::choose(const std::string& file) {
  QString rule = document_.setClothMesh(file);
  rule_->setVisible(!rule.isEmpty());
  if (!rule.isEmpty())
    rule_->setText(tr("%1 %2. Still a grid.").arg(QString::fromStdString(file), typographic(rule)));
  Q_EMIT meshChosen();
}

}  // namespace clothlab

#include "params/cloth_shape_row.h"

#include <QHBoxLayout>
#include <QLabel>
#include <QVBoxLayout>

#include "params/mesh_button.h"
#include "params/panel_parts.h"
#include "params/wording.h"
#include "theme/theme.h"
#include "widgets/building.h"

namespace clothlab {

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

QWidget* ClothShapeRow::tabStop() const {
  return button_;
}

void ClothShapeRow::choose(const std::string& file) {
  QString rule = document_.setClothMesh(file);
  rule_->setVisible(!rule.isEmpty());
  if (rule.isEmpty()) return;
  rule[0] = rule[0].toUpper();
  rule_->setText(tr("%1 %2. Still a grid.").arg(QString::fromStdString(file), typographic(rule)));
}

}  // namespace clothlab

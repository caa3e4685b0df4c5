#include <QHBoxLayout>
#include <QLabel>
#include <QVBoxLayout>

#include "params/editors.h"
#include "params/mesh_button.h"
#include "theme/theme.h"
#include "widgets/numbers.h"

namespace clothlab {
namespace {

const char* const cloth_path = "cloth.mesh";

/// The mesh that a path of the scene names, once it is read.
const cloth::LoadedMesh* mesh_at(const cloth::Scene& scene, const std::string& path) {
  if (path == cloth_path) return scene.cloth.mesh.loaded.get();
  for (std::size_t k = 0; k < scene.obstacles.size(); ++k)
    if (path == "obstacles." + std::to_string(k) + ".file") return scene.obstacles[k].mesh.loaded.get();
  return nullptr;
}

}  // namespace

bool names_mesh(const cloth::Parameter& parameter) {
  return parameter.info.kind == cloth::Kind::text &&
         (parameter.info.key == "mesh" || parameter.info.key == "file");
}

QString mesh_report(const cloth::LoadedMesh& mesh, bool is_cloth) {
  QString text = QObject::tr("%1 vertices, %2 triangles, ")
                     .arg(count_text(static_cast<double>(mesh.surface.vertices.size())),
                          count_text(static_cast<double>(mesh.surface.triangles.size())));
  if (mesh.open_edges == 0)
    text += QObject::tr("closed.");
  else if (is_cloth)
    text += QObject::tr("%1 edges at its border.").arg(count_text(static_cast<double>(mesh.open_edges)));
  else
    text += QObject::tr("%1 open edges: it has a border, and no inside.")
                .arg(count_text(static_cast<double>(mesh.open_edges)));
  for (const std::string& notice : mesh.notices)
    text += QStringLiteral("\n%1.").arg(QString::fromStdString(notice));
  return text;
}

MeshEditor::MeshEditor(LabDocument& document, const cloth::Parameter& parameter, QWidget* parent)
    : TextEditor(document, parameter, parent),
      button_(new MeshButton(document, this)),
      report_(new QLabel(this)) {
  controlRow().addWidget(button_);
  report_->setObjectName("meshReport");
  report_->setProperty("muted", true);
  report_->setWordWrap(true);
  report_->setTextFormat(Qt::PlainText);
  QFont small = report_->font();
  small.setPointSizeF(small.pointSizeF() - 1);
  report_->setFont(small);
  auto* column = static_cast<QVBoxLayout*>(layout());
  constexpr int below_the_control = 2;
  column->insertWidget(below_the_control, report_);
  connect(button_, &MeshButton::meshChosen, this, [this](const std::string& file) {
    commit(file);
    Q_EMIT meshChosen();
  });
  connect(button_, &MeshButton::gridChosen, this, [this] { this->document().setClothMesh({}); });
  offerGrid(true);
  refresh();
}

void MeshEditor::offerGrid(bool offered) {
  button_->offerGrid(offered && path() == cloth_path);
}

QList<QWidget*> MeshEditor::tabStops() const {
  QList<QWidget*> stops = TextEditor::tabStops();
  stops.insert(1, button_);
  return stops;
}

void MeshEditor::showValue(const cloth::ParameterValue& value) {
  TextEditor::showValue(value);
  const cloth::LoadedMesh* mesh = mesh_at(document().scene(), path());
  report_->setVisible(mesh != nullptr);
  if (mesh) report_->setText(mesh_report(*mesh, path() == cloth_path));
}

}  // namespace clothlab

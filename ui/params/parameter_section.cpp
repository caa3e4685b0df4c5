#include "params/parameter_section.h"

#include <QHBoxLayout>
#include <QPainter>
#include <QToolButton>
#include <QVBoxLayout>
#include <algorithm>

#include "params/editors.h"
#include "params/material_row.h"
#include "params/mesh_button.h"
#include "params/panel_parts.h"
#include "params/parameter_editor.h"
#include "params/wording.h"
#include "theme/theme.h"
#include "widgets/building.h"

namespace clothlab {

ParameterSection::ParameterSection(LabDocument& document, const cloth::Block& block, QWidget* parent)
    : QWidget(parent), path_(block.path), title_(block.title) {
  setObjectName("section:" + QString::fromStdString(path_));
  auto* column = spaced(new QVBoxLayout(this), 0, {0, 1, 0, 0});
  makeHead(block, *column);
  makeBody(document, block, *column);
}

void ParameterSection::makeHead(const cloth::Block& block, QVBoxLayout& column) {
  const QString title = QString::fromStdString(block.title);
  const QString doc = QString::fromStdString(block.doc);
  auto* row = spaced(new QHBoxLayout, spacing / 2, {0, spacing / 2, spacing, spacing / 2});
  head_ = named("header", new SectionHeader(title, this));
  head_->setToolTip(doc);
  head_->setAccessibleDescription(doc);
  row->addWidget(head_, 1);
  connect(head_, &SectionHeader::toggled, this, [this](bool open) {
    body_->setVisible(open);
    Q_EMIT collapsedChanged(!open);
  });
  if (block.removable) {
    cross_ = named("remove", new QToolButton(this));
    cross_->setIcon(icon("remove"));
    cross_->setIconSize({16, 16});
    cross_->setFixedSize(24, 24);
    cross_->setFocusPolicy(Qt::TabFocus);
    cross_->setToolTip(tr("Take %1 out of the scene").arg(title));
    cross_->setAccessibleName(tr("Remove %1").arg(title));
    row->addWidget(cross_);
    connect(cross_, &QToolButton::clicked, this, &ParameterSection::removeRequested);
  }
  column.addLayout(row);
}

void ParameterSection::makeBody(LabDocument& document, const cloth::Block& block, QVBoxLayout& column) {
  body_ = new QWidget(this);
  auto* rows = spaced(new QVBoxLayout(body_), spacing, {2 * spacing, 0, spacing, 2 * spacing});
  if (block.path == "cloth" && !document.scene().cloth.is_mesh())
    rows->addWidget(shape_ = new ClothShapeRow(document, body_));
  if (shape_) connect(shape_, &ClothShapeRow::meshChosen, this, &ParameterSection::meshChosen);
  const bool of_springs = block.path == "springs" && !document.scene().cloth.is_mesh();
  if (of_springs || block.path == "material")
    rows->addWidget(material_ = new MaterialRow(document, of_springs, body_));
  if (material_) connect(material_, &MaterialRow::said, this, &ParameterSection::materialSaid);
  for (const cloth::Parameter& parameter : block.parameters) {
    ParameterEditor* editor = make_editor(document, parameter, body_);
    const bool said_above = block.parameters.size() == 1 && parameter.info.label == block.title &&
                            parameter.info.cost == cloth::EditCost::live && !parameter.info.auto_allowed;
    if (said_above) {
      editor->hideTitle();
      if (parameter.info.kind == cloth::Kind::vector) head_->setUnit(unit_text(parameter.info.unit));
    }
    if (auto* mesh = qobject_cast<MeshEditor*>(editor))
      connect(mesh, &MeshEditor::meshChosen, this, &ParameterSection::meshChosen);
    rows->addWidget(editor);
    editors_.push_back(editor);
  }
  column.addWidget(body_);
}

bool ParameterSection::shows(const cloth::Block& block) const {
  return block.path == path_ && block.title == title_ &&
         std::equal(editors_.begin(), editors_.end(), block.parameters.begin(), block.parameters.end(),
                    [](const ParameterEditor* e, const cloth::Parameter& p) { return e->path() == p.path; });
}

void ParameterSection::setCollapsed(bool collapsed) {
  head_->setChecked(!collapsed);
}

void ParameterSection::setRemovable(bool removable) {
  removable_ = removable;
  if (cross_) cross_->setVisible(removable);
  if (shape_) shape_->setVisible(removable);
  if (material_) material_->setVisible(removable);
  for (ParameterEditor* editor : editors_)
    if (auto* mesh = qobject_cast<MeshEditor*>(editor)) mesh->offerGrid(removable);
}

bool ParameterSection::showMatching(const QStringList& words) {
  const QString title = QString::fromStdString(title_);
  const bool whole = std::all_of(words.begin(), words.end(), [&](const QString& word) {
    return title.contains(word, Qt::CaseInsensitive);
  });
  bool any = whole;
  for (ParameterEditor* editor : editors_) {
    const bool shown = whole || editor->matches(words);
    editor->setVisible(shown);
    any = any || shown;
  }
  if (shape_) shape_->setVisible(whole && removable_);
  if (material_) material_->setVisible(whole && removable_);
  setVisible(any);
  return any;
}

void ParameterSection::refresh() {
  for (ParameterEditor* editor : editors_) editor->refresh();
  if (material_) material_->refresh();
}

ParameterEditor* ParameterSection::editor(const std::string& path) const {
  for (ParameterEditor* editor : editors_)
    if (editor->path() == path) return editor;
  return nullptr;
}

QList<QWidget*> ParameterSection::tabStops() const {
  QList<QWidget*> stops{head_};
  if (cross_) stops << cross_;
  if (shape_) stops << shape_->tabStop();
  if (material_) stops << material_->tabStops();
  for (const ParameterEditor* editor : editors_) stops << editor->tabStops();
  return stops;
}

void ParameterSection::abandonEdits() {
  for (ParameterEditor* editor : editors_) editor->abandonEdits();
}

void ParameterSection::paintEvent(QPaintEvent*) {
  QPainter painter(this);
  painter.fillRect(QRect(0, 0, width(), 1), theme().border);
}

}  // namespace clothlab

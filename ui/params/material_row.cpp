#include "params/material_row.h"

#include <QAbstractItemView>
#include <QDir>
#include <QFileDialog>
#include <QFileInfo>
#include <QHBoxLayout>
#include <QLabel>
#include <QMenu>
#include <QMessageBox>
#include <QPushButton>
#include <QToolButton>
#include <QVBoxLayout>
#include <algorithm>

#include "document/result_files.h"
#include "document/save_dialog.h"
#include "io/text_file.h"
#include "params/panel_parts.h"
#include "params/wording.h"
#include "scene/material_conversion.h"
#include "theme/theme.h"
#include "widgets/building.h"

namespace clothlab {
namespace {

constexpr const char* folder_kind = "material";  ///< of remembered folders

/// Read once: constant.
const std::vector<cloth::MaterialFile>& presets() {
  static const auto all = [] {
    std::vector<cloth::MaterialFile> files;
    for (const cloth::BuiltinMaterial& one : cloth::builtin_materials())
      files.push_back(cloth::builtin_material(one.name));
    return files;
  }();
  return all;
}

QString source_of(const cloth::MaterialFile& file) {
  return file.source.author.empty() ? MaterialRow::tr("Typical values; nothing was measured")
                                    : QString::fromStdString(file.source.text());
}

/// The title without what is said behind a colon.
QString name_of(const cloth::MaterialFile& file) {
  return QString::fromStdString(file.title.substr(0, file.title.find(':')));
}

QString tip_of(const cloth::MaterialFile& file) {
  const auto paragraph = [](const QString& head, const std::string& text) {
    return text.empty() ? QString()
                        : QStringLiteral("<p><b>%1</b> %2</p>")
                              .arg(head, QString::fromStdString(text).toHtmlEscaped());
  };
  return QStringLiteral("<p>%1</p><p>%2</p>")
             .arg(QString::fromStdString(file.title).toHtmlEscaped(), source_of(file).toHtmlEscaped()) +
         paragraph(MaterialRow::tr("Measured:"), file.source.measured) +
         paragraph(MaterialRow::tr("Assumed:"), file.source.assumed);
}

QLabel* small_label(const char* name, QWidget* parent) {
  auto* label = named(name, new QLabel(parent));
  label->setWordWrap(true);
  label->setTextFormat(Qt::PlainText);
  label->setFont(smaller(label->font()));
  label->hide();
  return label;
}

/// Asks with all that is lost; whether to go on.
bool goes_on(QWidget* parent, const QString& title, const cloth::SceneConversion& conversion) {
  QString text;
  for (const std::string& loss : conversion.losses)
    text += (text.isEmpty() ? "" : "\n\n") + QString::fromStdString(loss);
  QMessageBox question(QMessageBox::Question, title, title + '?', QMessageBox::Cancel, parent);
  question.setInformativeText(text);
  const QPushButton* go_on = question.addButton(title, QMessageBox::AcceptRole);
  question.exec();
  return question.clickedButton() == go_on;
}

}  // namespace

MaterialRow::MaterialRow(LabDocument& document, bool of_springs, QWidget* parent)
    : QWidget(parent), document_(document) {
  setObjectName("materialRow");
  auto* column = spaced(new QVBoxLayout(this), spacing / 4);
  auto* row = spaced(new QHBoxLayout, spacing, {0, 0, 24 + spacing / 2, 0});  // ends where controls below end
  column->addLayout(row);
  if (of_springs) {
    row->addWidget(new ElidedLabel(tr("Springs of this grid"), this), 1);
    button_ = makeButton(tr("Material"), "cloth");
    button_->setToolTip(tr("Turn the springs into the material that they are on this grid"));
    connect(button_, &QToolButton::clicked, this, &MaterialRow::turnIntoMaterial, Qt::QueuedConnection);
  } else {
    makePresets();
    row->addWidget(presets_, 1);
    button_ = makeButton({}, "file");
    button_->setToolTip(tr("Open or save a material, or turn it into springs"));
    button_->setPopupMode(QToolButton::InstantPopup);
    auto* menu = named("materialMenu", new QMenu(this));
    addAction(*menu, "material:open", tr("Open material…"), &MaterialRow::openFile);
    addAction(*menu, "material:save", tr("Save material…"), &MaterialRow::saveFile);
    menu->addSeparator();
    addAction(*menu, "material:springs", tr("Turn into springs…"), &MaterialRow::turnIntoSprings);
    button_->setMenu(menu);
  }
  button_->setAccessibleName(button_->toolTip());
  row->addWidget(button_);
  source_ = muted(small_label("materialSource", this));
  column->addWidget(source_);
  rule_ = small_label("rule", this);
  rule_->setProperty("state", "error");
  column->addWidget(rule_);
  refresh();
}

void MaterialRow::makePresets() {
  presets_ = named("materialPreset", new QuietCombo(this));
  presets_->setAccessibleName(tr("Material"));
  presets_->view()->setAccessibleName(tr("Materials"));
  presets_->addItem(tr("Values of its own"));
  for (const cloth::MaterialFile& file : presets()) {
    presets_->addItem(name_of(file));
    presets_->setItemData(presets_->count() - 1, tip_of(file), Qt::ToolTipRole);
  }
  connect(presets_, &QComboBox::activated, this, &MaterialRow::choosePreset);
  connect(&document_, &LabDocument::parameterChanged, this, [this](const std::string& path) {
    if (path.rfind("material.", 0) == 0) refresh();
  });
}

QToolButton* MaterialRow::makeButton(const QString& text, const char* icon_name) {
  auto* button = named("materialButton", new QToolButton(this));
  button->setIcon(clothlab::icon(icon_name));
  button->setIconSize({16, 16});
  button->setFocusPolicy(Qt::TabFocus);
  button->setText(text);
  if (!text.isEmpty()) button->setToolButtonStyle(Qt::ToolButtonTextBesideIcon);
  return button;
}

/// Queued: until the menu is gone, as a dialog has a loop of its own and a choice may take the row away.
QAction* MaterialRow::addAction(QMenu& menu, const char* name, const QString& text,
                                void (MaterialRow::*act)()) {
  QAction* action = menu.addAction(text);
  action->setObjectName(name);
  connect(action, &QAction::triggered, this, act, Qt::QueuedConnection);
  return action;
}

QList<QWidget*> MaterialRow::tabStops() const {
  return presets_ ? QList<QWidget*>{presets_, button_} : QList<QWidget*>{button_};
}

void MaterialRow::refresh() {
  if (!presets_ || !document_.scene().material) return;
  const auto& all = presets();
  const auto found = std::find_if(all.begin(), all.end(), [&](const cloth::MaterialFile& file) {
    return file.material == *document_.scene().material;
  });
  const bool is_preset = found != all.end();
  presets_->setCurrentIndex(is_preset ? static_cast<int>(found - all.begin()) + 1 : 0);
  presets_->setToolTip(is_preset ? tip_of(*found) : tr("A built-in material"));
  source_->setVisible(is_preset);
  source_->setText(is_preset ? source_of(*found) : QString());
  say({});
}

void MaterialRow::choosePreset(int index) {
  if (index < 1) return refresh();
  const cloth::MaterialFile& file = presets()[static_cast<std::size_t>(index - 1)];
  cloth::Scene after = document_.comparison().scene;
  after.material = file.material;
  const QString rule =
      document_.replaceScene(tr("Choose %1").arg(QString::fromStdString(file.title)), std::move(after));
  refresh();
  if (!rule.isEmpty()) say(tr("%1: %2").arg(QString::fromStdString(file.title), typographic(rule)));
}

void MaterialRow::openFile() {
  QString folder = QString::fromStdString(document_.scene().folder.path);
  if (folder.isEmpty()) folder = last_folder(folder_kind);
  const QString path = QFileDialog::getOpenFileName(window(), tr("Open material"), folder,
                                                    tr("Materials (*.material.json *.json);;All files (*)"));
  if (path.isEmpty()) return;
  remember_folder(folder_kind, path);
  std::string text;
  if (const auto error = cloth::read_text_file(path.toStdString(), text))
    return say(QString::fromStdString(error->text()));
  const auto reading = cloth::read_material_file(text, QFileInfo(path).fileName().toStdString());
  if (!reading.file) return say(typographic(QString::fromStdString(reading.problems.front().text())));
  cloth::Scene after = document_.comparison().scene;
  after.material = reading.file->material;
  say(typographic(document_.replaceScene(tr("Open material"), std::move(after))));
}

void MaterialRow::saveFile() {
  const QString path = ask_where_to_save(window(), tr("Save material"),
                                         {{tr("Clothlab materials"), {".material.json", ".json"}}},
                                         QDir(last_folder(folder_kind)).filePath("mine.material.json"));
  if (path.isEmpty() || !document_.scene().material) return;
  remember_folder(folder_kind, path);
  cloth::MaterialFile file;
  for (const cloth::MaterialFile& preset : presets())
    if (preset.material == *document_.scene().material) file = preset;
  file.material = *document_.scene().material;
  if (file.title.empty()) file.title = document_.scene().title;
  const QString error = write_file(path, QByteArray::fromStdString(cloth::write_material_file(file)));
  say(error);
  if (!error.isEmpty()) return;
  source_->setText(saved_in(tr("the material"), path));
  source_->show();
}

void MaterialRow::turnIntoMaterial() {
  const cloth::SceneConversion conversion = cloth::with_material(document_.comparison().scene);
  if (!conversion.scene) return say(QString::fromStdString(conversion.refusal));
  const QString title = tr("Turn springs into a material");
  if (goes_on(window(), title, conversion)) say(document_.replaceScene(title, *conversion.scene));
}

void MaterialRow::turnIntoSprings() {
  const cloth::SceneConversion conversion = cloth::with_springs(document_.comparison().scene);
  if (!conversion.scene) return say(QString::fromStdString(conversion.refusal));
  const QString title = tr("Turn the material into springs");
  if (goes_on(window(), title, conversion)) say(document_.replaceScene(title, *conversion.scene));
}

void MaterialRow::say(const QString& rule) {
  rule_->setText(rule);
  rule_->setVisible(!rule.isEmpty());
  if (!rule.isEmpty()) Q_EMIT said();
}

}  // namespace clothlab

#include "studies/outputs_choice.h"

#include <QHBoxLayout>
#include <QLineEdit>
#include <QMenu>
#include <QToolButton>
#include <algorithm>

#include "study/grid_convergence.h"
#include "study/grid_convergence_report.h"
#include "study/run_output.h"
#include "theme/theme.h"
#include "widgets/building.h"

namespace clothlab {
namespace {

QString joined(const std::vector<std::string>& outputs) {
  QStringList texts;
  for (const std::string& output : outputs) texts << QString::fromStdString(output);
  return texts.join(", ");
}

}  // namespace

OutputsChoice::OutputsChoice(QWidget* parent) : QWidget(parent) {
  line_ = named("outputNames", new QLineEdit(this));
  line_->setPlaceholderText(joined(cloth::default_outputs()));
  line_->setToolTip(
      tr("Columns of the record or measures of the shape, between commas; at the end, or with :max, :min or "
         ":mean over the run"));
  auto* add = named("addOutput", new QToolButton(this));
  add->setIcon(icon("add"));
  add->setToolTip(tr("Choose from all outputs that the scene has"));
  add->setPopupMode(QToolButton::InstantPopup);
  menu_ = named("outputMenu", new QMenu(add));
  add->setMenu(menu_);
  auto* row = spaced(new QHBoxLayout(this), spacing / 2);
  row->addWidget(line_, 1);
  row->addWidget(add);
  connect(line_, &QLineEdit::textChanged, this, &OutputsChoice::changed);
  connect(menu_, &QMenu::aboutToShow, this, &OutputsChoice::fillMenu);
}

std::vector<std::string> OutputsChoice::outputs() const {
  std::vector<std::string> names;
  for (const QString& name : line_->text().split(',', Qt::SkipEmptyParts))
    if (const QString trimmed = name.trimmed(); !trimmed.isEmpty()) names.push_back(trimmed.toStdString());
  return names;
}

void OutputsChoice::fillMenu() {
  menu_->clear();
  if (scene_.cloth.is_mesh()) {
    menu_->addAction(tr("A mesh has no finer grids"))->setEnabled(false);
    return;
  }
  const std::pair<const char*, QString> kinds[] = {
      {"", tr("At the end")}, {":max", tr("Largest")}, {":min", tr("Smallest")}, {":mean", tr("Mean")}};
  const std::vector<std::string> chosen = outputs();
  for (const std::string& quantity : cloth::output_sources(scene_)) {
    QMenu* of = menu_->addMenu(QString::fromStdString(cloth::words_of_output(quantity)));
    for (const auto& [ending, title] : kinds) {
      const std::string output = quantity + ending;
      QAction* action = of->addAction(title, this, [this, output] { toggle(output); });
      action->setCheckable(true);
      action->setChecked(std::find(chosen.begin(), chosen.end(), output) != chosen.end());
    }
  }
}

void OutputsChoice::toggle(const std::string& output) {
  std::vector<std::string> names = outputs();
  const auto at = std::find(names.begin(), names.end(), output);
  if (at != names.end())
    names.erase(at);
  else
    names.push_back(output);
  line_->setText(joined(names));
}

}  // namespace clothlab

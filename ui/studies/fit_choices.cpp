#include "studies/fit_choices.h"

#include <QComboBox>
#include <QFileDialog>
#include <QFileInfo>
#include <QGridLayout>
#include <QLabel>
#include <QPushButton>
#include <QSignalBlocker>
#include <algorithm>
#include <cmath>

#include "document/result_files.h"
#include "document/varied_ranges.h"
#include "params/panel_parts.h"
#include "simulation/step_batches.h"
#include "studies/varied_list.h"
#include "study/grid_convergence_report.h"
#include "study/run_output.h"
#include "theme/theme.h"
#include "widgets/building.h"

namespace clothlab {
namespace {

const char* const table_kind = "measured";

/// What the simulated curve can be of: the columns of the record and the measures of the shape.
std::vector<std::string> quantities_of(const cloth::Scene& scene) {
  std::vector<std::string> names = cloth::output_sources(scene);
  std::erase_if(names, [](const std::string& name) { return name == "time_s" || name == "step"; });
  return names;
}

/// A row that a table leaves empty has no value.
bool is_whole(const cloth::FittedCurve& curve, std::size_t row) {
  return std::isfinite(curve.times[row]) && std::isfinite(curve.values[row]) &&
         (curve.sigmas.empty() || std::isfinite(curve.sigmas[row]));
}

}  // namespace

FitChoices::FitChoices(LabDocument& document, QWidget* parent) : QWidget(parent), document_(document) {
  setObjectName("fitChoices");
  auto* grid = spaced(new QGridLayout(this), spacing / 2);
  auto* choose = named("fitChoose", new QPushButton(tr("Measured table…"), this));
  choose->setToolTip(
      tr("A CSV file with a header, times and measured values; it can be dropped on a chart, "
         "too"));
  connect(choose, &QPushButton::clicked, this, &FitChoices::chooseFile);
  file_ = named("fitFile", new ElidedLabel(tr("none yet"), this));
  grid->addWidget(choose, 0, 0);
  grid->addWidget(file_, 0, 1);
  grid->setColumnStretch(1, 1);
  problem_ = named("fitProblem", new QLabel(this));  // below the button that it is about
  problem_->setWordWrap(true);
  problem_->setProperty("state", "error");
  problem_->hide();
  grid->addWidget(problem_, grid->rowCount(), 0, 1, 2);
  time_ =
      makeChoice("fitTime", tr("Time (s)"), tr("The column with the times, in s from the start of the run"));
  value_ = makeChoice("fitValue", tr("Measured"), tr("The column with what was measured"));
  quantity_ = makeChoice("fitQuantity", tr("Is"), tr("What it is in the simulation, in its unit"));
  sigma_ =
      makeChoice("fitSigma", tr("Deviation"), tr("The column with standard deviations of the measurement"));
  for (QComboBox* box : {time_, value_, quantity_, sigma_}) box->setEnabled(false);  // there is no table
  varied_ = new VariedList(document, RangeRow::Place::fit, this);
  grid->addWidget(varied_, grid->rowCount(), 0, 1, 2);
  connect(varied_, &VariedList::changed, this, &FitChoices::changed);
  refresh();
}

QComboBox* FitChoices::makeChoice(const char* name, const QString& label, const QString& tip) {
  auto* grid = static_cast<QGridLayout*>(layout());
  auto* box = named(name, new QuietCombo(this));
  box->setToolTip(tip);
  box->setAccessibleName(label);
  auto* words = new QLabel(label, this);
  words->setBuddy(box);
  const int row = grid->rowCount();
  grid->addWidget(words, row, 0);
  grid->addWidget(box, row, 1);
  connect(box, &QComboBox::currentIndexChanged, this, &FitChoices::changed);
  return box;
}

void FitChoices::chooseFile() {
  const QString file = QFileDialog::getOpenFileName(
      this, tr("A table of measured values"), last_folder(table_kind), tr("Tables (*.csv *.txt *.tsv)"));
  if (file.isEmpty()) return;
  remember_folder(table_kind, file);
  openTable(file);
}

QString FitChoices::openTable(const QString& file, const std::string& column) {
  auto read = read_measured_table(file);
  const auto* problem = std::get_if<QString>(&read);
  problem_->setText(problem ? *problem : QString());
  problem_->setVisible(problem);
  if (problem) return *problem;
  table_ = std::get<MeasuredTable>(std::move(read));
  table_file_ = file;
  for (QComboBox* box : {time_, value_, quantity_, sigma_}) box->setEnabled(true);
  file_->setText(QFileInfo(file).fileName());
  file_->setToolTip(file);
  offerColumns();
  const std::string named = value_->currentText().toStdString();
  const std::vector<std::string> known = quantities_of(document_.scene());
  const bool says_it = std::find(known.begin(), known.end(), named) != known.end();
  offerQuantities(says_it || column.empty() ? named : column);
  Q_EMIT changed();
  return {};
}

void FitChoices::offerColumns() {
  QStringList names;
  for (const std::string& name : table_->names) names << QString::fromStdString(name);
  const std::size_t time = likely_time_column(*table_);
  for (QComboBox* box : {time_, value_, sigma_}) {
    const QSignalBlocker quiet(box);
    box->clear();
    if (box == sigma_) box->addItem(tr("not known"));
    box->addItems(names);
  }
  const QSignalBlocker quiet_time(time_), quiet_value(value_), quiet_sigma(sigma_);
  time_->setCurrentIndex(static_cast<int>(time));
  value_->setCurrentIndex(time == 0 ? 1 : 0);
  const qsizetype sigma = names.indexOf(value_->currentText() + "_sigma");
  sigma_->setCurrentIndex(static_cast<int>(sigma + 1));
}

void FitChoices::offerQuantities(const std::string& column) {
  const QSignalBlocker quiet(quantity_);
  const QString before = quantity_->currentData().toString();
  quantity_->clear();
  for (const std::string& name : quantities_of(document_.scene()))
    quantity_->addItem(QString::fromStdString(cloth::words_of_output(name)), QString::fromStdString(name));
  const int wanted = quantity_->findData(QString::fromStdString(column));
  quantity_->setCurrentIndex(std::max(0, wanted >= 0 ? wanted : quantity_->findData(before)));
}

void FitChoices::refresh() {
  offerQuantities({});
  varied_->refresh();
}

std::variant<cloth::FittedCurve, QString> FitChoices::curve() const {
  if (!table_) return tr("Choose a table of measured values, or drop one on a chart.");
  if (time_->currentIndex() == value_->currentIndex())
    return tr("Times and measured values must be two columns.");
  const auto column = [this](int index) { return table_->columns[static_cast<std::size_t>(index)]; };
  cloth::FittedCurve all{.column = quantity_->currentData().toString().toStdString(),
                         .times = column(time_->currentIndex()),
                         .values = column(value_->currentIndex())};
  if (sigma_->currentIndex() > 0) all.sigmas = column(sigma_->currentIndex() - 1);
  cloth::FittedCurve curve{.column = all.column};
  for (std::size_t row = 0; row < all.times.size(); ++row) {
    if (!is_whole(all, row)) continue;
    if (!curve.times.empty() && !(all.times[row] > curve.times.back()))
      return tr("Row %1: the times must ascend.").arg(row + 1);
    if (all.times[row] < 0 || all.times[row] > document_.scene().duration)
      return tr("Row %1: %2 s is outside of the run, which ends at %3 s.")
          .arg(row + 1)
          .arg(all.times[row])
          .arg(document_.scene().duration);
    curve.times.push_back(all.times[row]);
    curve.values.push_back(all.values[row]);
    if (all.sigmas.empty()) continue;
    if (!(all.sigmas[row] > 0)) return tr("Row %1: a standard deviation must be more than 0.").arg(row + 1);
    curve.sigmas.push_back(all.sigmas[row]);
  }
  if (curve.times.size() < 2) return tr("The table has fewer than two rows with values in these columns.");
  return curve;
}

std::variant<cloth::IdentifyPlan, QString> FitChoices::plan() const {
  auto measured = curve();
  if (auto* problem = std::get_if<QString>(&measured)) return *problem;
  cloth::IdentifyPlan plan{.scene = document_.scene()};
  plan.curves.push_back(std::get<cloth::FittedCurve>(std::move(measured)));
  plan.jobs = cloth::machine_threads();
  for (const VariedRange& range : document_.varied().list()) {
    const auto parameter = find_parameter(plan.scene, range.path);
    const auto value = parameter->get(plan.scene);
    const auto* number = std::get_if<double>(&value);
    const double middle = range.from > 0 ? std::sqrt(range.from * range.to) : (range.from + range.to) / 2;
    cloth::VariedParameter& varied = plan.varied.emplace_back();
    varied.path = range.path;
    varied.unit = parameter->info.unit;
    varied.low = range.from;
    varied.high = range.to;
    varied.start = number ? std::clamp(*number, range.from, range.to) : middle;
    varied.is_whole = parameter->info.kind == cloth::Kind::integer;
    if (varied.is_whole) plan.options.method = cloth::FitMethod::derivative_free;
  }
  if (plan.varied.empty()) return tr("Choose at least one parameter to find.");
  if (const auto problems = cloth::find_problems(plan); !problems.empty())
    return QString::fromStdString(problems.front().text());
  return plan;
}

}  // namespace clothlab

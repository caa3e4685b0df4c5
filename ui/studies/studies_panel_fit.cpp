// StudiesPanel: fits of parameters to measured values.
#include <QComboBox>
#include <QDir>
#include <QLabel>
#include <QProgressBar>
#include <QPushButton>
#include <QStackedWidget>
#include <QToolButton>
#include <algorithm>
#include <cmath>
#include <utility>

#include "analysis/fit_report.h"
#include "studies/fit_choices.h"
#include "studies/studies_panel.h"
#include "studies/study_library.h"
#include "study/grid_convergence_report.h"
#include "theme/theme.h"
#include "widgets/numbers.h"

namespace clothlab {
namespace {

QString verdict_words(cloth::FitVerdict verdict) {
  switch (verdict) {
    case cloth::FitVerdict::identified:
      return QObject::tr("identified");
    case cloth::FitVerdict::uncertain:
      return QObject::tr("uncertain");
    case cloth::FitVerdict::unseen:
      return QObject::tr("not seen by the data");
    case cloth::FitVerdict::ambiguous:
      return QObject::tr("ambiguous");
    case cloth::FitVerdict::at_bound:
      return QObject::tr("at an end of its range");
    case cloth::FitVerdict::not_fitted:
      return QObject::tr("not fitted");
  }
  return {};
}

QString row_of(const QStringList& cells) {
  QString row = "<tr>";
  for (const QString& cell : cells) row += "<td style='padding-right: 14px'>" + cell + "</td>";
  return row + "</tr>";
}

QString value_cells(const cloth::FitParameter& parameter, const cloth::FittedParameter& found) {
  const QString colour =
      (found.verdict == cloth::FitVerdict::identified ? theme().good : theme().warning).name();
  const QString value = quantity_text(found.value, parameter.unit, 4);
  const bool has_error = std::isfinite(found.standard_error) && found.verdict != cloth::FitVerdict::unseen &&
                         found.verdict != cloth::FitVerdict::not_fitted;
  return row_of(
      {QString::fromStdString(parameter.name),
       has_error ? QObject::tr("%1 ± %2").arg(value, quantity_text(found.standard_error, parameter.unit, 2))
                 : value,
       has_error ? QObject::tr("%1 to %2")
                       .arg(quantity_text(found.low, parameter.unit, 3),
                            quantity_text(found.high, parameter.unit, 3))
                 : QString(),
       QStringLiteral("<span style='color: %1'>%2</span>").arg(colour, verdict_words(found.verdict))});
}

/// Values with their standard errors and verdicts, then a sentence for each that is not identified.
QString values_html(const cloth::FitAccount& account) {
  QString html = "<table>";
  html += row_of({QObject::tr("<b>Parameter</b>"), QObject::tr("<b>Value ± standard error</b>"),
                  QObject::tr("<b>Two standard errors</b>"), QObject::tr("<b>Verdict</b>")});
  const cloth::FitResult& result = account.result;
  for (std::size_t k = 0; k < result.parameters.size(); ++k)
    html += value_cells(account.problem.parameters[k], result.parameters[k]);
  html += "</table>";
  for (std::size_t k = 0; k < result.parameters.size(); ++k)
    if (!result.parameters[k].why.empty())
      html += "<p style='margin: 2px'>" +
              sentence_text(account.problem.parameters[k].name + ": " + result.parameters[k].why)
                  .toHtmlEscaped() +
              "</p>";
  return html;
}

}  // namespace

void StudiesPanel::startFit() {
  if (runner_.is_running()) return say(tr("The results of the study before are still being written."), true);
  auto order = choices_->fitOrder();
  if (const QString* problem = std::get_if<QString>(&order)) return say(*problem, true);
  FitOrder& chosen = std::get<FitOrder>(order);
  sweep_.leave();
  table_.reset();
  fitted_.reset();
  folder_ = QString::fromStdString(chosen.folder.string());
  shows_fit_ = true;
  fit_is_opened_ = false;
  plot_->setClickOpens(false);
  stack_->setCurrentIndex(0);
  empty_->setText(
      tr("<p><b>The fit runs.</b></p><p>Runs of the scene come closer and closer to what was "
         "measured.</p>"));
  fitted_parameters_ = chosen.plan.varied;
  fit_.start(std::move(chosen));
  was_running_ = true;
  timer_.start(run_interval);
  poll();
}

void StudiesPanel::leaveFit() {
  shows_fit_ = false;
  fitted_.reset();
  values_->hide();
  use_->hide();
  bar_->setRange(0, 1000);
}

void StudiesPanel::pollFit() {
  const bool runs = fit_.is_running();  // asked first: what ends meanwhile is shown by the next look
  if (auto outcome = fit_.take()) {
    fitted_ = std::move(outcome);
    offerDiagrams();
    refreshDiagram();
  }
  showFitStatus();
  if (runs) return;
  timer_.stop();
  if (!std::exchange(was_running_, false)) return;
  if (fitted_ && fit_.status().problem.empty()) recent_studies.remember(folder_);
  Q_EMIT finished();
}

void StudiesPanel::showFitStatus() {
  const FitRunStatus status = fit_is_opened_ ? FitRunStatus() : fit_.status();
  start_->setEnabled(!status.running);
  choices_->setEnabled(!status.running);
  cancel_->setVisible(status.running);
  cancel_->setEnabled(!status.stopping);
  go_on_->hide();
  open_->setEnabled(!status.running);
  save_->setEnabled(fitted_ != nullptr);
  bar_->setVisible(status.running);
  bar_->setRange(0, status.running ? 0 : 1000);  // nobody knows how many runs it takes
  against_->setVisible(fitted_ && against_->count() > 0);
  title_->setText(fitted_ ? tr("Fit to measured values: %1").arg(QString::fromStdString(fitted_->title))
                          : tr("Fit to measured values"));
  earlier_->hide();
  const bool has_values = fitted_ && !fitted_->result.parameters.empty();
  const bool usable =
      has_values && std::all_of(fitted_->result.parameters.begin(), fitted_->result.parameters.end(),
                                [](const auto& found) { return std::isfinite(found.value); });
  use_->setVisible(usable && !status.running);
  values_->setVisible(has_values);
  if (has_values) values_->setText(values_html(*fitted_));
  if (!status.problem.empty())
    say(fitted_ ? tr("The results could not be written. %1").arg(sentence_text(status.problem))
                : sentence_text(status.problem),
        true);
  else if (status.running)
    say(fitProgress(status));
  else
    say(summary());
}

QString StudiesPanel::fitProgress(const FitRunStatus& status) const {
  if (status.writing) return tr("writing the results");
  if (status.stopping) return tr("stopping");
  QString text = tr("%1 runs, chi squared %2").arg(status.runs).arg(number_text(status.chi_squared, 4));
  for (std::size_t k = 0; k < std::min(status.values.size(), fitted_parameters_.size()); ++k)
    text += (k == 0 ? tr(" at %1 = %2") : QStringLiteral(", %1 = %2"))
                .arg(QString::fromStdString(fitted_parameters_[k].path),
                     quantity_text(status.values[k], fitted_parameters_[k].unit, 4));
  return text;
}

QString StudiesPanel::fitSummary() const {
  if (!fitted_) return {};
  const cloth::FitAccount& account = *fitted_;
  const cloth::FitResult& result = account.result;
  if (result.status == cloth::FitStatus::no_start)
    return tr("No run within these ranges came to its end: there is nothing to fit.");
  if (result.status == cloth::FitStatus::stopped)
    return tr("The fit was stopped. Its runs are in %1, where it goes on").arg(shown_path(folder_));
  QString text = QString::fromStdString(conclusion_of(result, account.problem.parameters));
  text += tr(" Chi squared %1 with %2 degrees of freedom, %3 runs.")
              .arg(number_text(result.chi_squared, 4))
              .arg(result.degrees)
              .arg(result.evaluations);
  for (const std::string& caution : result.cautions) text += ' ' + sentence_text(caution);
  return text + tr(" In %1").arg(shown_path(folder_));
}

QStringList StudiesPanel::fitDiagrams() const {
  if (!fitted_ || fitted_->result.simulated.empty()) return {};
  if (fitted_->curves.empty()) return {tr("residuals")};
  return {tr("measured and simulated"), tr("residuals")};
}

void StudiesPanel::showFitDiagram() {
  const cloth::FitAccount& account = *fitted_;
  const bool has_curve = !account.result.simulated.empty();
  stack_->setCurrentIndex(has_curve ? 1 : 0);
  if (!has_curve) return empty_->setText(tr("<p>There is no fitted curve.</p>"));
  const cloth::FitCurve* curve = account.curves.empty() ? nullptr : &account.curves.front();
  const bool residuals = !curve || against_->currentIndex() == 1;
  cloth::LinePlot plot = residuals ? residual_plot(account, curve) : curve_plot(account, *curve);
  // For people: "kinetic" in place of the column's name, whose unit stands behind it.
  if (const QString words = curve ? QString::fromStdString(cloth::words_of_output(curve->name)) : QString();
      !residuals && words.endsWith(')'))
    plot.y.label = words.section(" (", 0, -2).toStdString();
  plot_->setDiagram(std::move(plot));
}

/// As one undo step. A fit that was opened may be of another scene.
void StudiesPanel::useFit() {
  if (!fitted_) return;
  const auto& asked = fitted_->problem.parameters;
  for (const cloth::FitParameter& parameter : asked)
    if (!find_parameter(document_.scene(), parameter.name))
      return say(tr("This scene has no parameter %1.").arg(QString::fromStdString(parameter.name)), true);
  QString problem;
  document_.undoStack().beginMacro(tr("Use the fitted values"));
  for (std::size_t k = 0; k < asked.size(); ++k) {
    const double value = fitted_->result.parameters[k].value;
    const bool is_whole = find_parameter(document_.scene(), asked[k].name)->info.kind == cloth::Kind::integer;
    const QString refused = document_.setParameter(
        asked[k].name,
        is_whole ? cloth::ParameterValue(static_cast<std::int64_t>(std::lround(value))) : value);
    if (problem.isEmpty()) problem = refused;
  }
  document_.undoStack().endMacro();
  if (!problem.isEmpty()) say(problem, true);
}

/// A folder that the window or the command line wrote.
void StudiesPanel::openFit(const QString& folder) {
  cloth::FitReading reading = cloth::read_fit(folder.toStdString());
  if (!reading.account)
    return say(tr("The fit was not opened. %1").arg(QString::fromStdString(reading.problem)), true);
  sweep_.leave();
  table_.reset();
  folder_ = QDir::cleanPath(folder);
  recent_studies.remember(folder_);
  fitted_ = std::make_shared<const cloth::FitAccount>(std::move(*reading.account));
  shows_fit_ = fit_is_opened_ = true;
  plot_->setClickOpens(false);
  offerDiagrams();
  refreshDiagram();
  showFitStatus();
}

void StudiesPanel::fitTo(const QString& file, const std::string& column) {
  if (isRunning()) return say(tr("A study runs: the table can be opened when it has ended."), true);
  choices_->choose(StudyChoices::Kind::fit);
  const QString problem = choices_->fit().openTable(file, column);
  if (!problem.isEmpty()) say(problem, true);
}

}  // namespace clothlab

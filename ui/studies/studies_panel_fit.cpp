// StudiesPanel: fits of parameters to measured values.
#include <QComboBox>
#include <QLabel>
#include <QProgressBar>
#include <QPushButton>
#include <QStackedWidget>
#include <QToolButton>
#include <utility>

#include "analysis/fit_report.h"
#include "studies/fit_choices.h"
#include "studies/studies_panel.h"
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
  auto plan = choices_->fit().plan();
  if (const QString* problem = std::get_if<QString>(&plan)) return say(*problem, true);
  sweep_.leave();
  table_.reset();
  fitted_.reset();
  folder_.clear();
  shows_fit_ = true;
  plot_->setClickOpens(false);
  stack_->setCurrentIndex(0);
  empty_->setText(
      tr("<p><b>The fit runs.</b></p><p>Runs of the scene come closer and closer to what was "
         "measured.</p>"));
  fit_.start(std::get<cloth::IdentifyPlan>(std::move(plan)));
  was_running_ = true;
  timer_.start();
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
  if (auto outcome = fit_.take()) {
    fitted_ = std::move(outcome);
    offerDiagrams();
    refreshDiagram();
  }
  showFitStatus();
  if (fit_.is_running()) return;
  timer_.stop();
  if (std::exchange(was_running_, false)) Q_EMIT finished();
}

void StudiesPanel::showFitStatus() {
  const FitRunStatus status = fit_.status();
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
  title_->setText(tr("Fit to measured values"));
  earlier_->hide();
  const bool has_values = fitted_ && !fitted_->account.result.parameters.empty();
  use_->setVisible(has_values && !status.running);
  values_->setVisible(has_values);
  if (has_values) values_->setText(values_html(fitted_->account));
  if (!status.problem.empty())
    say(sentence_text(status.problem), true);
  else if (status.running)
    say(status.stopping
            ? tr("stopping")
            : tr("%1 runs, chi squared %2").arg(status.runs).arg(number_text(status.chi_squared, 4)));
  else
    say(summary());
}

QString StudiesPanel::fitSummary() const {
  if (!fitted_) return {};
  const cloth::FitAccount& account = fitted_->account;
  const cloth::FitResult& result = account.result;
  if (result.status == cloth::FitStatus::no_start)
    return tr("No run within these ranges came to its end: there is nothing to fit.");
  if (result.status == cloth::FitStatus::stopped) return tr("The fit was stopped.");
  QString text = QString::fromStdString(conclusion_of(result, account.problem.parameters));
  text += tr(" Chi squared %1 with %2 degrees of freedom, %3 runs.")
              .arg(number_text(result.chi_squared, 4))
              .arg(result.degrees)
              .arg(result.evaluations);
  for (const std::string& caution : result.cautions) text += ' ' + sentence_text(caution);
  return text;
}

QStringList StudiesPanel::fitDiagrams() const {
  if (!fitted_ || fitted_->account.result.simulated.empty()) return {};
  return {tr("measured and simulated"), tr("residuals")};
}

void StudiesPanel::showFitDiagram() {
  const cloth::FitAccount& account = fitted_->account;
  const bool has_curve = !account.result.simulated.empty();
  stack_->setCurrentIndex(has_curve ? 1 : 0);
  if (!has_curve) return empty_->setText(tr("<p>There is no fitted curve.</p>"));
  const cloth::FitCurve& curve = account.curves.front();
  plot_->setDiagram(against_->currentIndex() == 1 ? residual_plot(account, &curve)
                                                  : curve_plot(account, curve));
}

/// As one undo step.
void StudiesPanel::useFit() {
  if (!fitted_) return;
  document_.undoStack().beginMacro(tr("Use the fitted values"));
  const cloth::FitResult& result = fitted_->account.result;
  for (std::size_t k = 0; k < result.parameters.size(); ++k) {
    const cloth::VariedParameter& varied = fitted_->plan.varied[k];
    const double value = result.parameters[k].value;
    document_.setParameter(
        varied.path,
        varied.is_whole ? cloth::ParameterValue(static_cast<std::int64_t>(std::lround(value))) : value);
  }
  document_.undoStack().endMacro();
}

void StudiesPanel::fitTo(const QString& file, const std::string& column) {
  if (isRunning()) return say(tr("A study runs: the table can be opened when it has ended."), true);
  choices_->choose(StudyChoices::Kind::fit);
  const QString problem = choices_->fit().openTable(file, column);
  if (!problem.isEmpty()) say(problem, true);
}

}  // namespace clothlab

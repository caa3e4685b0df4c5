#include "studies/studies_panel.h"

#include <QComboBox>
#include <QDir>
#include <QEvent>
#include <QFileDialog>
#include <QHBoxLayout>
#include <QLabel>
#include <QMenu>
#include <QProgressBar>
#include <QPushButton>
#include <QScrollArea>
#include <QSignalBlocker>
#include <QStackedWidget>
#include <QToolButton>
#include <QVBoxLayout>
#include <algorithm>
#include <cmath>

#include "document/result_files.h"
#include "document/save_dialog.h"
#include "params/panel_parts.h"
#include "studies/study_library.h"
#include "study/extremes_report.h"
#include "study/grid_convergence_report.h"
#include "study/stability_report.h"
#include "study/study_runs.h"
#include "study/validation/validation_report.h"
#include "study/work_precision_report.h"
#include "theme/theme.h"
#include "widgets/building.h"
#include "widgets/numbers.h"

namespace clothlab {
namespace {

constexpr int poll_interval = 100;  // ms
constexpr int choices_width = 346;  // px

QString time_text(double seconds) {
  const int whole = static_cast<int>(std::ceil(seconds));
  return whole < 60 ? QObject::tr("%1 s").arg(whole)
                    : QObject::tr("%1 min %2 s").arg(whole / 60).arg(whole % 60, 2, 10, QChar('0'));
}

bool is_timed(const cloth::WorkPrecision& study) {
  return std::any_of(study.methods.begin(), study.methods.end(), [](const cloth::MethodStudy& method) {
    return std::any_of(method.runs.begin(), method.runs.end(),
                       [](const cloth::WorkPrecisionRun& run) { return !run.samples.empty(); });
  });
}

/// What the box above the diagram offers of a kind of study; nothing: it has one diagram.
QStringList diagrams_of(const cloth::StudyTable& table) {
  if (std::holds_alternative<cloth::WorkPrecision>(table))
    return {QObject::tr("against run time"), QObject::tr("against step"),
            QObject::tr("against force evaluations")};
  if (std::holds_alternative<cloth::GridConvergence>(table))
    return {QObject::tr("values"), QObject::tr("errors")};
  QStringList names;
  if (const auto* validation = std::get_if<cloth::ValidationStudy>(&table))
    for (const std::string& name : cloth::diagram_names(*validation)) names << QString::fromStdString(name);
  return names;
}

/// `which` of diagrams_of the table.
Diagram diagram_of(const cloth::StudyTable& table, int which) {
  if (const auto* study = std::get_if<cloth::WorkPrecision>(&table)) {
    // Before the first timing there is nothing to show against the time.
    const auto against = static_cast<cloth::PlotAgainst>(which);
    const bool timed = against != cloth::PlotAgainst::run_time || is_timed(*study);
    return cloth::study_plot(*study, timed ? against : cloth::PlotAgainst::force_evaluations);
  }
  if (const auto* map = std::get_if<cloth::StabilityMap>(&table)) return cloth::study_plot(*map);
  if (const auto* grids = std::get_if<cloth::GridConvergence>(&table))
    return cloth::study_plot(*grids, static_cast<cloth::GridPlot>(which));
  if (const auto* validation = std::get_if<cloth::ValidationStudy>(&table))
    return cloth::study_plot(*validation, static_cast<std::size_t>(which));
  return cloth::study_plot(std::get<cloth::ExtremesTable>(table));
}

QString kind_title(const cloth::StudyTable& table) {
  const QString titles[] = {QObject::tr("Work-precision"), QObject::tr("Stability map"),
                            QObject::tr("Extreme cases"), QObject::tr("Grid convergence"),
                            QObject::tr("Materials against exact solutions")};
  return titles[table.index()];
}

}  // namespace

StudiesPanel::StudiesPanel(LabDocument& document, QWidget* parent) : QWidget(parent), document_(document) {
  setObjectName("studiesPanel");
  makeLayout();
  timer_.setInterval(poll_interval);
  connect(&timer_, &QTimer::timeout, this, &StudiesPanel::poll);
  const auto stale = [this] {
    choices_stale_ = true;
    if (isVisible()) choices_->setScene(document_.scene()), choices_stale_ = false;
  };
  connect(&document_, &LabDocument::loaded, this, stale);
  connect(&document_, &LabDocument::sceneChanged, this, stale);
  connect(&document_, &LabDocument::scopeChanged, this, stale);
  connect(choices_, &StudyChoices::changed, this, [this] {
    if (isVisible()) compareWithForm();
  });
  showStatus({});
}

StudiesPanel::~StudiesPanel() = default;

void StudiesPanel::makeLayout() {
  auto* row =
      spaced(new QHBoxLayout(this), spacing * 2, {spacing * 3 / 2, spacing, spacing * 3 / 2, spacing});
  row->addWidget(makeLeft());
  row->addWidget(makeRight(), 1);
}

QWidget* StudiesPanel::makeLeft() {
  auto* left = new QWidget(this);
  left->setFixedWidth(choices_width);
  choices_ = new StudyChoices(left);
  auto* scroll = new QScrollArea(left);
  scroll->setWidget(choices_);
  scroll->setWidgetResizable(true);
  scroll->setHorizontalScrollBarPolicy(Qt::ScrollBarAlwaysOff);
  start_ = named("startStudy", new QPushButton(tr("Start the study"), left));
  start_->setProperty("primary", true);
  cancel_ = named("cancelStudy", new QPushButton(tr("Cancel"), left));
  cancel_->setToolTip(tr("Stop at the next step. What is finished is kept."));
  auto* column = spaced(new QVBoxLayout(left), spacing);
  column->addWidget(scroll, 1);
  auto* buttons = new QHBoxLayout;
  buttons->addWidget(start_, 1);
  buttons->addWidget(cancel_);
  column->addLayout(buttons);
  connect(start_, &QPushButton::clicked, this, &StudiesPanel::start);
  connect(cancel_, &QPushButton::clicked, this, [this] {
    runner_.cancel();
    poll();
  });
  return left;
}

void StudiesPanel::makeDiagram(QWidget* right) {
  empty_ = new QLabel(tr("<p><b>No study yet.</b></p>"
                         "<p>Choose a study of the scene being edited and start it: it runs beside the "
                         "simulation, and its diagram fills as results come. Rest the pointer on a run "
                         "to read it, double-click to open it in the view.</p>"),
                      right);
  empty_->setAlignment(Qt::AlignCenter);
  empty_->setWordWrap(true);
  empty_->setMargin(spacing);
  empty_->setProperty("muted", true);
  empty_->setObjectName("studyEmpty");
  earlier_ = named("studyEarlier", new QLabel(tr("An earlier study: the form has other values now."), right));
  earlier_->setProperty("state", "warning");
  earlier_->setWordWrap(true);
  earlier_->hide();
  plot_area_ = named("studyPlotArea", new QScrollArea(right));
  plot_ = new StudyPlot(plot_area_);
  plot_area_->setWidget(plot_);
  plot_area_->setWidgetResizable(true);
  plot_area_->installEventFilter(this);
  stack_ = new QStackedWidget(right);
  stack_->addWidget(empty_);
  stack_->addWidget(plot_area_);
}

QWidget* StudiesPanel::makeRight() {
  auto* right = new QWidget(this);
  title_ = named("studyTitle", new ElidedLabel(right));
  title_->setProperty("heading", true);
  against_ = named("against", new QComboBox(right));
  save_ = named("saveStudy", new QToolButton(right));
  save_->setIcon(icon("export-plot"));
  save_->setToolTip(tr("Save the diagram as SVG, PNG or PDF, or its runs as CSV"));
  open_ = named("openStudy", new QToolButton(right));
  open_->setIcon(icon("open"));
  open_->setToolTip(tr("Open the folder of a study"));
  open_->setPopupMode(QToolButton::InstantPopup);
  recent_ = new QMenu(open_);
  open_->setMenu(recent_);
  auto* head = spaced(new QHBoxLayout, spacing);
  head->addWidget(title_, 1);
  head->addWidget(against_);
  head->addWidget(open_);
  head->addWidget(save_);

  makeDiagram(right);
  bar_ = named("studyProgress", new QProgressBar(right));
  bar_->setRange(0, 1000);
  bar_->setTextVisible(false);
  bar_->setFixedHeight(6);
  line_ = named("studyLine", new ElidedLabel(right));
  line_->setProperty("muted", true);

  auto* column = spaced(new QVBoxLayout(right), spacing / 2);
  column->addLayout(head);
  column->addWidget(earlier_);
  column->addWidget(stack_, 1);
  column->addWidget(bar_);
  column->addWidget(line_);
  connect(against_, &QComboBox::currentIndexChanged, this, &StudiesPanel::refreshDiagram);
  connect(save_, &QToolButton::clicked, this, &StudiesPanel::saveAs);
  connect(recent_, &QMenu::aboutToShow, this, &StudiesPanel::fillRecentMenu);
  connect(plot_, &StudyPlot::runActivated, this, &StudiesPanel::openRun);
  connect(plot_, &StudyPlot::runHovered, this, [this](const QString& text) {
    if (!isRunning()) say(text.isEmpty() ? summary() : QString(text).replace('\n', ", "));
  });
  return right;
}

bool StudiesPanel::eventFilter(QObject* watched, QEvent* event) {
  if (watched == plot_area_ && event->type() == QEvent::Resize) plot_->setRoom(plot_area_->size());
  return QWidget::eventFilter(watched, event);
}

void StudiesPanel::showEvent(QShowEvent*) {
  if (choices_stale_) choices_->setScene(document_.scene());
  choices_stale_ = false;
  compareWithForm();
}

void StudiesPanel::start() {
  if (const StudyStatus status = runner_.status(); status.running && !status.writing) return;
  if (was_running_ && table_) recent_studies.remember(folder_);  // which is still being written
  auto order = choices_->order();
  if (const QString* problem = std::get_if<QString>(&order)) {
    say(*problem, true);
    return;
  }
  StudyOrder& chosen = std::get<StudyOrder>(order);
  choices_->keepAxes();
  folder_ = QString::fromStdString(chosen.folder.string());
  table_.reset();
  compareWithForm();
  stack_->setCurrentIndex(0);
  empty_->setText(tr("<p><b>The study runs.</b></p><p>Its first results will be drawn here.</p>"));
  runner_.start(std::move(chosen));
  was_running_ = true;
  timer_.start();
  poll();
}

void StudiesPanel::stop() {
  runner_.cancel();
  runner_.wait();
  poll();
}

void StudiesPanel::poll() {
  const StudyStatus status = runner_.status();
  if (auto table = runner_.take()) show(std::move(table));
  showStatus(status);
  if (status.running || !was_running_) return;
  was_running_ = false;
  timer_.stop();
  if (status.problem.empty() && table_) recent_studies.remember(folder_);
  Q_EMIT finished();
}

void StudiesPanel::showStatus(const StudyStatus& status) {
  const bool computing = status.running && !status.writing;
  start_->setEnabled(!computing);
  choices_->setEnabled(!computing);
  cancel_->setVisible(computing);
  cancel_->setEnabled(!status.stopping);
  open_->setEnabled(!status.running);
  save_->setEnabled(table_ != nullptr);
  bar_->setVisible(status.running);
  bar_->setValue(static_cast<int>(1000 * status.fraction));
  against_->setVisible(table_ && against_->count() > 0);
  title_->setText(
      table_ ? tr("%1: %2").arg(kind_title(*table_), QString::fromStdString(cloth::title_of(*table_)))
             : QString());
  if (!status.earlier_problem.empty()) {
    say(tr("The results of the study before could not be written. %1")
            .arg(QString::fromStdString(status.earlier_problem)),
        true);
  } else if (status.running) {
    QString text = status.stopping && computing ? tr("stopping") : sentence_text(status.text);
    if (computing) text += tr(" – %1 %").arg(static_cast<int>(100 * status.fraction));
    if (status.left && !status.stopping) text += tr(", about %1 left").arg(time_text(*status.left));
    say(text);
  } else if (!status.problem.empty()) {
    say(tr("The results could not be written. %1").arg(QString::fromStdString(status.problem)), true);
  } else if (was_running_ || table_) {
    say(summary());
  }
}

QString StudiesPanel::summary() const {
  if (!table_) return {};
  QString text = tr("%1 runs%2, in %3")
                     .arg(cloth::finished_runs(*table_))
                     .arg(cloth::is_complete(*table_) ? QString() : tr(" (stopped before the end)"))
                     .arg(shown_path(folder_));
  if (const auto* grids = std::get_if<cloth::GridConvergence>(table_.get()))
    for (std::size_t k = 0; k < grids->outputs.size(); ++k)
      text += QString(". %1: %2")
                  .arg(QString::fromStdString(cloth::words_of_output(grids->outputs[k])),
                       QString::fromStdString(cloth::richardson_of(*grids, k).words).chopped(1));
  if (const auto* validation = std::get_if<cloth::ValidationStudy>(table_.get())) {
    QStringList failed;
    for (const cloth::ValidationRow& row : validation->rows)
      if (!row.holds()) failed << QString::fromStdString(cloth::name_of(row));
    text += failed.isEmpty() ? tr(". All that is promised holds")
                             : tr(". Not what is promised: %1").arg(failed.join(", "));
  }
  return text;
}

void StudiesPanel::show(std::shared_ptr<const cloth::StudyTable> table) {
  table_ = std::move(table);
  offerDiagrams();
  refreshDiagram();
  compareWithForm();
  stack_->setCurrentIndex(1);
}

/// Says so where what is shown is not what the form would give now.
void StudiesPanel::compareWithForm() {
  earlier_->setVisible(table_ && !choices_->describes(*table_));
}

/// The choice stays while the kind of study does.
void StudiesPanel::offerDiagrams() {
  const QStringList diagrams = diagrams_of(*table_);
  QStringList offered;
  for (int k = 0; k < against_->count(); ++k) offered << against_->itemText(k);
  if (offered == diagrams) return;
  const QSignalBlocker quiet(against_);
  against_->clear();
  against_->addItems(diagrams);
}

void StudiesPanel::refreshDiagram() {
  if (table_) plot_->setDiagram(diagram_of(*table_, std::max(0, against_->currentIndex())));
}

void StudiesPanel::openRun(int run) {
  if (!table_) return;
  if (const auto found = cloth::run_of(*table_, run))
    Q_EMIT runOpened(found->scene, sentence_text(found->note));
}

void StudiesPanel::openFolder(const QString& folder) {
  cloth::StudyReading reading = cloth::read_study(folder.toStdString());
  if (!reading.study) {
    say(tr("The study was not opened. %1").arg(QString::fromStdString(reading.problem)), true);
    return;
  }
  folder_ = folder;
  recent_studies.remember(folder);
  show(std::make_shared<const cloth::StudyTable>(std::move(reading.study->table)));
  showStatus({});
}

void StudiesPanel::fillRecentMenu() {
  recent_->clear();
  recent_->addAction(tr("Open a folder…"), this, [this] {
    const QString folder =
        QFileDialog::getExistingDirectory(this, tr("The folder of a study"), studies_folder());
    if (!folder.isEmpty()) openFolder(folder);
  });
  recent_->addSeparator();
  const QStringList recent = recent_studies.list();
  for (const QString& folder : recent)
    recent_->addAction(QDir(folder).dirName(), this, [this, folder] { openFolder(folder); })
        ->setToolTip(folder);
  if (recent.isEmpty()) recent_->addAction(tr("No study was made yet"))->setEnabled(false);
}

QString StudiesPanel::save(const QString& name) {
  if (!table_) return tr("There is no study to save.");
  if (!name.endsWith(".csv", Qt::CaseInsensitive)) return save_diagram(plot_->diagram(), name, font());
  const QString problem = write_file(name, QByteArray::fromStdString(cloth::study_csv(*table_)));
  return problem.isEmpty() ? problem : tr("%1: %2").arg(name, problem);
}

void StudiesPanel::saveAs() {
  const QString name = ask_where_to_save(
      this, tr("Save the study"),
      {{tr("Drawing"), {".svg"}}, {tr("Picture"), {".png"}}, {tr("Page"), {".pdf"}}, {tr("Runs"), {".csv"}}},
      QDir(folder_).filePath("study.svg"));
  if (name.isEmpty()) return;
  const QString problem = save(name);
  say(problem.isEmpty() ? saved_in(tr("study"), name) : problem, !problem.isEmpty());
}

void StudiesPanel::say(const QString& text, bool error) {
  line_->setProperty("state", error ? "error" : "");
  line_->style()->polish(line_);
  line_->setText(text);
  line_->setToolTip(text);
}

}  // namespace clothlab

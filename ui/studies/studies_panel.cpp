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
#include "studies/sweep_choices.h"
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

constexpr int choices_width = 346;  // px

}  // namespace

StudiesPanel::StudiesPanel(LabDocument& document, QWidget* parent) : QWidget(parent), document_(document) {
  setObjectName("studiesPanel");
  makeLayout();
  timer_.setInterval(run_interval);
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
  choices_ = new StudyChoices(document_, left);
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
  column->addWidget(choices_->sweep().time());
  connect(choices_, &StudyChoices::changed, this, [this] {
    choices_->sweep().time()->setVisible(choices_->kind() == StudyChoices::Kind::sweep &&
                                         !choices_->sweep().time()->text().isEmpty());
  });
  auto* buttons = new QHBoxLayout;
  buttons->addWidget(start_, 1);
  buttons->addWidget(cancel_);
  column->addLayout(buttons);
  connect(start_, &QPushButton::clicked, this, &StudiesPanel::start);
  connect(cancel_, &QPushButton::clicked, this, [this] {
    runner_.cancel();
    sweep_.cancel();
    fit_.cancel();
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

QLayout* StudiesPanel::makeHead(QWidget* right) {
  title_ = named("studyTitle", new ElidedLabel(right));
  title_->setProperty("heading", true);
  against_ = named("against", new QComboBox(right));
  save_ = named("saveStudy", new QToolButton(right));
  save_->setIcon(icon("export-plot"));
  save_->setToolTip(tr("Save the diagram as SVG, PNG or PDF, or its runs as CSV"));
  open_ = named("openStudy", new QToolButton(right));
  open_->setIcon(icon("open"));
  open_->setToolTip(tr("Open the folder of a study, or the report of this one"));
  open_->setPopupMode(QToolButton::InstantPopup);
  recent_ = new QMenu(open_);
  open_->setMenu(recent_);
  go_on_ = named("goOn", new QPushButton(tr("Go on here"), right));
  go_on_->setToolTip(tr("Make the points that the folder does not have, on this machine"));
  go_on_->hide();
  use_ = named("useFit", new QPushButton(tr("Use the values"), right));
  use_->setToolTip(tr("Put the fitted values into the scene"));
  use_->hide();
  auto* head = spaced(new QHBoxLayout, spacing);
  head->addWidget(title_, 1);
  head->addWidget(go_on_);
  head->addWidget(use_);
  head->addWidget(against_);
  head->addWidget(open_);
  head->addWidget(save_);
  return head;
}

QWidget* StudiesPanel::makeRight() {
  auto* right = new QWidget(this);
  QLayout* head = makeHead(right);
  makeDiagram(right);
  values_ = named("fitValues", new QLabel(right));
  values_->setTextFormat(Qt::RichText);
  values_->setTextInteractionFlags(Qt::TextSelectableByMouse);
  values_->setWordWrap(true);
  values_->hide();
  bar_ = named("studyProgress", new QProgressBar(right));
  bar_->setRange(0, 1000);
  bar_->setTextVisible(false);
  bar_->setFixedHeight(6);
  line_ = named("studyLine", new ElidedLabel(right));
  line_->setProperty("muted", true);

  auto* column = spaced(new QVBoxLayout(right), spacing / 2);
  column->addLayout(head);
  column->addWidget(earlier_);
  column->addWidget(values_);
  column->addWidget(stack_, 1);
  column->addWidget(bar_);
  column->addWidget(line_);
  connect(against_, &QComboBox::currentIndexChanged, this, &StudiesPanel::refreshDiagram);
  connect(save_, &QToolButton::clicked, this, &StudiesPanel::saveAs);
  connect(recent_, &QMenu::aboutToShow, this, &StudiesPanel::fillRecentMenu);
  connect(plot_, &StudyPlot::runActivated, this, &StudiesPanel::openRun);
  connect(use_, &QPushButton::clicked, this, &StudiesPanel::useFit);
  connect(plot_, &StudyPlot::runClicked, this, &StudiesPanel::openPoint);
  connect(go_on_, &QPushButton::clicked, this, [this] {
    sweep_.goOn();
    was_running_ = true;
    timer_.start(run_interval);
    poll();
  });
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

}  // namespace clothlab

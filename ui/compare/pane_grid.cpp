#include "compare/pane_grid.h"

#include <QGridLayout>
#include <QPainter>
#include <algorithm>
#include <utility>

#include "theme/theme.h"
#include "viewport/strain_scale.h"
#include "widgets/numbers.h"

namespace clothlab {
namespace {

constexpr double least_difference = 1e-9;  // m, at the top of the colours
constexpr int glide_interval = 16;         // ms

constexpr int bar_width = 14, label_room = 60;  // px

}  // namespace

PaneGrid::PaneGrid(QWidget* parent)
    : QWidget(parent),
      grid_(new QGridLayout(this)),
      colour_bar_(new ColourBar(this)),
      differences_(least_difference) {
  setObjectName("paneGrid");
  setFocusPolicy(Qt::ClickFocus);
  grid_->addWidget(colour_bar_, 0, 2, 2, 1);
  colour_bar_->hide();
  grid_->setSpacing(spacing / 2);
  // At once: a window that gets its first OpenGL view after it was shown is made anew.
  addPane();
  layOut();
  colour_timer_.setSingleShot(true);
  colour_timer_.setInterval(glide_interval);
  connect(&colour_timer_, &QTimer::timeout, this, &PaneGrid::followColours);
  colour_clock_.start();
}

void PaneGrid::showComparison(const cloth::Comparison& comparison) {
  const std::size_t count = comparison.panes.size(), before = panes_.size();
  while (panes_.size() < count) addPane();
  while (panes_.size() > count) {
    panes_.back()->hide();  // it may be the sender of the signal that led here
    grid_->removeWidget(panes_.back());
    panes_.back()->disconnect(this);
    panes_.back()->view().disconnect(this);
    panes_.back()->deleteLater();
    panes_.pop_back();
  }
  if (count != before) layOut();
  for (std::size_t i = 0; i < count; ++i) {
    panes_[i]->showPane(comparison, i, count < cloth::max_panes);
    panes_[i]->view().setSheet(comparison.scene.cloth);
  }
  if (isOne() && colouring_ == Colouring::difference) setMode(mode_);  // there is none
  followColours();
}

void PaneGrid::addPane() {
  auto* pane = new PaneView(this);
  ClothView& view = pane->view();
  view.setTool(tool_);
  view.setProbeMeasure(probe_measure_);
  view.setSmoothAtRest(isOne() || !playing_);
  view.setMode(mode_);
  view.setContact(contact_);
  view.setObstaclesMovable(true);
  if (!panes_.empty()) {
    view.setAnimated(this->view().animated());
    if (this->view().cameraWasMoved()) view.setCameraPose(this->view().camera().pose());
  }
  const std::size_t i = panes_.size();
  panes_.push_back(pane);
  connectHead(*pane, i);
  connectView(view, i);
}

void PaneGrid::connectHead(PaneView& pane, std::size_t i) {
  connect(&pane, &PaneView::methodChosen, this,
          [this, i](const std::string& method) { Q_EMIT methodChosen(i, method); });
  connect(&pane, &PaneView::stepChosen, this,
          [this, i](const cloth::ParameterValue& step) { Q_EMIT stepChosen(i, step); });
  connect(&pane, &PaneView::duplicateWanted, this, [this, i] { Q_EMIT duplicateWanted(i); });
  connect(&pane, &PaneView::removeWanted, this, [this, i] { Q_EMIT removeWanted(i); });
  connect(&pane, &PaneView::referenceWanted, this, [this, i] { Q_EMIT referenceWanted(i); });
  connect(&pane, &PaneView::remedyChosen, this,
          [this, i](const Remedy& remedy) { Q_EMIT remedyChosen(i, remedy); });
}

void PaneGrid::connectView(ClothView& view, std::size_t i) {
  connect(&view, &ClothView::pullChanged, this, &PaneGrid::pullChanged);
  connect(&view, &ClothView::pullEnded, this, &PaneGrid::pullEnded);
  connect(&view, &ClothView::brushChanged, this, &PaneGrid::brushChanged);
  connect(&view, &ClothView::brushEnded, this, &PaneGrid::brushEnded);
  connect(&view, &ClothView::pinToggled, this, &PaneGrid::pinToggled);
  connect(&view, &ClothView::probeWanted, this, &PaneGrid::probeWanted);
  connect(&view, &ClothView::obstacleMoveStarted, this, &PaneGrid::obstacleMoveStarted);
  connect(&view, &ClothView::obstacleMoved, this, &PaneGrid::obstacleMoved);
  connect(&view, &ClothView::obstacleMoveEnded, this, &PaneGrid::obstacleMoveEnded);
  connect(&view, &ClothView::openGlFailed, this, &PaneGrid::openGlFailed);
  connect(&view, &ClothView::toolChanged, this, &PaneGrid::setTool);
  connect(&view, &ClothView::modeChanged, this, [this](ViewMode mode) {
    if (mode != mode_) setMode(mode);
  });
  connect(&view, &ClothView::contactChosen, this, &PaneGrid::setContact);
  connect(&view, &ClothView::cameraMoved, this,
          [this, &view](const CameraPose& pose) { followCamera(view, pose); });
  if (i > 0) return;
  connect(&view, &ClothView::hierarchyDepthChanged, this, &PaneGrid::hierarchyDepthChanged);
  connect(&view, &ClothView::frameDrawn, this, &PaneGrid::frameDrawn);
}

/// Two panes beside each other; three and four in two rows.
void PaneGrid::layOut() {
  for (PaneView* pane : panes_) grid_->removeWidget(pane);
  for (std::size_t i = 0; i < panes_.size(); ++i) {
    const int row = static_cast<int>(i) / 2, column = static_cast<int>(i) % 2;
    grid_->addWidget(panes_[i], row, column);
    panes_[i]->show();
  }
  for (int line = 0; line < 2; ++line) {
    grid_->setColumnStretch(line, 1);
    grid_->setRowStretch(line, line == 0 || panes_.size() > 2 ? 1 : 0);
  }
  grid_->setColumnStretch(1, isOne() ? 0 : 1);
  const int margin = isOne() ? 0 : spacing / 2;
  grid_->setContentsMargins(margin, margin, margin, margin);
  for (PaneView* pane : panes_) {
    pane->setAlone(isOne());
    pane->setLow(is_low_);
    pane->view().setSmoothAtRest(isOne() || !playing_);
  }
}

void PaneGrid::setLow(bool low) {
  is_low_ = low;
  for (PaneView* pane : panes_) pane->setLow(low);
  for (QWidget* widget = this; widget && !widget->isWindow(); widget = widget->parentWidget())
    if (widget->layout()) widget->layout()->activate();  // at once: nothing grows for the height before
}

void PaneGrid::followCamera(const ClothView& moved, const CameraPose& pose) {
  for (PaneView* pane : panes_)
    if (&pane->view() != &moved) pane->view().setCameraPose(pose);
}

void PaneGrid::showFrame(std::size_t pane, std::shared_ptr<const ClothFrame> frame) {
  if (pane < panes_.size()) panes_[pane]->view().showFrame(std::move(frame));
}

/// While the run plays, no smooth pictures are drawn between the frames of different panes.
void PaneGrid::followPlaying(bool playing) {
  if (playing == playing_) return;
  playing_ = playing;
  for (PaneView* pane : panes_) pane->view().setSmoothAtRest(isOne() || !playing);
}

void PaneGrid::showResults(const WorkerStatus& status) {
  const bool has_reference = status.comparison && status.comparison->reference != cloth::no_reference;
  if (std::exchange(starts_, status.starts) != status.starts)
    for (PaneView* pane : panes_) pane->forgetStop();
  for (std::size_t i = 0; i < std::min(panes_.size(), status.panes.size()); ++i)
    panes_[i]->showResult(status.panes[i], has_reference);
  followPlaying(status.playing);
  followColours();
}

/// The same colour is the same value in all panes.
void PaneGrid::followColours() {
  colour_bar_->setVisible(mode_ == ViewMode::strain && !isOne());
  if (isOne()) view().setColourMaximum(std::nullopt);
  if (mode_ != ViewMode::strain || isOne()) return;
  double largest = 0, rate = -1;
  bool difference = false;
  for (PaneView* pane : panes_) {
    const auto& frame = pane->view().frame();
    if (!frame) continue;
    largest = std::max(largest, static_cast<double>(frame->largest_strain));
    difference = frame->shows_difference;
    if (!difference) rate = std::max(rate, frame->deformation_rate);
  }
  StrainRange& range = difference ? differences_ : strains_;
  range.follow(largest, rate, 1e-9 * static_cast<double>(colour_clock_.nsecsElapsed()));
  colour_clock_.restart();
  for (PaneView* pane : panes_) pane->view().setColourMaximum(range.maximum());
  if (difference)
    colour_bar_->showRange(tr("Difference [mm]"), range.maximum(), 1000, -1);
  else
    colour_bar_->showRange(tr("Strain [%]"), range.maximum(), 100, rate);
  if (!range.settled()) colour_timer_.start();
}

void PaneGrid::resetCamera() {
  strains_.reset();
  differences_.reset();
  for (PaneView* pane : panes_) pane->view().resetCamera();
}

void PaneGrid::setTool(Tool tool) {
  if (std::exchange(tool_, tool) == tool) return;
  for (PaneView* pane : panes_) pane->view().setTool(tool);
  Q_EMIT toolChanged(tool);
}

void PaneGrid::setProbeMeasure(cloth::ProbeMeasure measure) {
  probe_measure_ = measure;
  for (PaneView* pane : panes_) pane->view().setProbeMeasure(measure);
}

void PaneGrid::setMode(ViewMode mode, Colouring colouring) {
  if (mode == mode_ && colouring == colouring_) return;
  mode_ = mode;
  colouring_ = colouring;
  for (PaneView* pane : panes_) pane->view().setMode(mode);
  followColours();
  Q_EMIT modeChanged(mode, colouring);
}

void PaneGrid::setContact(const ContactChoice& choice) {
  if (choice == contact_) return;
  contact_ = choice;
  for (PaneView* pane : panes_) pane->view().setContact(choice);
  Q_EMIT contactChosen(choice);
}

QImage PaneGrid::grabPicture() {
  if (isOne()) return view().grabPicture();
  QImage picture = grab().toImage();
  QPainter painter(&picture);
  for (PaneView* pane : panes_)
    painter.drawImage(pane->view().mapTo(this, QPoint()), pane->view().grabPicture());
  return picture;
}

void ColourBar::showRange(const QString& title, double maximum, double factor, double limit) {
  if (title == title_ && maximum == maximum_ && factor == factor_ && limit == limit_) return;
  title_ = title;
  maximum_ = maximum;
  factor_ = factor;
  limit_ = limit;
  setAccessibleName(title_);
  setToolTip(tr("The same colour is the same value in all panes"));
  update();
}

QSize ColourBar::sizeHint() const {
  const int widest = fontMetrics().horizontalAdvance(tr("Difference"));
  return {std::max(bar_width + label_room, widest) + 2 * spacing, 300};
}

void ColourBar::paintEvent(QPaintEvent*) {
  QPainter painter(this);
  painter.setRenderHint(QPainter::Antialiasing);
  const int line = fontMetrics().height();
  painter.setPen(theme().text);
  const QRect head(spacing / 2, spacing, width() - spacing, 2 * line);
  painter.drawText(head, Qt::AlignLeft | Qt::AlignTop, QString(title_).replace(' ', '\n'));

  const QRectF bar(spacing / 2.0, head.bottom() + spacing + line / 2.0, bar_width,
                   height() - head.bottom() - 2 * spacing - line);
  paint_colour_scale(
      painter, bar, maximum_, label_room, [this](double value) { return number_text(factor_ * value, 3); },
      theme());
  if (limit_ < 0 || limit_ > maximum_) return;
  painter.setPen(QPen(theme().limit, 2));
  const double y = bar.bottom() - bar.height() * limit_ / maximum_;
  painter.drawLine(QPointF(bar.left() - 3, y), QPointF(bar.right() + 3, y));
}

}  // namespace clothlab

// The panes side by side: one camera, one tool, one way of colouring and one range of colours for all. A
// scene is one pane without a head and without a frame, which chooses its own range of colours.
#pragma once

#include <QElapsedTimer>
#include <QTimer>
#include <QWidget>
#include <vector>

#include "bridge/worker_commands.h"
#include "bridge/worker_status.h"
#include "compare/pane_view.h"

class QGridLayout;

namespace clothlab {

/// What the colours of all panes stand for: one bar beside them.
class ColourBar : public QWidget {
  Q_OBJECT

 public:
  using QWidget::QWidget;

  /// `maximum` at the top, times `factor` in the unit of the title; a negative `limit` is none.
  void showRange(const QString& title, double maximum, double factor, double limit);

  double maximum() const { return maximum_; }
  const QString& title() const { return title_; }

  QSize sizeHint() const override;
  QSize minimumSizeHint() const override { return {sizeHint().width(), 100}; }

 protected:
  void paintEvent(QPaintEvent* event) override;

 private:
  QString title_;
  double maximum_ = 1, factor_ = 1, limit_ = -1;
};

class PaneGrid : public QWidget {
  Q_OBJECT

 public:
  explicit PaneGrid(QWidget* parent = nullptr);

  /// Shows the comparison's panes with their names, methods and steps.
  void showComparison(const cloth::Comparison& comparison);
  void showFrame(std::size_t pane, std::shared_ptr<const ClothFrame> frame);
  void showResults(const WorkerStatus& status);
  /// Says again why panes have stopped.
  void sayStops() {
    for (PaneView* pane : panes_) pane->sayStop();
  }
  /// The cameras frame the next frames, as after opening another scene.
  void resetCamera();

  std::size_t paneCount() const { return panes_.size(); }
  PaneView& pane(std::size_t i) { return *panes_[i]; }
  /// Of the first pane: what holds for all, as tool and camera, can be asked there.
  ClothView& view() { return panes_.front()->view(); }

  void setTool(Tool tool);
  void setProbeMeasure(cloth::ProbeMeasure measure);
  /// `colouring` counts where the mode shows colours.
  void setMode(ViewMode mode, Colouring colouring = Colouring::strain);
  ViewMode mode() const { return mode_; }
  void setContact(const ContactChoice& choice);
  void setLow(bool low);                                             ///< PaneView::setLow()
  void setPreset(CameraPreset preset) { view().setPreset(preset); }  ///< the others follow
  void frameAll() { view().frameAll(); }

  /// A picture of the panes as they are shown, in device pixels.
  QImage grabPicture();

 Q_SIGNALS:
  void toolChanged(clothlab::Tool tool);
  void modeChanged(clothlab::ViewMode mode, clothlab::Colouring colouring);
  void contactChosen(const clothlab::ContactChoice& choice);
  void hierarchyDepthChanged(int depth);
  void openGlFailed();
  void frameDrawn(double milliseconds);  ///< of the first pane
  void methodChosen(std::size_t pane, const std::string& method);
  void stepChosen(std::size_t pane, const cloth::ParameterValue& step);
  void duplicateWanted(std::size_t pane);
  void removeWanted(std::size_t pane);
  void referenceWanted(std::size_t pane);
  void remedyChosen(std::size_t pane, const clothlab::Remedy& remedy);
  void pullChanged(const cloth::Pull& pull);
  void pullEnded();
  void brushChanged(const cloth::BrushGust& gust);
  void brushEnded();
  void pinToggled(int particle);
  void probeWanted(const cloth::Probe& probe);
  void obstacleMoveStarted(int obstacle);
  void obstacleMoved(int obstacle, const Eigen::Vector3d& by);
  void obstacleMoveEnded(int obstacle, bool kept);

 private:
  void addPane();
  void connectHead(PaneView& pane, std::size_t i);
  void connectView(ClothView& view, std::size_t i);
  void layOut();
  bool isOne() const { return panes_.size() == 1; }
  void followPlaying(bool playing);
  void followCamera(const ClothView& moved, const CameraPose& pose);
  void followColours();

  QGridLayout* grid_;
  ColourBar* colour_bar_;
  std::vector<PaneView*> panes_;
  bool playing_ = false;
  std::int64_t starts_ = 0;  ///< of the comparison, that the results are from
  Tool tool_ = Tool::pull;
  cloth::ProbeMeasure probe_measure_ = cloth::ProbeMeasure::particle;
  bool is_low_ = false;
  ViewMode mode_ = ViewMode::textured;
  Colouring colouring_ = Colouring::strain;
  ContactChoice contact_;
  StrainRange strains_;
  StrainRange differences_;
  QTimer colour_timer_;         ///< runs while the colour range changes
  QElapsedTimer colour_clock_;  ///< since the range was followed last
};

}  // namespace clothlab

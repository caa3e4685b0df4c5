// The 3-D view: draws the newest frame and turns mouse and keyboard input into camera motion and signals. It
// does not simulate: pull, wind brush, pins and moved obstacles are reported by signals. GUI thread only.
//
//   left-drag      on the cloth: pull a particle; beside it: orbit   (tool pin: click pins or frees a
//   particle) Shift+left     wind brush, also without Shift when it is the tool; wheel while blowing: radius
//   left click     with the tool probe: chooses a particle; Escape: forgets those chosen
//   left-drag      on the handle that a hovered obstacle shows: move the obstacle; Escape: back
//   right, middle  orbit (also Alt+left); with Ctrl+right or Shift+middle: pan; wheel: zoom towards the
//   cursor
#pragma once

#include <QElapsedTimer>
#include <QImage>
#include <QSurfaceFormat>
#include <QWidget>
#include <memory>
#include <optional>

#include "bridge/frame.h"
#include "forces/hand.h"
#include "viewport/camera.h"
#include "viewport/gl_canvas.h"
#include "viewport/obstacle_handle.h"
#include "viewport/overlay.h"
#include "viewport/scene_extent.h"
#include "viewport/strain_scale.h"
#include "viewport/view_mode.h"

class QLabel;

namespace clothlab {

class ClothRenderer;
struct Shot;
struct Theme;

class ClothView : public QWidget {
  Q_OBJECT

 public:
  explicit ClothView(QWidget* parent = nullptr);
  ClothView(CanvasKind canvas, QWidget* parent);
  ~ClothView() override;

  /// OpenGL 3.3 core, 4 samples; where the processor draws (once a QGuiApplication is there to ask) none.
  static QSurfaceFormat surface_format();

  /// False: the view shows a message instead of the scene, and takes no mouse.
  bool hasOpenGl() const { return problem_.isEmpty(); }
  QString openGlProblem() const { return problem_; }

  /// Shows a frame instead of the present one. Frames whose array sizes do not fit rows x columns are
  /// ignored.
  void showFrame(std::shared_ptr<const ClothFrame> frame);
  const std::shared_ptr<const ClothFrame>& frame() const { return frame_; }
  /// Where the labels of the probes were drawn last, px.
  const std::vector<QRectF>& probeLabels() const { return overlay_.labels(); }
  /// Removes the frame and shows the empty state.
  void clear();

  ViewMode mode() const { return mode_; }
  void setMode(ViewMode mode);
  /// Sets the maximum of the colour range for several views with one common colour bar; nullopt: the view
  /// chooses its own range and shows a bar.
  void setColourMaximum(std::optional<double> maximum);
  Tool tool() const { return tool_; }
  void setTool(Tool tool);

  /// What the tool probe measures, by how many clicks; and the cloth whose particles it names.
  void setProbeMeasure(cloth::ProbeMeasure measure);
  void setSheet(const cloth::ClothSheet& sheet);

  /// The contact data to show; frames contain it once the worker has handled contactChosen().
  const ContactChoice& contact() const { return contact_; }
  void setContact(const ContactChoice& choice);
  /// Whether obstacles show a handle to drag them by.
  void setObstaclesMovable(bool movable);

  const Camera& camera() const { return camera_; }
  void setCameraPose(const CameraPose& pose);
  bool cameraWasMoved() const { return camera_moved_; }  ///< by the user, since resetCamera()
  void frameAll();
  /// Whether all of the cloth is outside the picture, or nearly all if the user has not moved the camera. The
  /// view then shows a hint.
  bool clothIsOutOfSight() const;
  void setPreset(CameraPreset preset) { flyTo(camera_.seen_from(preset)); }
  /// For a newly opened scene: the next frame is framed, and every new topology until the user moves the
  /// camera.
  void resetCamera();
  bool animated() const { return animated_; }
  void setAnimated(bool animated) { animated_ = animated; }  ///< camera presets are animated or immediate

  double brushRadius() const { return brush_radius_; }  ///< px
  void setBrushRadius(double pixels);
  static constexpr double brush_speed_per_pixel = 0.05;  ///< m/s per px of displacement

  /// Where the processor draws: whether the view is drawn once more, smoothly, a moment after the last
  /// movement.
  void setSmoothAtRest(bool on) {
    if (canvas_) canvas_->setSmoothAtRest(on);
  }

  /// The view with its overlays, in device pixels.
  QImage grabPicture();
  /// ms spent drawing last time. Where the processor draws, until the picture was made; a graphics
  /// card is not waited for, since waiting would slow it, so there it is the time to hand the picture over.
  double lastDrawMilliseconds() const { return last_draw_; }
  /// Of these, for giving a new frame's geometry to OpenGL; 0 where there was none.
  double lastUploadMilliseconds() const { return last_upload_; }

 Q_SIGNALS:
  void openGlFailed(QString reason);
  void frameDrawn(double milliseconds);
  void pullChanged(cloth::Pull pull);
  void pullEnded();
  void brushChanged(cloth::BrushGust gust);
  void brushEnded();
  void pinToggled(int particle);
  void probeWanted(const cloth::Probe& probe);  ///< without a name
  void toolChanged(clothlab::Tool tool);
  void modeChanged(clothlab::ViewMode mode);
  void contactChosen(const clothlab::ContactChoice& choice);
  void hierarchyDepthChanged(int depth);  ///< levels of the scene's hierarchies of boxes, 0: it has none
  void obstacleMoveStarted(int obstacle);
  void obstacleMoved(int obstacle, const Eigen::Vector3d& by);  ///< m, since the start
  void obstacleMoveEnded(int obstacle, bool kept);              ///< not kept: it was taken back
  void cameraMoved(const clothlab::CameraPose& pose);           ///< by the user, also on the way of a flight

 protected:
  bool eventFilter(QObject* watched, QEvent* event) override;
  void resizeEvent(QResizeEvent* event) override;
  void changeEvent(QEvent* event) override;
  void mousePressEvent(QMouseEvent* event) override;
  void mouseMoveEvent(QMouseEvent* event) override;
  void mouseReleaseEvent(QMouseEvent* event) override;
  void wheelEvent(QWheelEvent* event) override;
  void enterEvent(QEnterEvent* event) override;
  void leaveEvent(QEvent* event) override;
  void hideEvent(QHideEvent* event) override;

 private:
  enum class Gesture { none, orbit, pan, pull, brush, click, obstacle };

  void initialiseGl();
  void resizeGl(int width, int height);
  void drawGl(bool quick, double fineness);
  void redraw() {
    if (canvas_) canvas_->redraw();
  }
  void repaintOver() {
    if (canvas_) canvas_->repaintOver();
  }
  void fail(const QString& reason);
  void releaseRenderer();
  void learnExtent(bool new_topology);
  void fitUnmovedCamera();
  void flyTo(const CameraPose& pose);
  void advanceTime();
  Shot shot(double fineness) const;  ///< see GlCanvas::Callbacks::draw
  double colourMaximum() const { return colour_maximum_.value_or(strain_range_.maximum()); }
  void paintOverlays(QPainter& painter);
  void paintHand(QPainter& painter);
  void paintHandle(QPainter& painter);
  void paintProbes(QPainter& painter);
  void paintProbesOf(bool shape, QPainter& painter);
  void paintProbeTool(QPainter& painter);
  void paintContactNote(QPainter& painter);
  bool showsMode() const;
  QPointF screenPoint(int particle) const;
  QPolygonF screenLine(const std::vector<int>& particles) const;

  void startLeftGesture(QPointF at, Qt::KeyboardModifiers modifiers);
  void endGesture();
  void moveCamera(QPointF by);
  void sendPull();
  void sendBrush();
  void updateHover();
  void updateHandle();
  void followHierarchy();
  bool startObstacleMove(QPointF at);
  void sendObstacleMove();
  void cancelObstacleMove();
  void followShift(bool held);
  void clickProbe(int particle);
  void forgetProbeClicks();
  bool sheetFits() const;  ///< the frame is of this sheet
  std::vector<cloth::ParticlePlace> probePlaces(std::optional<int> next) const;
  std::vector<int> previewParticles() const;
  bool brushShown() const;
  void updateCursor();
  std::optional<int> pick(QPointF at) const;

  QString problem_;
  QLabel* problem_label_ = nullptr;
  std::unique_ptr<GlCanvas> canvas_;  // none without OpenGL
  std::unique_ptr<ClothRenderer> renderer_;

  std::shared_ptr<const ClothFrame> frame_;
  bool frame_uploaded_ = false;
  std::vector<cloth::Obstacle> known_obstacles_;
  Eigen::AlignedBox3d cloth_reach_, extent_;
  Ground ground_;

  Camera camera_;
  CameraFlight flight_;
  bool animated_ = true;
  bool camera_moved_ = false;  // by the user, since the scene was opened
  QElapsedTimer clock_;        // since the last picture

  ViewMode mode_ = ViewMode::textured;
  StrainRange strain_range_;
  std::optional<double> colour_maximum_;
  Overlay overlay_;
  const Theme* painted_theme_ = nullptr;
  double last_draw_ = 0, last_upload_ = 0;  // ms

  Tool tool_ = Tool::pull;
  Gesture gesture_ = Gesture::none;
  Qt::MouseButton gesture_button_ = Qt::NoButton;
  QPointF cursor_, gesture_start_;  // px
  bool cursor_inside_ = false, shift_held_ = false;
  std::optional<int> hovered_, grabbed_;
  Eigen::Vector3d grab_point_{0, 0, 0};  // m
  ContactChoice contact_;
  int hierarchy_depth_ = 0;
  bool obstacles_movable_ = false, obstacle_move_kept_ = true;
  std::optional<ObstacleHandle> handle_;  // shown; its place as when the move began
  ObstacleHandle::Part handle_part_ = ObstacleHandle::Part::none;
  Eigen::Vector2d handle_start_{0, 0};  // px
  double brush_radius_ = 80;            // px
  cloth::ProbeMeasure probe_measure_ = cloth::ProbeMeasure::particle;
  cloth::ClothSheet sheet_;
  std::vector<cloth::ParticlePlace> probe_clicks_;
};

}  // namespace clothlab

#include "viewport/cloth_view.h"

#include <QGuiApplication>
#include <QLabel>
#include <QOpenGLContext>
#include <QPainter>
#include <QTimer>
#include <QVBoxLayout>
#include <algorithm>

#include "theme/theme.h"
#include "viewport/gl/cloth_renderer.h"
#include "viewport/gl/gl_probe.h"
#include "viewport/gl/weave.h"
#include "viewport/picking.h"

// Outside any namespace, as Qt's macro wants it: a static library's resources are linked only if something
// asks.
static void load_viewport_resources() {
  Q_INIT_RESOURCE(viewport_resources);
}

namespace clothlab {
namespace {

bool sizes_agree(const ClothFrame& frame) {
  if (frame.rows < 0 || frame.columns < 0) return false;
  const std::size_t count = static_cast<std::size_t>(frame.rows) * static_cast<std::size_t>(frame.columns);
  return frame.positions.size() == 3 * count && frame.normals.size() == 3 * count &&
         frame.strain.size() == count && frame.pinned.size() == count;
}

bool has_cloth(const std::shared_ptr<const ClothFrame>& frame) {
  return frame && frame->has_cloth();
}

}  // namespace

ClothView::ClothView(QWidget* parent) : ClothView(suitable_canvas(), parent) {}

ClothView::ClothView(CanvasKind canvas, QWidget* parent) : QWidget(parent) {
  load_viewport_resources();
  begin_shared_weave();
  setMinimumSize(160, 120);
  setMouseTracking(true);
  setFocusPolicy(Qt::ClickFocus);
  clock_.start();
  if (!gl_abilities().usable) {
    fail(gl_abilities().problem);
    return;
  }
  canvas_ = make_canvas(canvas, this,
                        {[this] { initialiseGl(); }, [this](int w, int h) { resizeGl(w, h); },
                         [this](bool quick, double fineness) { drawGl(quick, fineness); },
                         [this](QPainter& painter) { paintOverlays(painter); },
                         [this](double milliseconds) {
                           last_draw_ = milliseconds;
                           Q_EMIT frameDrawn(milliseconds);
                         }});
}

ClothView::~ClothView() {
  releaseRenderer();
  canvas_.reset();  // while the view it calls back is still whole
}

QSurfaceFormat ClothView::surface_format() {
  QSurfaceFormat format;
  format.setRenderableType(QSurfaceFormat::OpenGL);
  format.setVersion(3, 3);
  format.setProfile(QSurfaceFormat::CoreProfile);
  format.setDepthBufferSize(24);
  format.setStencilBufferSize(8);
  format.setSamples(qGuiApp && gl_abilities().software ? 0 : 4);
  return format;
}

void ClothView::fail(const QString& reason) {
  problem_ = reason;
  if (canvas_) canvas_->widget().hide();
  if (!problem_label_) {
    problem_label_ = new QLabel(this);
    problem_label_->setAlignment(Qt::AlignCenter);
    problem_label_->setWordWrap(true);
    problem_label_->setAutoFillBackground(true);
    problem_label_->setMargin(4 * spacing);
    auto* layout = new QVBoxLayout(this);
    layout->setContentsMargins(0, 0, 0, 0);
    layout->addWidget(problem_label_);
  }
  problem_label_->setText(
      tr("<h3>The 3-D view cannot be shown</h3><p>%1</p><p>Everything else works: charts, "
         "parameters and recording.</p>")
          .arg(reason.toHtmlEscaped()));
  problem_label_->show();
  // Not at once: nothing is connected yet while the view is being made.
  QTimer::singleShot(0, this, [this] { Q_EMIT openGlFailed(problem_); });
}

// ---- what is shown

void ClothView::showFrame(std::shared_ptr<const ClothFrame> frame) {
  if (!frame || !sizes_agree(*frame)) return;
  const bool new_topology = !frame_ || frame_->topology != frame->topology || frame_->rows != frame->rows ||
                            frame_->columns != frame->columns;
  if (new_topology) {
    if (gesture_ == Gesture::pull || gesture_ == Gesture::click || gesture_ == Gesture::obstacle)
      endGesture();
    hovered_.reset();
    strain_range_.reset();
  }
  frame_ = std::move(frame);
  frame_uploaded_ = false;
  followHierarchy();
  learnExtent(new_topology);
  if (new_topology) fitUnmovedCamera();
  redraw();
}

void ClothView::clear() {
  endGesture();
  hovered_.reset();
  auto nothing = std::make_shared<ClothFrame>();
  showFrame(std::move(nothing));
}

void ClothView::learnExtent(bool new_topology) {
  if (new_topology) cloth_reach_ = reach_of_cloth(*frame_);
  if (!new_topology && frame_->obstacles == known_obstacles_) return;
  known_obstacles_ = frame_->obstacles;
  extent_ = cloth_reach_;
  extent_.extend(reach_of_obstacles(known_obstacles_));
  ground_ = ground_below(cloth_reach_, known_obstacles_);
}

void ClothView::setMode(ViewMode mode) {
  if (mode == mode_) return;
  mode_ = mode;
  redraw();
  Q_EMIT modeChanged(mode);
}

void ClothView::setColourMaximum(std::optional<double> maximum) {
  if (maximum == colour_maximum_) return;
  colour_maximum_ = maximum;
  if (mode_ == ViewMode::strain) redraw();
}

// ---- camera

void ClothView::fitUnmovedCamera() {
  if (camera_moved_ || extent_.isEmpty()) return;
  flight_.stop();
  camera_.set_pose(camera_.framed(extent_, camera_.pose()));
  redraw();
}

void ClothView::setCameraPose(const CameraPose& pose) {
  camera_moved_ = true;
  flight_.stop();
  camera_.set_pose(pose);
  redraw();
}

void ClothView::flyTo(const CameraPose& pose) {
  camera_moved_ = true;
  if (!animated_) {
    setCameraPose(pose);
    Q_EMIT cameraMoved(pose);
    return;
  }
  clock_.restart();  // the animation starts now, not at the time of the last picture
  flight_.start(camera_.pose(), pose);
  redraw();
}

void ClothView::frameAll() {
  if (!frame_) return;
  Eigen::AlignedBox3d box = bounds_of_cloth(*frame_);
  box.extend(bounds_of_obstacles(*frame_));
  flyTo(camera_.framed(box, camera_.pose()));
}

bool ClothView::clothIsOutOfSight() const {
  if (!has_cloth(frame_)) return false;
  const double seen = share_in_picture(*frame_, camera_, {width(), height()});
  constexpr double nearly_none = 0.1;
  return camera_moved_ ? seen == 0 : seen < nearly_none;
}

void ClothView::resetCamera() {
  camera_moved_ = false;
  flight_.stop();
  camera_.set_pose(CameraPose());
  fitUnmovedCamera();
}

// ---- drawing

void ClothView::initialiseGl() {
  if (!hasOpenGl()) return;  // it has been tried
  if (!canvas_->context()) return fail(tr("This display offers no OpenGL."));
  // A view that moves to another window gets a new context; the resources of the old context are deleted with
  // it.
  connect(canvas_->context(), &QOpenGLContext::aboutToBeDestroyed, this, &ClothView::releaseRenderer,
          Qt::UniqueConnection);
  QString reason;
  const std::pair<int, int> version = canvas_->context()->format().version();
  if (version < std::pair(3, 3)) {
    reason =
        tr("This display offers OpenGL %1.%2; the view needs 3.3.").arg(version.first).arg(version.second);
  } else {
    renderer_ = std::make_unique<ClothRenderer>();
    if (renderer_->initialise(gl_abilities().software, &reason)) {
      frame_uploaded_ = false;
      return;
    }
    renderer_.reset();
  }
  fail(reason);
}

void ClothView::releaseRenderer() {
  if (!renderer_) return;
  canvas_->makeCurrent();
  renderer_.reset();
  canvas_->doneCurrent();
}

void ClothView::resizeGl(int width, int height) {
  camera_.set_viewport(width, height);
  fitUnmovedCamera();
}

void ClothView::advanceTime() {
  const double seconds = std::min(1e-9 * static_cast<double>(clock_.nsecsElapsed()), 0.1);
  clock_.restart();
  if (flight_.flying()) {
    camera_.set_pose(flight_.advance(seconds));
    Q_EMIT cameraMoved(camera_.pose());
  }
  if (mode_ == ViewMode::strain && frame_ && !colour_maximum_) {
    strain_range_.follow(frame_->largest_strain, frame_->deformation_rate, seconds);
    if (!strain_range_.settled()) redraw();
  }
  if (flight_.flying()) redraw();
}

Shot ClothView::shot(double fineness) const {
  Shot shot;
  shot.world_to_clip = camera_.projection() * camera_.view();
  shot.eye = camera_.eye();
  shot.right = camera_.right();
  shot.up = camera_.up();
  shot.forward = camera_.forward();
  shot.pixel_ratio = fineness * devicePixelRatioF();
  shot.metres_per_pixel = camera_.metres_per_pixel() / shot.pixel_ratio;
  shot.mode = mode_;
  shot.strain_maximum = colourMaximum();
  shot.contact = contact_.marks || contact_.box_level >= 0;
  shot.ground = ground_;
  shot.extent = extent_;
  return shot;
}

void ClothView::drawGl(bool quick, double fineness) {
  if (!renderer_) return;
  advanceTime();
  last_upload_ = 0;
  if (frame_ && !frame_uploaded_) {
    updateHover();  // the cloth may have moved under a resting cursor
    QElapsedTimer timer;
    timer.start();
    renderer_->set_frame(*frame_);
    last_upload_ = 1e-6 * static_cast<double>(timer.nsecsElapsed());
    frame_uploaded_ = true;
  }
  Shot seen = shot(fineness);
  seen.quick = quick;
  renderer_->draw(seen, theme());
}

void ClothView::paintOverlays(QPainter& painter) {
  if (!renderer_) return;
  const Theme& look = theme();
  if (painted_theme_ != &look) overlay_.forget();
  painted_theme_ = &look;
  painter.setFont(font());
  overlay_.begin_labels();
  if (!has_cloth(frame_)) {
    overlay_.message(painter, size(), look, tr("No cloth yet"), tr("Open a scene, or drop one here."));
    return;
  }
  const auto quantity = frame_->shows_difference ? Overlay::Quantity::difference : Overlay::Quantity::strain;
  if (mode_ == ViewMode::strain && !colour_maximum_)
    overlay_.colour_bar(painter, size(), look, colourMaximum(), frame_->deformation_rate);
  if (showsMode()) overlay_.mode_name(painter, look, mode_, quantity);
  paintContactNote(painter);
  if (clothIsOutOfSight())
    overlay_.hint(painter, size(), look, tr("The cloth has left the picture. Press F to see it."));
  paintProbes(painter);
  paintHandle(painter);
  paintProbeTool(painter);
  paintHand(painter);
}

void ClothView::paintHand(QPainter& painter) {
  const Theme& look = theme();
  if (gesture_ == Gesture::pull && grabbed_) {
    overlay_.pull_line(painter, look, screenPoint(*grabbed_), cursor_);
  } else if (brushShown()) {
    const bool blowing = gesture_ == Gesture::brush;
    const QPointF start = blowing ? gesture_start_ : cursor_;
    const double speed = brush_speed_per_pixel * QLineF(start, cursor_).length();
    overlay_.brush(painter, look, {cursor_, start, brush_radius_, speed, blowing});
  } else if (hovered_ && handle_part_ == ObstacleHandle::Part::none &&
             (gesture_ == Gesture::none || gesture_ == Gesture::click)) {
    Overlay::Ring ring = Overlay::Ring::highlight;
    if (tool_ == Tool::pin)
      ring = frame_->pinned[static_cast<std::size_t>(*hovered_)] ? Overlay::Ring::remove : Overlay::Ring::add;
    overlay_.ring(painter, look, screenPoint(*hovered_), ring);
  }
}

QImage ClothView::grabPicture() {
  return hasOpenGl() ? canvas_->grab() : grab().toImage();
}

void ClothView::resizeEvent(QResizeEvent* event) {
  QWidget::resizeEvent(event);
  if (canvas_) canvas_->widget().setGeometry(rect());
}

void ClothView::changeEvent(QEvent* event) {
  QWidget::changeEvent(event);
  const QEvent::Type type = event->type();
  if (type != QEvent::PaletteChange && type != QEvent::FontChange && type != QEvent::StyleChange &&
      type != QEvent::LanguageChange)
    return;
  overlay_.forget();
  redraw();
}

}  // namespace clothlab

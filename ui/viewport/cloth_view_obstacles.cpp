// ClothView: moving obstacles by mouse, and showing contact.
#include <QPainter>

#include "theme/theme.h"
#include "viewport/cloth_view.h"

namespace clothlab {

void ClothView::setObstaclesMovable(bool movable) {
  obstacles_movable_ = movable;
  updateHover();
}

void ClothView::setContact(const ContactChoice& choice) {
  if (choice == contact_) return;
  contact_ = choice;
  redraw();
  Q_EMIT contactChosen(choice);
}

void ClothView::followHierarchy() {
  const int depth = frame_->contact.depth;
  if (depth == hierarchy_depth_) return;
  hierarchy_depth_ = depth;
  Q_EMIT hierarchyDepthChanged(depth);
}

/// The handle under a cursor that does nothing else, and whether the cursor is on a part of it.
void ClothView::updateHandle() {
  std::optional<ObstacleHandle> found;
  if (obstacles_movable_ && cursor_inside_ && frame_ && frame_->has_cloth() && !brushShown())
    found = handle_at(*frame_, camera_, as_vector(cursor_));
  const auto part = found ? found->part_at(camera_, as_vector(cursor_)) : ObstacleHandle::Part::none;
  const bool changed = found.has_value() != handle_.has_value() || part != handle_part_ ||
                       (found && (found->obstacle != handle_->obstacle || found->place != handle_->place));
  handle_ = found;
  handle_part_ = part;
  if (changed) repaintOver();
}

bool ClothView::startObstacleMove(QPointF at) {
  updateHandle();
  if (!handle_ || handle_part_ == ObstacleHandle::Part::none) return false;
  gesture_ = Gesture::obstacle;
  handle_start_ = as_vector(at);
  Q_EMIT obstacleMoveStarted(handle_->obstacle);
  return true;
}

void ClothView::sendObstacleMove() {
  Q_EMIT obstacleMoved(handle_->obstacle,
                       dragged_by(*handle_, handle_part_, camera_, handle_start_, as_vector(cursor_)));
}

/// The obstacle goes back to where it was.
void ClothView::cancelObstacleMove() {
  obstacle_move_kept_ = false;
  endGesture();
  obstacle_move_kept_ = true;
  updateHover();
}

/// During a drag the handle follows the cursor; the obstacle may lag behind.
void ClothView::paintHandle(QPainter& painter) {
  const bool moving = gesture_ == Gesture::obstacle;
  if (!handle_ || (!moving && (gesture_ != Gesture::none || brushShown()))) return;
  ObstacleHandle shown = *handle_;
  if (moving) shown.place += dragged_by(*handle_, handle_part_, camera_, handle_start_, as_vector(cursor_));
  const cloth::Obstacle& obstacle = frame_->obstacles[static_cast<std::size_t>(shown.obstacle)];
  if (has_motion(obstacle)) {
    QPolygonF keys;
    for (const cloth::Keyframe& key : obstacle.keyframes) keys << as_point(camera_.project(key.position));
    overlay_.motion(painter, size(), theme(), keys, as_point(camera_.project(shown.place)));
  }
  const auto tips = shown.tips(camera_);
  overlay_.handle(painter, theme(), as_point(camera_.project(shown.place)),
                  {as_point(camera_.project(tips[0])), as_point(camera_.project(tips[1])),
                   as_point(camera_.project(tips[2]))},
                  static_cast<int>(handle_part_) - 1);
}

/// In a small pane of many the name of the mode would cover the cloth.
bool ClothView::showsMode() const {
  constexpr int room_for_mode = 160;  // px
  return height() >= room_for_mode;
}

/// The number of contact marks.
void ClothView::paintContactNote(QPainter& painter) {
  if (!contact_.marks || !frame_->contact.has_marks) return;
  constexpr std::size_t floats_of_mark = 7;
  overlay_.contact_note(painter, theme(), static_cast<int>(frame_->contact.marks.size() / floats_of_mark),
                        showsMode());
}

}  // namespace clothlab

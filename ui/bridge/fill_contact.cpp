#include <algorithm>

#include "bridge/fill_frame.h"

namespace clothlab {
namespace {

constexpr int cloth_itself = -1;

void append(const cloth::Vec3& v, std::vector<float>& values) {
  for (const double component : v) values.push_back(static_cast<float>(component));
}

}  // namespace

void ContactFiller::fill(cloth::Simulation& simulation, const ContactChoice& choice, ClothFrame& frame) {
  ContactPicture& picture = frame.contact;
  picture.has_marks = choice.marks;
  picture.marks.clear();
  picture.boxes.clear();
  picture.groups.clear();
  picture.depth = 0;
  if (choice.marks) fill_marks(simulation, picture);
  const int obstacles = static_cast<int>(simulation.scene().obstacles.size());
  for (int body = cloth_itself; body < obstacles; ++body) {
    const int depth = simulation.hierarchy_depth(body);
    picture.depth = std::max(picture.depth, depth);
    if (choice.box_level >= 0 && depth > 0)
      fill_boxes(simulation, body, std::min(choice.box_level, depth), picture);
  }
}

void ContactFiller::fill_marks(const cloth::Simulation& simulation, ContactPicture& picture) {
  marks_.clear();
  simulation.append_contact_marks(marks_);
  double strongest = 0;
  for (const cloth::ContactMark& mark : marks_) strongest = std::max(strongest, mark.normal_impulse);
  for (const cloth::ContactMark& mark : marks_) {
    append(mark.point, picture.marks);
    append(mark.normal, picture.marks);
    picture.marks.push_back(strongest > 0 ? static_cast<float>(mark.normal_impulse / strongest) : 1.0F);
  }
}

void ContactFiller::fill_boxes(cloth::Simulation& simulation, int obstacle, int level,
                               ContactPicture& picture) {
  boxes_.clear();
  simulation.append_hierarchy_boxes(obstacle, level, boxes_);
  for (const cloth::Bounds& box : boxes_) {
    append(box.lower, picture.boxes);
    append(box.upper, picture.boxes);
  }
  picture.groups.push_back({obstacle, static_cast<int>(boxes_.size())});
}

}  // namespace clothlab

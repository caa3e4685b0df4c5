#include "main_window/cloth_file.h"

#include "cloth/cloth_obj.h"
#include "cloth/mesh_cloth.h"
#include "io/obj_writer.h"
#include "io/user_file.h"

namespace clothlab {
namespace {

std::vector<cloth::Triangle> triangles_of(const ClothFrame& frame) {
  if (frame.mesh) return frame.mesh->surface.triangles;
  cloth::ClothSystem grid;
  grid.rows = frame.rows;
  grid.columns = frame.columns;
  return cloth::triangles_of(grid);
}

}  // namespace

QString save_cloth_file(const ClothFrame& frame, const QString& title, const QString& path) {
  const std::vector<cloth::Triangle> triangles = triangles_of(frame);
  cloth::ObjSurface<float> surface;
  surface.positions = frame.positions;
  surface.normals = frame.normals;
  surface.texture = cloth::grid_texture<float>(frame.rows, frame.columns);
  surface.triangles = triangles;
  const std::string text = cloth::obj_text(surface, cloth::title_at(title.toStdString(), frame.time));
  const auto error = cloth::write_user_file(path.toStdString(), text);
  return error ? QString::fromStdString(error->text()) : QString();
}

}  // namespace clothlab

// The blocks of a scene: their texts and what the Add menu fills in, each declared once.
#include <fmt/format.h>

#include <algorithm>

#include "params/field_builders.h"
#include "scene/block_fields.h"
#include "scene/blocks.h"

namespace cloth {
namespace {

Fields<Recording> recording_fields() {
  using R = Recording;
  return {
      field(&R::interval, positive({.key = "interval",
                                    .label = "Record interval",
                                    .unit = "s",
                                    .doc = "Simulated time between two rows of a recording.",
                                    .cost = EditCost::restart,
                                    .scale = Scale::logarithmic,
                                    .slider_minimum = 1e-4})),
  };
}

Fields<MeasuredPoints> measured_fields() {
  using M = MeasuredPoints;
  return {
      field(&M::file,
            {.key = "file",
             .label = "File",
             .doc = "CSV file of measured points, as seen from the scene's folder: columns of x, y, z in "
                    "m, or value, or time in s and value."}),
      field(&M::output,
            {.key = "output",
             .label = "Output",
             .doc = "What was measured: top-row, middle-row, bottom-row, left-column, middle-column or "
                    "right-column of particles, or a quantity as grid convergence has it."}),
      field(&M::state, {.key = "state",
                        .label = "State",
                        .doc = "When it was measured: at rest, or in a run to the end of the duration.",
                        .choices = {"rest", "end"}}),
      field(&M::tolerance, positive({.key = "tolerance",
                                     .label = "Tolerance",
                                     .doc = "Largest relative error with which the scene agrees.",
                                     .scale = Scale::logarithmic,
                                     .slider_minimum = 1e-4})),
  };
}

Field<Scene> title_field() {
  return field(&Scene::title, {.key = "title", .label = "Title", .doc = "What the scene shows."});
}

Field<Scene> gravity_field() {
  return optional_field(&Scene::gravity, {.key = "gravity",
                                          .label = "Gravity",
                                          .unit = "m/s^2",
                                          .doc = "Acceleration of free fall.",
                                          .formula = "F = m g",
                                          .slider_minimum = -20,
                                          .slider_maximum = 20});
}

Field<Scene> duration_field() {
  return field(&Scene::duration, positive({.key = "duration",
                                           .label = "Duration",
                                           .unit = "s",
                                           .doc = "Simulated time of a run on the command line.",
                                           .scale = Scale::logarithmic,
                                           .slider_minimum = 0.1,
                                           .slider_maximum = 100}));
}

/// As thick as the default says, or as the cells allow.
SelfContact starter_self_contact(const Scene& scene) {
  const ClothSheet& cloth = scene.cloth;
  const double cell = std::min(cloth.width / (cloth.columns - 1), cloth.height / (cloth.rows - 1));
  SelfContact self_contact;
  self_contact.thickness = std::min(self_contact.thickness, 0.4 * cell);
  return self_contact;
}

template <class Value>
auto always(const Value& value) {
  return [value](const Scene&) { return value; };
}

Scene& whole(Scene& scene) {
  return scene;
}

/// Parameters that are the same for every scene.
void give_parameters(BlockRow& row, std::vector<Parameter> parameters) {
  row.parameters = always(std::move(parameters));
  row.is_present = always(true);
}

/// What is in the std::optional that `place_of` finds in a scene; null where that does not have what it
/// belongs to.
template <class PlaceOf, class Starter>
void make_optional(BlockRow& row, PlaceOf place_of, Starter starter) {
  row.is_present = [place_of](const Scene& scene) {
    const auto* place = place_of(const_cast<Scene&>(scene));
    return place && place->has_value();
  };
  const auto start = [place_of, starter](Scene& scene) {
    if (auto* place = place_of(scene)) *place = starter(scene);
  };
  const auto remove = [place_of](Scene& scene) {
    if (auto* place = place_of(scene)) place->reset();
  };
  const auto suits = [place_of](const Scene& scene) {
    return place_of(const_cast<Scene&>(scene)) != nullptr;
  };
  row.optional = OptionalBlock{start, start, remove, suits};
}

/// A block that is an object of the file, a struct of the scene.
template <class Owner, class PlaceOf, class Starter>
BlockRow object_row(BlockRow row, const Fields<Owner>& fields, PlaceOf place_of, Starter starter) {
  give_parameters(row, bound<Owner>(row.path, fields,
                                    [place_of](Scene& scene) -> Owner& { return place_of(scene)->value(); }));
  make_optional(row, place_of, starter);
  row.optional->add = [place_of](Scene& scene) {
    if (auto* place = place_of(scene)) place->emplace();
  };
  return row;
}

/// A block that is one value of the file.
template <class PlaceOf, class Value>
BlockRow value_row(BlockRow row, const Field<Scene>& field, PlaceOf place_of, const Value& starter) {
  give_parameters(row, bound<Scene>("", {field}, whole));
  make_optional(row, place_of, always(starter));
  return row;
}

BlockRow title_row() {
  BlockRow row{.path = "title", .file_place = 0};
  give_parameters(row, bound<Scene>("", {title_field()}, whole));
  return row;
}

BlockRow run_row() {
  BlockRow row{.path = "run",
               .file_place = 13,
               .title = "Run and record",
               .doc = "How long a run is and how often it is recorded."};
  std::vector<Parameter> parameters = bound<Scene>("", {duration_field()}, whole);
  for (Parameter& parameter :
       bound<Recording>("record", recording_fields(), [](Scene& s) -> Recording& { return s.record; }))
    parameters.push_back(std::move(parameter));
  give_parameters(row, std::move(parameters));
  return row;
}

/// Its method decides which parameters it has.
BlockRow integrator_row() {
  BlockRow row{.path = "integrator", .file_place = 12, .title = "Integrator", .doc = "How time advances."};
  row.parameters = [](const Scene& scene) {
    return bound<IntegratorChoice>("integrator", integrator_fields(scene.integrator.method),
                                   [](Scene& s) -> IntegratorChoice& { return s.integrator; });
  };
  row.is_present = always(true);
  return row;
}

BlockRow cloth_row() {
  BlockRow row{.path = "cloth",
               .file_place = 1,
               .title = "Cloth",
               .doc = "The sheet: how many particles, how large, how heavy.",
               .mesh_doc = "A mesh: its vertices are particles, its edges springs."};
  row.parameters = [](const Scene& scene) {
    std::vector<Parameter> parameters = cloth_parameters(scene.cloth.is_mesh());
    std::erase_if(parameters, [&](const Parameter& parameter) {
      if (scene.material) return parameter.path == "cloth.mass";
      return parameter.path == "cloth.cut" ||
             (scene.cloth.is_mesh() && (parameter.path == "cloth.across" || parameter.path == "cloth.down"));
    });
    return parameters;
  };
  row.is_present = always(true);
  return row;
}

/// A list: an obstacle's shape decides which parameters it has.
BlockRow obstacles_row() {
  BlockRow row{.path = "obstacles", .file_place = 8};
  row.parameters = always(std::vector<Parameter>{});
  row.is_present = [](const Scene& scene) { return !scene.obstacles.empty(); };
  return row;
}

/// A list: a probe's measure decides which parameters it has.
BlockRow probes_row() {
  BlockRow row{.path = "probes", .file_place = 14};
  row.parameters = always(std::vector<Parameter>{});
  row.is_present = [](const Scene& scene) { return !scene.probes.empty(); };
  return row;
}

BlockRow contact_row() {
  BlockRow row = object_row<ContactSettings>(
      {.path = "contact",
       .file_place = 10,
       .title = "Contact",
       .doc = "Contact without gaps: no vertex, edge or face comes through."},
      contact_fields(), [](Scene& s) { return &s.contact; }, always(ContactSettings{}));
  row.optional->suits = [](const Scene& scene) { return !scene.obstacles.empty(); };
  return row;
}

/// A place for what scenes of a material do not have.
template <class Value>
auto without_material(std::optional<Value> Scene::*member) {
  return [member](Scene& scene) { return scene.material ? nullptr : &(scene.*member); };
}

/// A material says in its own units what the air does to it.
BlockRow air_row() {
  BlockRow row = object_row<Air>(
      {.path = "air",
       .file_place = 6,
       .title = "Air and wind",
       .doc = "Air that drags and blows along the cloth's normals."},
      air_fields(), [](Scene& s) { return &s.air; },
      [](const Scene& scene) {
        return Air{.drag = scene.material ? 0 : 0.01, .wind = {0, 0, 3}, .gust = std::nullopt};
      });
  row.parameters = [all = row.parameters](const Scene& scene) {
    std::vector<Parameter> parameters = all(scene);
    if (scene.material)
      std::erase_if(parameters, [](const Parameter& parameter) { return parameter.path != "air.wind"; });
    return parameters;
  };
  return row;
}

/// Round cloth without a material there is not: what loses its material is a whole grid again.
BlockRow material_row() {
  BlockRow row = object_row<Material>(
      {.path = "material",
       .file_place = 3,
       .title = "Material",
       .doc = "What the cloth is made of, in units that do not depend on the grid; in place of springs."},
      material_fields(), [](Scene& s) { return s.springs || s.damping ? nullptr : &s.material; },
      always(starter_material()));
  row.optional->remove = [](Scene& scene) {
    scene.material.reset();
    scene.cloth.cut = ClothSheet{}.cut;
  };
  return row;
}

std::vector<BlockRow> force_rows() {
  return {
      object_row<SpringMaterial>(
          {.path = "springs", .file_place = 2, .title = "Springs", .doc = "What holds the cloth together."},
          spring_fields(), without_material(&Scene::springs),
          always(SpringMaterial{.structural = 500, .shear = 250, .flexion = 50, .damping = 0})),
      material_row(),
      object_row<Deformation>(
          {.path = "deformation",
           .file_place = 8,
           .title = "Deformation rate",
           .doc = "Provot's limit on how far springs may stretch."},
          deformation_fields(), [](Scene& s) { return &s.deformation; }, always(Deformation{})),
      value_row({.path = "damping",
                 .file_place = 4,
                 .title = "Viscous damping",
                 .doc = "Resistance to every motion."},
                damping_field(), without_material(&Scene::damping), 0.001),
      value_row(
          {.path = "gravity", .file_place = 5, .title = "Gravity", .doc = "The weight of the cloth."},
          gravity_field(), [](Scene& s) { return &s.gravity; }, Vec3(0, -9.81, 0)),
      air_row(),
      object_row<Gust>(
          {.path = "air.gust", .file_place = 7, .title = "Gusts", .doc = "A wind whose speed swings."},
          gust_fields(), [](Scene& s) { return s.air ? &s.air->gust : nullptr; }, always(Gust{})),
  };
}

std::vector<BlockRow> all_rows() {
  std::vector<BlockRow> rows{integrator_row()};
  for (BlockRow& row : force_rows()) rows.push_back(std::move(row));
  rows.push_back(obstacles_row());
  rows.push_back(contact_row());
  rows.push_back(object_row<SelfContact>(
      {.path = "self_contact",
       .file_place = 11,
       .title = "Self-contact",
       .doc = "The cloth does not pass through itself."},
      self_contact_fields(), [](Scene& s) { return &s.self_contact; }, starter_self_contact));
  rows.push_back(probes_row());
  rows.push_back(object_row<MeasuredPoints>(
      {.path = "measured",
       .file_place = 15,
       .title = "Measured points",
       .doc = "What such a cloth did in a laboratory, for clothlab-cli validate; a run does not know of it."},
      measured_fields(), [](Scene& s) { return &s.measured; }, always(MeasuredPoints{.file = "points.csv"})));
  rows.push_back(cloth_row());
  rows.push_back(run_row());
  rows.push_back(title_row());
  return rows;
}

}  // namespace

const std::vector<BlockRow>& block_rows() {
  static const std::vector<BlockRow> rows = all_rows();
  return rows;
}

const std::vector<const BlockRow*>& block_rows_of_file() {
  static const auto in_order = [] {
    std::vector<const BlockRow*> rows;
    for (const BlockRow& row : block_rows()) rows.push_back(&row);
    std::sort(rows.begin(), rows.end(),
              [](const BlockRow* a, const BlockRow* b) { return a->file_place < b->file_place; });
    return rows;
  }();
  return in_order;
}

std::optional<StageInfo> absent_stage(const std::string& stage, const Scene& scene,
                                      const std::string& block) {
  const auto& rows = block_rows();
  const auto row = std::find_if(rows.begin(), rows.end(), [&](const BlockRow& r) { return r.path == block; });
  if (row->is_present(scene)) return std::nullopt;
  return StageInfo{stage, false, fmt::format("the scene has no \"{}\"", block)};
}

std::string parent_path(const std::string& path) {
  const std::size_t dot = path.rfind('.');
  return dot == std::string::npos ? "" : path.substr(0, dot);
}

}  // namespace cloth

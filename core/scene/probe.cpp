#include "scene/probe.h"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <cstdlib>
#include <numbers>

#include "cloth/cut_grid.h"
#include "params/field_builders.h"
#include "scene/scene.h"

namespace cloth {
namespace {

constexpr std::size_t most_of_line = 1000, longest_probe_name = 32;

std::vector<ProbeFacts> facts_of_particle_probes() {
  return {
      {ProbeMeasure::particle,
       "particle",
       "Particle",
       "Where a particle is and how fast.",
       1,
       1,
       {{"x_m", "x", "m", "position"},
        {"y_m", "y", "m", "position"},
        {"z_m", "z", "m", "position"},
        {"speed_m_s", "speed", "m/s", "length of its velocity"},
        {"sag_m", "sag", "m", "depth below the mean height of all pins; empty where nothing is pinned"}}},
      {ProbeMeasure::distance,
       "distance",
       "Distance",
       "How far two particles are apart.",
       2,
       2,
       {{"distance_m", "distance", "m", "straight from one to the other"},
        {"strain", "strain", "", "distance over that at the start, less one"}}},
      {ProbeMeasure::angle,
       "angle",
       "Angle",
       "How a cloth is bent at the second of three particles.",
       3,
       3,
       {{"angle_rad", "angle", "rad",
         "between the ways from the second to the others: pi where it is straight"},
        {"curvature_1_m", "curvature", "1/m",
         "one over the radius of the circle through the three (Menger 1930)"}}},
      {ProbeMeasure::line,
       "line",
       "Line",
       "A row, a column or a diagonal of a grid from one particle to another; of a mesh a chain of vertices.",
       2,
       most_of_line,
       {{"length_m", "length", "m", "along its particles"},
        {"strain", "strain", "", "length over that at the start, less one"},
        {"sag_m", "sag", "m",
         "largest depth of its particles below the straight line between its ends; empty where one end is "
         "straight above the other"},
        {"curvature_1_m", "curvature", "1/m",
         "largest of the circles through three particles in succession; empty where there are but two"},
        {"folds", "folds", "",
         "waves to the sides of the vertical plane through its ends, of more than two hundredths of the "
         "length at the start; empty where one end is straight above the other"}}},
  };
}

std::vector<ProbeFacts> facts_of_shape_probes() {
  return {
      {ProbeMeasure::lowest_point,
       "lowest-point",
       "Lowest point",
       "The height of the lowest particle.",
       0,
       0,
       {{"height_m", "height", "m", "against gravity, y where there is none"}}},
      {ProbeMeasure::extent,
       "extent",
       "Extent",
       "The sides of the smallest box along the axes that holds the cloth.",
       0,
       0,
       {{"x_m", "x", "m", "side along x"},
        {"y_m", "y", "m", "side along y"},
        {"z_m", "z", "m", "side along z"}}},
      {ProbeMeasure::shadow,
       "shadow",
       "Shadow",
       "The area of the cloth as seen along gravity.",
       0,
       0,
       {{"area_m2", "area", "m^2", "of all that lies below or above a level plane"}}},
      {ProbeMeasure::drape,
       "drape",
       "Drape",
       "Cusick's test (1968): the shadow of the cloth with a level disc under the middle of its start.",
       0,
       0,
       {{"coefficient", "coefficient", "",
         "shadow beyond the disc over the flat cloth beyond it: 1 where it stays flat, 0 where it hangs"},
        {"folds", "folds", "", "peaks of the shadow's outline beside that of the start"}}},
      {ProbeMeasure::droop,
       "droop",
       "Droop",
       "How far the lowest particle hangs from the pin that is nearest to it in the level plane.",
       0,
       0,
       {{"drop_m", "drop", "m", "H, downwards; empty where nothing is pinned"},
        {"reach_m", "reach", "m", "W, in the level plane; empty where nothing is pinned"},
        {"ratio", "ratio", "",
         "H/W, 0 where nothing is below the pins; empty where nothing is pinned or W is 0"}}},
      {ProbeMeasure::rest,
       "rest",
       "Rest",
       "Whether the kinetic energy is below a bound: the first time of that is the time to rest.",
       0,
       0,
       {{"at_rest", "at rest", "", "1 below the bound, 0 at it and above"}}},
  };
}

/// Finds particles by their places.
class PlaceFinder {
 public:
  explicit PlaceFinder(const ClothSheet& cloth) : cloth_(cloth) {
    if (cloth.is_cut()) cut_ = cut_grid(cloth);
  }

  /// nullopt: no particle is there.
  std::optional<int> find(const ParticlePlace& at) const {
    if (at.row < 0 || at.column < 0 || at.row >= cloth_.rows || at.column >= cloth_.columns)
      return std::nullopt;
    if (!cut_) return at.row * cloth_.columns + at.column;
    const int particle = cut_->at(at.row, at.column);
    return particle < 0 ? std::nullopt : std::optional(particle);
  }

  std::string rule() const {
    if (cloth_.is_mesh()) return fmt::format("must be a vertex of the mesh: 0 to {}", cloth_.columns - 1);
    const char* cut = cut_ ? ", where the cloth is not cut away" : "";
    return fmt::format("must lie in the grid: row 0 to {}, column 0 to {}{}", cloth_.rows - 1,
                       cloth_.columns - 1, cut);
  }

  std::string text(const ParticlePlace& at) const {
    return cloth_.is_mesh() ? std::to_string(at.column) : fmt::format("[{}, {}]", at.row, at.column);
  }

 private:
  const ClothSheet& cloth_;
  std::optional<CutGrid> cut_;
};

bool is_straight(const ParticlePlace& from, const ParticlePlace& to) {
  const int down = std::abs(to.row - from.row), across = std::abs(to.column - from.column);
  return down == 0 || across == 0 || down == across;
}

int sign_of(int number) {
  return (number > 0) - (number < 0);
}

/// Every place from one end to the other of a straight line.
std::vector<ParticlePlace> places_between(const ParticlePlace& from, const ParticlePlace& to) {
  const int steps = std::max(std::abs(to.row - from.row), std::abs(to.column - from.column));
  std::vector<ParticlePlace> places;
  for (int k = 0; k <= steps; ++k)
    places.push_back(
        {from.row + k * sign_of(to.row - from.row), from.column + k * sign_of(to.column - from.column)});
  return places;
}

bool is_grid_line(const ClothSheet& cloth, const Probe& probe) {
  return probe.measure == ProbeMeasure::line && !cloth.is_mesh();
}

/// "must be two particles"; empty where there are as many as the measure wants.
std::string broken_count_rule(const ClothSheet& cloth, const Probe& probe) {
  static const char* const words[] = {"no", "one", "two", "three"};
  const ProbeFacts& facts = facts_of(probe.measure);
  const std::size_t count = probe.particles.size();
  if (is_grid_line(cloth, probe))
    return count == 2 ? "" : "must be two particles: the ends of a row, a column or a diagonal of the grid";
  if (count >= facts.least_particles && count <= facts.most_particles) return "";
  if (facts.least_particles == facts.most_particles)
    return fmt::format("must be {} particle{}", words[facts.most_particles],
                       facts.most_particles == 1 ? "" : "s");
  return fmt::format("must be {} to {} particles", facts.least_particles, facts.most_particles);
}

void check_particles(const ClothSheet& cloth, const PlaceFinder& finder, const Probe& probe,
                     const std::string& path, std::vector<Problem>& problems) {
  const std::size_t before = problems.size();
  if (const std::string rule = broken_count_rule(cloth, probe); !rule.empty())
    return problems.push_back({path, fmt::format("{} given", probe.particles.size()), rule});
  for (std::size_t k = 0; k < probe.particles.size(); ++k) {
    const ParticlePlace& at = probe.particles[k];
    const auto same = std::find(probe.particles.begin(), probe.particles.end(), at) - probe.particles.begin();
    if (!finder.find(at))
      problems.push_back({fmt::format("{}.{}", path, k), finder.text(at), finder.rule()});
    else if (same < static_cast<std::ptrdiff_t>(k))
      problems.push_back({fmt::format("{}.{}", path, k), finder.text(at),
                          fmt::format("must be another particle than {}.{}", path, same)});
  }
  if (!is_grid_line(cloth, probe) || problems.size() > before) return;
  if (!is_straight(probe.particles[0], probe.particles[1]))
    return problems.push_back(
        {path + ".1", finder.text(probe.particles[1]),
         fmt::format("must lie in one row, column or diagonal with {}", finder.text(probe.particles[0]))});
  for (const ParticlePlace& at : places_between(probe.particles[0], probe.particles[1]))
    if (!finder.find(at))
      return problems.push_back({path, finder.text(at), "lies on the line where the cloth is cut away"});
}

bool is_probe_name(const std::string& name) {
  const auto is_letter = [](char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z'); };
  return !name.empty() && name.size() <= longest_probe_name && is_letter(name[0]) &&
         std::all_of(name.begin(), name.end(),
                     [&](char c) { return is_letter(c) || (c >= '0' && c <= '9') || c == '-' || c == '_'; });
}

void check_name(const std::vector<Probe>& probes, std::size_t k, std::vector<Problem>& problems) {
  const std::string path = fmt::format("probes.{}.name", k);
  if (!is_probe_name(probes[k].name))
    return problems.push_back({path, '"' + probes[k].name + '"',
                               fmt::format("must be a letter and up to {} letters, digits, - and _: it is "
                                           "part of a column's name",
                                           longest_probe_name - 1)});
  for (std::size_t other = 0; other < k; ++other)
    if (probes[other].name == probes[k].name)
      return problems.push_back({path, '"' + probes[k].name + '"',
                                 fmt::format("must be another name than that of probes.{}", other)});
}

/// m^2, of the flat cloth; infinite where its mesh is not there to ask.
double flat_area_of(const ClothSheet& cloth) {
  if (!cloth.is_mesh()) {
    const double whole =
        (cloth.width * cloth.across.normalized()).cross(cloth.height * cloth.down.normalized()).norm();
    return cloth.is_cut() ? std::numbers::pi / 4 * whole : whole;
  }
  if (!cloth.mesh.is_loaded()) return infinity;
  const TriangleMesh& mesh = cloth.mesh.loaded->surface;
  double area = 0;
  for (const auto& [a, b, c] : mesh.triangles) {
    const Vec3& corner = mesh.vertices[static_cast<std::size_t>(a)];
    area += 0.5 * (mesh.vertices[static_cast<std::size_t>(b)] - corner)
                      .cross(mesh.vertices[static_cast<std::size_t>(c)] - corner)
                      .norm();
  }
  return area;
}

void check_disc(const ClothSheet& cloth, const Probe& probe, const std::string& path,
                std::vector<Problem>& problems) {
  const double largest = std::sqrt(flat_area_of(cloth) / std::numbers::pi);
  if (probe.measure == ProbeMeasure::drape && probe.radius >= largest)
    problems.push_back({path + ".radius", fmt::format("{} m", probe.radius),
                        fmt::format("must be less than {:.4g} m: a disc as large as the cloth leaves nothing "
                                    "that could hang",
                                    largest)});
}

}  // namespace

const std::vector<ProbeFacts>& probe_facts() {
  static const std::vector<ProbeFacts> all = [] {
    std::vector<ProbeFacts> facts = facts_of_particle_probes();
    for (ProbeFacts& one : facts_of_shape_probes()) facts.push_back(std::move(one));
    return facts;
  }();
  return all;
}

const ProbeFacts& facts_of(ProbeMeasure measure) {
  const ProbeFacts& facts = probe_facts()[static_cast<std::size_t>(measure)];
  assert(facts.measure == measure);
  return facts;
}

const Fields<Probe>& probe_fields(ProbeMeasure measure) {
  static const auto name = field(
      &Probe::name,
      {.key = "name", .label = "Name", .doc = "What columns and curves call the probe: probe.NAME.x_m."});
  static const Fields<Probe> plain{name};
  static const Fields<Probe> drape{
      name, field(&Probe::radius, positive({.key = "radius",
                                            .label = "Radius of the disc",
                                            .unit = "m",
                                            .doc = "Of the disc under the cloth; Cusick's is 0.09 m.",
                                            .scale = Scale::logarithmic,
                                            .slider_minimum = 0.01}))};
  static const Fields<Probe> rest{
      name, field(&Probe::bound, positive({.key = "bound",
                                           .label = "Bound",
                                           .unit = "J",
                                           .doc = "Kinetic energy below which the cloth counts as at rest.",
                                           .scale = Scale::logarithmic,
                                           .slider_minimum = 1e-12}))};
  return measure == ProbeMeasure::drape ? drape : measure == ProbeMeasure::rest ? rest : plain;
}

std::string probe_column(const Probe& probe, const ProbeValue& value) {
  return fmt::format("probe.{}.{}", probe.name, value.key);
}

std::vector<std::string> probe_columns(const std::vector<Probe>& probes) {
  std::vector<std::string> columns;
  for (const Probe& probe : probes)
    for (const ProbeValue& value : facts_of(probe.measure).values)
      columns.push_back(probe_column(probe, value));
  return columns;
}

std::optional<ProbeColumnWords> words_of_probe_column(const std::string& column) {
  const std::string prefix = "probe.";
  const std::size_t dot = column.rfind('.');
  if (column.rfind(prefix, 0) != 0 || dot < prefix.size()) return std::nullopt;
  const std::string key = column.substr(dot + 1);
  for (const ProbeFacts& facts : probe_facts())
    for (const ProbeValue& value : facts.values)
      if (key == value.key)
        return ProbeColumnWords{
            fmt::format("{}: {}", column.substr(prefix.size(), dot - prefix.size()), value.label),
            value.unit};
  return std::nullopt;
}

std::vector<int> probed_particles(const ClothSheet& cloth, const Probe& probe) {
  const PlaceFinder finder(cloth);
  std::vector<int> particles;
  for (const ParticlePlace& at :
       is_grid_line(cloth, probe) ? places_between(probe.particles[0], probe.particles[1]) : probe.particles)
    particles.push_back(finder.find(at).value());
  return particles;
}

ParticlePlace place_of(const ClothSheet& cloth, int particle) {
  const int place = cloth.is_cut() ? cut_grid(cloth).place.at(static_cast<std::size_t>(particle)) : particle;
  return {place / cloth.columns, place % cloth.columns};
}

ParticlePlace straight_end(const ClothSheet& cloth, const ParticlePlace& from, const ParticlePlace& to) {
  const PlaceFinder finder(cloth);
  const int down = to.row - from.row, across = to.column - from.column;
  const auto square_distance = [&](const ParticlePlace& at) {
    return (at.row - to.row) * (at.row - to.row) + (at.column - to.column) * (at.column - to.column);
  };
  ParticlePlace best = from;
  for (const auto& [step_down, step_across] :
       {std::pair{0, sign_of(across)}, {sign_of(down), 0}, {sign_of(down), sign_of(across)}}) {
    if (step_down == 0 && step_across == 0) continue;
    ParticlePlace at = from;
    while (finder.find({at.row + step_down, at.column + step_across}) &&
           square_distance({at.row + step_down, at.column + step_across}) < square_distance(at))
      at = {at.row + step_down, at.column + step_across};
    if (square_distance(at) < square_distance(best)) best = at;
  }
  return best;
}

std::string free_probe_name(const std::vector<Probe>& probes, ProbeMeasure measure) {
  for (int number = 1;; ++number) {
    const std::string name = fmt::format("{}-{}", facts_of(measure).name, number);
    if (std::none_of(probes.begin(), probes.end(), [&](const Probe& one) { return one.name == name; }))
      return name;
  }
}

std::vector<Problem> find_probe_problems(const Scene& scene) {
  std::vector<Problem> problems;
  if (scene.probes.empty() || (scene.cloth.is_mesh() && !scene.cloth.mesh.is_loaded())) return problems;
  const PlaceFinder finder(scene.cloth);
  for (std::size_t k = 0; k < scene.probes.size(); ++k) {
    const std::string path = fmt::format("probes.{}", k);
    check_name(scene.probes, k, problems);
    check_particles(scene.cloth, finder, scene.probes[k], path + ".particles", problems);
    check_disc(scene.cloth, scene.probes[k], path, problems);
  }
  return problems;
}

std::vector<Probe> probes_inside(const ClothSheet& cloth, const std::vector<Probe>& probes) {
  std::vector<Probe> inside;
  if (probes.empty()) return inside;
  const PlaceFinder finder(cloth);
  for (const Probe& probe : probes) {
    std::vector<Problem> problems;
    check_particles(cloth, finder, probe, "", problems);
    check_disc(cloth, probe, "", problems);
    if (problems.empty()) inside.push_back(probe);
  }
  return inside;
}

std::vector<std::string> probe_notices(const Scene& scene) {
  std::vector<std::string> notices;
  if (scene.probes.empty() || !pinned_particles(scene.cloth).empty()) return notices;
  for (const Probe& probe : scene.probes)
    if (probe.measure == ProbeMeasure::droop)
      notices.push_back(
          fmt::format("probe {}: nothing is pinned, so that there is no droop to measure", probe.name));
  return notices;
}

}  // namespace cloth

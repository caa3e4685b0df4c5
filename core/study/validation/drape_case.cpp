#include "study/validation/drape_case.h"

#include "cloth/mesh_cloth.h"
#include "geometry/split_mix.h"
#include "scene/scene_cloth.h"
#include "study/validation/strip.h"

namespace cloth {

Scene drape_scene(const Material& material, int cells) {
  Scene scene;
  ClothSheet& cloth = scene.cloth;
  cloth.columns = cloth.rows = cells + 1;
  cloth.width = cloth.height = 2 * specimen_radius;
  cloth.origin = {-specimen_radius, 0, -specimen_radius};
  cloth.across = {1, 0, 0}, cloth.down = {0, 0, 1};
  cloth.cut = "round";
  cloth.pins = {PinnedDisc{drape_disc_radius}};
  scene.gravity = Vec3(0, -standard_gravity, 0);
  scene.material = material;
  return scene;
}

DrapeReading measure_drape_of(const Material& material, int cells, std::uint64_t seed, const StopTest& stop) {
  const Scene scene = drape_scene(material, cells);
  const ClothSystem system = make_cloth(scene);
  constexpr double most = 0.002;  // m
  Vec3Field position = system.start;
  SplitMix random(seed);
  for (std::size_t i = 0; i < position.size(); ++i) {
    const double height = most * random.number();
    if (!system.pinned[i]) position.add(i, {0, height, 0});
  }
  DrapeReading reading;
  const int load_steps = system.sliders.empty() ? 1 : 20;
  reading.rest = find_rest(scene, system, position,
                           {.tolerance = 1e-7, .iterations = 2000, .load_steps = load_steps, .stop = stop});
  if (is_to_stop(stop)) return reading;
  // Friction also holds what its bending alone would not: with hysteresis such a rest is not asked for.
  reading.is_minimum = !system.sliders.empty() || is_minimum(scene, system, reading.rest.position);
  reading.failure = reading.rest.failure;
  if (reading.failure.empty() && !reading.is_minimum)
    reading.failure = "what was found balances, but is no minimum of the energy";
  reading.drape =
      measure_drape(triangles_of(system), system.start, reading.rest.position, {.radius = drape_disc_radius});
  reading.locking = measure_oblique_locking(scene, system, reading.rest.position);
  return reading;
}

}  // namespace cloth

// Extreme cases made of any scene: each pushes it in one thing.
#include <fmt/format.h>

#include <algorithm>

#include "scene/scene_checks.h"
#include "scene/scene_cloth.h"
#include "simulation/recorder.h"
#include "simulation/time_step.h"
#include "study/extremes.h"

namespace cloth {
namespace {

constexpr std::int64_t max_steps = 300;
constexpr double fallback_step = 1.0 / 60;  // s

class CaseMaker {
 public:
  explicit CaseMaker(const Scene& scene) : scene_(scene) {
    const double step = resolved_time_step(scene).value_or(fallback_step);
    scene_.integrator.time_step = step;  // one step for all methods: what differs is the method
    max_steps_ = std::clamp<std::int64_t>(steps_to_cover(scene.duration / 2, step), 1, max_steps);
    scene_.duration = std::min(1e9, 1e9 * step);  // the bound is on steps
  }

  /// `edit` pushes the scene. Left out where that breaks a rule of the scene.
  template <class Edit>
  void add(const std::string& name, const std::string& what, Edit edit) {
    ExtremeCase extreme{name, what,
                        "The scene itself is the first case: what differs from it is due to this.", scene_,
                        max_steps_};
    edit(extreme.scene);
    if (find_problems(extreme.scene).empty()) cases_.push_back(std::move(extreme));
  }

  std::vector<ExtremeCase> take() { return std::move(cases_); }
  double step() const { return *scene_.integrator.time_step; }

 private:
  Scene scene_;
  std::int64_t max_steps_ = 0;
  std::vector<ExtremeCase> cases_;
};

void add_stiffnesses(CaseMaker& make) {
  for (const double factor : {0.01, 10.0, 100.0, 1e4, 1e6})
    make.add(fmt::format("stiffness-x{:g}", factor),
             fmt::format("{:g} times as stiff in everything.", factor),
             [factor](Scene& scene) { scale_stiffness(scene, factor); });
}

void add_damping(CaseMaker& make) {
  make.add("no-damping", "Without damping of motions, springs and bending.", [](Scene& scene) {
    scene.damping.reset();
    if (scene.springs) scene.springs->damping = 0;
    if (Material* material = scene.material ? &*scene.material : nullptr)
      material->stretch_damping = material->bending_damping = material->mass_damping = 0;
  });
  make.add("enormous-damping", "Viscous damping of 1e4 N s/m on every particle: nothing should move.",
           [](Scene& scene) {
             if (scene.material)
               scene.material->mass_damping = 1e4 / particle_mass(scene);
             else
               scene.damping = 1e4;
           });
}

void add_rates(CaseMaker& make) {
  for (const double rate : {0.0, 0.001, 0.1})
    make.add(fmt::format("rate-{:g}-percent", 100 * rate),
             fmt::format("Structural and shear springs may stretch by {:g} %.", 100 * rate),
             [rate](Scene& scene) {
               if (!scene.deformation) scene.deformation = Deformation{};
               scene.deformation->rate = rate;
             });
}

}  // namespace

std::vector<ExtremeCase> extreme_cases_of(const Scene& scene) {
  CaseMaker make(scene);
  make.add("as-it-is", fmt::format("The scene itself at steps of {:.4g} s, with every method.", make.step()),
           [](Scene&) {});
  for (const double factor : {0.1, 2.0, 5.0, 20.0, 100.0})
    make.add(fmt::format("step-x{:g}", factor), fmt::format("Steps of {:.4g} s.", factor * make.step()),
             [factor](Scene& pushed) { *pushed.integrator.time_step *= factor; });
  if (has_stiffness(scene)) add_stiffnesses(make);
  for (const double factor : {0.001, 1000.0})
    make.add(fmt::format("mass-x{:g}", factor), fmt::format("The cloth {:g} times as heavy.", factor),
             [factor](Scene& pushed) { scale_mass(pushed, factor); });
  add_damping(make);
  make.add("hurricane", "A wind of 60 m/s along x and z.", [](Scene& pushed) {
    if (!pushed.air) pushed.air = Air{};
    pushed.air->wind = Vec3(60, 0, 60);
  });
  if (has_stiffness(scene)) add_rates(make);
  return make.take();
}

}  // namespace cloth

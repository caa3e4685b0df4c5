// XPBD beyond what local_methods_test.cpp asks of it: a material's elements.
#include <gtest/gtest.h>

#include <string>

#include "integrators/registry.h"
#include "support/direct_run.h"
#include "support/material_meshes.h"
#include "support/materials.h"
#include "support/random.h"
#include "support/states.h"

namespace cloth::test::xpbd_test {
namespace {

TEST(Xpbd, SolvesTheStepEquationsOfAMaterialByTheKernelsAndOneByOne) {
  Random random;
  IntegratorChoice choice{"xpbd"};
  choice.substeps = 1, choice.xpbd_iterations = 1000;
  const Material lagging = material_with_hysteresis();
  Scene mesh = material_mesh_sheet(9, 7, 0.3, 0.2, 0.15, lagging, random), grid = complete_material_scene();
  mesh.cloth.pins = {PinnedParticle{0, 0}};
  grid.material = lagging;
  for (Scene scene : {mesh, grid})
    for (const double friction : {0.0, 1e-9}) {  // with more friction than drag: one by one
      scene.air = Air{.gust = std::nullopt};
      scene.material->drag_normal = 0, scene.material->drag_tangential = friction;
      DirectRun run(scene, choice);
      EXPECT_FALSE(run.system.sliders.empty());
      run.state = crumpled_state(run.system, 1e-3, 0.2, random);
      EXPECT_LE(left_of_the_step_equations(run, 2e-3), 1e-11) << friction;
      const std::string visits = run.integrator().visits_text(run.forces);
      EXPECT_EQ(visits.find("one by one") != std::string::npos, friction > 0) << visits;
    }
}

}  // namespace
}  // namespace cloth::test::xpbd_test

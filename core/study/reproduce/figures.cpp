// Figures 1 to 3: the springs, the deformation rate, the wind.
#include <fmt/format.h>

#include "cloth/grid.h"
#include "measure/strain.h"
#include "scene/builtin_scenes.h"
#include "study/reproduce/study_page.h"

namespace cloth {
namespace {

constexpr double strain_scale = 0.2;

/// The largest strain of each family over the springs that end on a pin.
std::array<double, 3> strain_at_pins(const ClothSystem& system, const Vec3Field& position) {
  std::array<double, 3> largest{};
  for (const SpringRun& run : system.springs)
    for (int s = 0; s < run.count; ++s) {
      const auto i = static_cast<std::size_t>(run.first + s);
      const auto j = i + static_cast<std::size_t>(run.offset);
      if (!system.pinned[i] && !system.pinned[j]) continue;
      double& strain = largest[static_cast<std::size_t>(run.family)];
      strain = std::max(strain, (position[j] - position[i]).norm() / run.rest_length - 1);
    }
  return largest;
}

struct HungCloth {
  const char* scene;
  const char* text;
};
constexpr std::array<HungCloth, 3> hung_cloths{{{"corners-free", "a) no limit"},
                                                {"corners-structural", "b) structural limited"},
                                                {"corners-shear", "c) structural and shear limited"}}};

struct LimiterWork {
  double sweeps = 0, iterations = 0;  ///< per step
  double excess = 0;                  ///< largest that was left
};

/// As advance(), adding up what the limiter does.
bool run_limited(Simulation& simulation, StudyPage& study, double from, double to, LimiterWork& work) {
  const double duration = simulation.scene().duration;
  while (simulation.time() < duration - 0.5 * simulation.time_step()) {
    if (simulation.step()) return false;
    work.iterations += simulation.last_limit().direct_iterations;
    work.excess = std::max(work.excess, simulation.last_limit().excess);
    if (!study.go_on(from + (to - from) * simulation.time() / duration)) return false;
  }
  const auto steps = static_cast<double>(simulation.count().steps);
  work.iterations /= steps;
  work.sweeps = static_cast<double>(simulation.count().limiter_sweeps) / steps;
  return true;
}

std::string percent(double strain) {
  return fmt::format("{:.2f} %", 100 * strain);
}

HtmlRow strain_row(const HungCloth& cloth, const Simulation& simulation, const LimiterWork& work,
                   StudyPage& study) {
  const Vec3Field& position = simulation.state().position;
  const auto corner = strain_at_pins(simulation.system(), position);
  const Strain strain = measure_strain(simulation.system(), position);
  const std::string name = cloth.scene;
  study.number(name + ": structural springs at the corners, largest strain", corner[0]);
  study.number(name + ": shear springs at the corners, largest strain", corner[1]);
  study.number(name + ": structural springs, largest strain", strain.largest[0]);
  study.number(name + ": shear springs, largest strain", strain.largest[1]);
  study.number(name + ": flexion springs, largest strain", strain.largest[2]);
  study.number(name + ": limiter sweeps per step", work.sweeps);
  return {{cloth.text, percent(corner[0]), percent(corner[1]), percent(strain.largest[0]),
           percent(strain.largest[1]), percent(strain.largest[2]), fmt::format("{:.2f}", work.sweeps),
           fmt::format("{:.3f}", work.iterations)}};
}

Image panel(const Scene& scene, const ClothSystem& system, const Vec3Field& position,
            const PictureCamera& camera, PictureOptions options) {
  options.width = panel_width;
  options.height = panel_height;
  return cloth_image(scene, system, position, camera, options);
}

Vec3Field joined(const std::vector<Vec3Field>& fields) {
  Vec3Field all(fields.size() * fields.front().size());
  for (std::size_t k = 0; k < fields.size(); ++k)
    for (std::size_t i = 0; i < fields[k].size(); ++i) all.set(k * fields[k].size() + i, fields[k][i]);
  return all;
}

}  // namespace

void reproduce_springs(StudyPage& study) {
  study.page().heading("The report's Fig. 1: the springs");
  Scene scene = builtin_scene("corners-free");
  scene.cloth.rows = scene.cloth.columns = 5;
  scene.cloth.down = {0, -1, 0};
  const ClothSystem system = make_grid(scene.cloth, *scene.springs);
  PictureCamera camera = camera_showing(scene, system.start, Vec3(0, 0, 1), panel_aspect);
  camera.eye += 0.2 * (camera.eye - camera.target);  // room for the arcs
  std::vector<Image> panels;
  for (int k = 0; k < 4; ++k) {
    PictureOptions options{.wireframe = true, .ground = false, .shadow = false};
    if (k < 3) options.springs_shown = {k == 0, k == 1, k == 2};
    panels.push_back(panel(scene, system, system.start, camera, options));
  }
  for (const SpringFamily family : spring_families)
    study.number(fmt::format("{} springs of a 5 x 5 grid", name_of(family)),
                 static_cast<double>(system.spring_count(family)), "",
                 family == SpringFamily::structural ? 40
                 : family == SpringFamily::shear    ? 32
                                                    : 30);
  study.picture(
      "fig1-springs", beside(panels), "A 5 x 5 grid of particles four times: each family of springs, and all",
      "From left to right: structural springs between neighbours, shear springs along the diagonals, flexion "
      "springs between particles two apart (as arcs), and all of them: 40, 32 and 30 springs.");
}

void reproduce_deformation(StudyPage& study) {
  HtmlPage& page = study.page();
  page.heading("The report's Fig. 2: the deformation rate");
  page.paragraph(
      "A cloth of 33 x 33 particles hung by two corners, 2 s after it was let go. The report's claim: "
      "without "
      "a limit the springs at the corners are far too long; limiting the structural springs moves the "
      "stretch "
      "to the shear springs; limiting both leaves no spring more than 10 % too long.");
  std::vector<Image> plain, coloured;
  HtmlTable table =
      number_table("Strain at the end. Corner: springs that end on a pin. Sweeps and iterations per step",
                   {"scene", "corner, structural", "corner, shear", "all structural", "all shear",
                    "all flexion", "sweeps", "direct iterations"});
  std::string commands;
  for (std::size_t k = 0; k < hung_cloths.size(); ++k) {
    const SceneRun run = scene_run(hung_cloths[k].scene);
    commands += (k > 0 ? " && " : "") + run.command;
    Simulation simulation(run.scene);
    LimiterWork work;
    const double part = static_cast<double>(k) / 3;
    if (!run_limited(simulation, study, part, part + 0.3, work)) return;
    table.rows.push_back(strain_row(hung_cloths[k], simulation, work, study));
    const Vec3Field& position = simulation.state().position;
    const PictureCamera camera = camera_showing(run.scene, position, Vec3(0.3, 0.25, 1), panel_aspect);
    plain.push_back(panel(run.scene, simulation.system(), position, camera, {}));
    coloured.push_back(panel(run.scene, simulation.system(), position, camera,
                             {.colouring = ClothColouring::strain, .strain_scale = strain_scale}));
  }
  study.picture(
      "fig2-plain", beside(plain), "The cloth hung by two corners: no limit, structural, both",
      "a) no limit; b) structural springs limited to 10 %; c) structural and shear springs limited.",
      commands);
  study.picture(
      "fig2-strain", beside(coloured), "The same three, coloured by strain",
      fmt::format("The same, coloured by the largest strain of a particle's springs: dark 0, yellow "
                  "{:.0f} % and more, one scale for all three.",
                  100 * strain_scale),
      commands);
  page.table(table);
}

void reproduce_wind(StudyPage& study) {
  study.page().heading("The report's Fig. 3: the wind");
  const SceneRun run = scene_run("wind");
  Simulation simulation(run.scene);
  std::vector<Image> panels;
  constexpr std::array<double, 3> times{0.5, 1.5, 4.0};
  std::vector<Vec3Field> shapes;
  for (const double time : times) {
    const double from = shapes.empty() ? 0 : simulation.time() / times.back();
    if (!advance(simulation, time, study, from, time / times.back())) return;
    shapes.push_back(simulation.state().position);
  }
  const Vec3Field everywhere = joined(shapes);  // one camera for all three
  const PictureOptions look{.arrows = wind_arrows(run.scene, everywhere)};
  const PictureCamera camera =
      camera_showing(run.scene, everywhere, Vec3(0.85, 0.12, 0.75), panel_aspect, look.arrows);
  for (const Vec3Field& shape : shapes)
    panels.push_back(panel(run.scene, simulation.system(), shape, camera, look));
  const Measurement measurement = simulation.measure();
  study.number("work of the air on the cloth in 4 s", measurement.ledger.forces.air, "J");
  study.number("largest strain at 4 s", measurement.strain.maximum());
  study.picture(
      "fig3-wind", beside(panels), "A cloth hung by two corners, blown backwards, at three times",
      fmt::format("A wind of 2.5 m/s with gusts of 60 % (arrows: the steady part) 0.5 s, 1.5 s and 4 s "
                  "after it rose. By then the air has done {:.3f} J of work on the cloth; no limited "
                  "spring is longer than its rest length by more than {:.2f} %.",
                  measurement.ledger.forces.air, 100 * measurement.strain.maximum()),
      run.command);
}

}  // namespace cloth

// Figures 4 and 5: three methods on one scene; obstacles and friction.
#include <fmt/format.h>

#include <cmath>

#include "integrators/registry.h"
#include "study/reproduce/study_page.h"

namespace cloth {
namespace {

Image panel(const Simulation& simulation, const Vec3& direction) {
  const Scene& scene = simulation.scene();
  const Vec3Field& position = simulation.state().position;
  return cloth_image(scene, simulation.system(), position,
                     camera_showing(scene, position, direction, panel_aspect, {}, simulation.time()),
                     {.width = panel_width, .height = panel_height, .time = simulation.time()});
}

/// Root mean square speed of the particles, m/s.
double rms_speed(const Simulation& simulation) {
  const auto velocity = simulation.state().velocity.flat();
  double sum = 0;
  for (const double v : velocity) sum += v * v;
  return std::sqrt(sum / simulation.system().size());
}

/// Runs to the end and keeps the speed every 0.02 s.
bool run_with_speed(Simulation& simulation, StudyPage& study, double from, double to, PlotSeries& series) {
  const double duration = simulation.scene().duration;
  const int samples = static_cast<int>(std::lround(duration / 0.02));
  for (int k = 0; k < samples; ++k) {
    series.points.push_back({.x = simulation.time(), .y = rms_speed(simulation)});
    const double time = duration * (k + 1) / samples;
    if (simulation.time() >= time - 0.5 * simulation.time_step()) continue;
    if (!advance(simulation, time, study, from + (to - from) * k / samples,
                 from + (to - from) * (k + 1) / samples))
      return false;
  }
  series.points.push_back({.x = simulation.time(), .y = rms_speed(simulation)});
  return true;
}

LinePlot speed_plot(const std::string& title, std::vector<PlotSeries> series) {
  for (PlotSeries& one : series) one.markers = false;
  return {.title = title,
          .x = {.label = "time", .unit = "s"},
          .y = {.label = "root mean square speed", .unit = "m/s", .low = 0},
          .series = std::move(series),
          .plot_height = 300};
}

/// Runs whose pictures stand side by side, and their speeds.
struct MotionFigure {
  std::vector<Image> panels{};
  std::vector<PlotSeries> speeds{};
  std::string commands{};

  /// `from`: the part of the whole at which the run begins; it is a fifth. False: stopped.
  bool add(const SceneRun& run, const std::string& name, const std::string& output, double from,
           StudyPage& study) {
    commands += (commands.empty() ? "" : " && ") + run.command + output;
    Simulation simulation(run.scene);
    if (!run_with_speed(simulation, study, from, from + 0.2, speeds.emplace_back(PlotSeries{.name = name})))
      return false;
    panels.push_back(panel(simulation, usual_direction));
    return true;
  }
};

bool show_obstacles(StudyPage& study) {
  constexpr std::array<const char*, 3> scenes{"ball", "cube", "rectangle"};
  MotionFigure figure;
  for (std::size_t k = 0; k < scenes.size(); ++k) {
    if (!figure.add(scene_run(scenes[k]), scenes[k], "", 0.2 * static_cast<double>(k), study)) return false;
    study.number(fmt::format("{}: speed at the end", scenes[k]), figure.speeds.back().points.back().y, "m/s");
  }
  study.picture(
      "fig5-obstacles", beside(figure.panels), "The cloth on a ball, on a cube, and on a rectangular box",
      "a) a ball, b) a cube, c) a rectangle placed at the cloth's edge, where the fabric slips past: "
      "3 s after the cloth was let go.",
      figure.commands);
  study.plot("fig5-rest", speed_plot("The cloth comes to rest", std::move(figure.speeds)),
             "The particles' root mean square speed: the fall, the impact, and coming to rest.");
  return true;
}

bool show_friction(StudyPage& study) {
  constexpr std::array<const char*, 2> frictions{"0.1", "0.8"};
  MotionFigure figure;
  std::array<double, 2> mean{};
  for (std::size_t k = 0; k < frictions.size(); ++k) {
    const SceneRun run = scene_run("ball", {"cloth.origin=[-0.32, 0.75, -0.5]", "duration=0.9",
                                            fmt::format("obstacles.0.friction={}", frictions[k])});
    if (!figure.add(run, fmt::format("friction {}", frictions[k]), std::string("-friction-") + frictions[k],
                    0.6 + 0.2 * static_cast<double>(k), study))
      return false;
    const std::vector<PlotPoint>& points = figure.speeds.back().points;
    double sum = 0;
    for (const PlotPoint& point : points) sum += point.y;
    mean[k] = sum / static_cast<double>(points.size());
    study.number(fmt::format("friction {}: mean speed over 0.9 s", frictions[k]), mean[k], "m/s");
  }
  study.picture("fig5-friction", beside(figure.panels),
                "The cloth on a ball under its edge, little and much friction",
                "The ball away from the cloth's middle, after 0.9 s: with a friction of 0.1 the cloth has "
                "slipped off (left), with 0.8 it still hangs (right).",
                figure.commands);
  study.plot(
      "fig5-friction", speed_plot("More friction, slower cloth", std::move(figure.speeds)),
      fmt::format("The same two: over the whole time the mean speed is {:.3f} m/s with friction 0.1 and "
                  "{:.3f} m/s with 0.8.",
                  mean[0], mean[1]));
  return true;
}

/// The final shapes of the three methods; empty where stopped.
std::vector<Vec3Field> three_shapes(const char* scene, const std::string& step, StudyPage& study, double from,
                                    std::vector<Image>* panels) {
  std::vector<Vec3Field> shapes;
  for (const char* method : report_methods) {
    const SceneRun run =
        scene_run(scene, {fmt::format("integrator.method={}", method), "integrator.time_step=" + step});
    Simulation simulation(run.scene);
    const double part = from + 0.5 * static_cast<double>(shapes.size()) / 3;
    if (!advance(simulation, run.scene.duration, study, part, part + 0.16)) return {};
    if (panels) panels->push_back(panel(simulation, Vec3(0.3, 0.25, 1)));
    shapes.push_back(simulation.state().position);
  }
  return shapes;
}

}  // namespace

void reproduce_methods(StudyPage& study) {
  HtmlPage& page = study.page();
  page.heading("The report's Fig. 4: three methods, one scene, one step");
  std::vector<Image> panels;
  const auto smooth = three_shapes("corners-free", "0.0005", study, 0, &panels);
  if (smooth.empty()) return;
  study.picture(
      "fig4-methods", beside(panels), "The same cloth by three methods",
      "a) semi-implicit Euler, b) Runge-Kutta 4, c) Verlet: corners-free with a step of 0.5 ms after 2 s. "
      "To the eye they are one; the distances are below.",
      "for method in semi-implicit-euler rk4 verlet; do clothlab-cli run corners-free --set "
      "integrator.method=$method --set integrator.time_step=0.0005 --out $method; done");
  const auto limited = three_shapes("corners-shear", "0.0005", study, 0.5, nullptr);
  if (limited.empty()) return;

  HtmlTable table = number_table("Root mean square distance of the particles between two methods after 2 s",
                                 {"methods", "corners-free (smooth)", "corners-shear (limited to 10 %)"});
  constexpr std::array<std::array<std::size_t, 2>, 3> pairs{{{0, 1}, {2, 1}, {0, 2}}};
  for (const auto& [a, b] : pairs) {
    const std::string name = facts_of(report_methods[a]).title + " to " + facts_of(report_methods[b]).title;
    const double free = study.number(name + ", smooth", rms_distance(smooth[a], smooth[b]), "m");
    const double held = study.number(name + ", limited", rms_distance(limited[a], limited[b]), "m");
    table.rows.push_back({{name, html_number(1000 * free) + " mm", html_number(1000 * held) + " mm"}});
  }
  page.table(table);
}

void reproduce_obstacles(StudyPage& study) {
  study.page().heading("The report's Fig. 5: obstacles");
  if (show_obstacles(study)) show_friction(study);
}

}  // namespace cloth

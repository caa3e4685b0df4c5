// The errata as a page shows them: what is printed, what is expected of it, what was measured.
#include <fmt/format.h>

#include <cmath>

#include "measure/amplification.h"
#include "measure/stability_limit.h"
#include "study/reproduce/errata.h"
#include "study/reproduce/study_page.h"

namespace cloth {
namespace {

/// A table of expected and measured numbers, every row kept as a result too.
class Comparison {
 public:
  Comparison(StudyPage& study, const std::string& caption)
      : study_(study), table_(number_table(caption, {"", "expected", "measured"})) {}
  Comparison& row(const std::string& name, double expected, double value, const std::string& unit = {}) {
    study_.number(name, value, unit, expected);
    const std::string behind = unit.empty() ? "" : " " + unit;
    table_.rows.push_back({{name, shown(expected) + behind, shown(value) + behind}});
    return *this;
  }
  void add() { study_.page().table(table_); }

 private:
  static HtmlText shown(double value) {
    const bool plain = value == 0 || (std::abs(value) >= 0.001 && std::abs(value) < 1e4);
    return plain ? HtmlText(fmt::format("{:.4g}", std::abs(value) < 5e-7 ? 0.0 : value))
                 : html_number(value, 4);
  }
  StudyPage& study_;
  HtmlTable table_;
};

PlotSeries series_of(const std::string& name, const Curve& curve) {
  PlotSeries series{.name = name, .markers = false};
  for (const auto& [x, y] : curve) series.points.push_back({.x = x, .y = y});
  return series;
}

void show_orders(StudyPage& study) {
  study.page().heading("Eqs. (8) and (14): orders that are lost", 3);
  study.page().paragraph(
      "A cloth of 6 x 6 particles with viscous damping, drag and a gusty wind, 0.4 s, against Runge-Kutta 4 "
      "with 12800 steps. Eq. (8) weighs k3 with 3: the weights sum to 7/6, so it solves another equation, "
      "x' = 7/6 f, however small the step. Eq. (14) knows the velocity only half a step late; with damping "
      "in "
      "the force Verlet falls to order 1 unless the damping is centred.");
  const auto methods = errors_of_printed_methods();
  LinePlot plot{.title = "Error of the printed and the right formulas",
                .x = {.label = "time step", .unit = "s", .scale = AxisScale::logarithmic},
                .y = {.label = "root mean square error", .unit = "m", .scale = AxisScale::logarithmic},
                .triangles = {{1, "1"}, {2, "2"}, {4, "4"}},
                .plot_height = 360};
  Comparison table(study, "Observed order over the last halving of the step");
  for (const MethodErrors& method : methods) {
    PlotSeries series{.name = method.name,
                      .detail = fmt::format("observed order {:.2f}", method.last_order())};
    for (std::size_t k = 0; k < method.steps.size(); ++k)
      series.points.push_back({.x = method.steps[k], .y = method.errors[k]});
    plot.series.push_back(std::move(series));
    table.row(method.name + ": order", method.order, method.last_order());
  }
  study.number("Runge-Kutta 4 with 3 k3: error that stays", methods.front().errors.back(), "m");
  study.plot("errata-orders", plot,
             fmt::format("With 3 k3 the error stays at {:.1f} cm however small the step is.",
                         100 * methods.front().errors.back()));
  table.add();
}

void show_turns(StudyPage& study) {
  const WeightedRungeKutta printed = weighted_runge_kutta(3), right = weighted_runge_kutta(2);
  study.plot("errata-oscillator",
             {.title = "One oscillator, two periods",
              .x = {.label = "time", .unit = "periods", .low = 0, .high = 2},
              .y = {.label = "x"},
              .series = {series_of("as printed, 3 k3", printed.position), series_of("2 k3", right.position)},
              .plot_height = 260},
             "x'' = -x with 1000 steps a period: as printed, time itself runs too fast by a sixth.");
  Comparison(study, "Runge-Kutta 4 with 3 k3 on x' = -x and on the oscillator")
      .row("3 k3: error of x' = -x at t = 1, 320 steps", 5.66e-2, printed.decay_error)
      .row("3 k3: turns per period", 7.0 / 6, printed.turns)
      .row("2 k3: turns per period", 1, right.turns)
      .add();
}

void show_hooke(StudyPage& study) {
  study.page().heading("Eq. (1): Hooke's law with the current length", 3);
  const CurrentLengthCloth cloth = current_length_cloth();
  study.plot(
      "errata-hooke",
      {.title = "A free cloth with F = -k l",
       .x = {.label = "time", .unit = "s", .low = 0},
       .y = {.label = "largest distance from the middle", .unit = "m", .low = 0},
       .series = {series_of("as printed", cloth.radius)},
       .plot_height = 260},
      "10 x 10 particles of 10 g, 0.1 m apart, springs of 100 N/m: with the current length in place of "
      "the elongation every spring pulls at rest, and the cloth falls into its own middle.");
  Comparison(study, "The same cloth; with the elongation all of it would be 0 and nothing would move")
      .row("F = -k l: force on a corner at rest", 56.6, cloth.pull, "N")
      .row("F = -k l: acceleration of a corner", 577, cloth.pull_in_g, "g")
      .row("F = -k l: radius at the start", 0.636, cloth.start_radius, "m")
      .row("F = -k l: least radius", 0.039, cloth.least_radius, "m")
      .row("F = -k l: time of the collapse", 0.0195, cloth.time, "s")
      .add();
}

void show_contact(StudyPage& study) {
  HtmlPage& page = study.page();
  page.heading("Eqs. (17) and (20): contact", 3);
  page.paragraph(
      "Eq. (20) sets all three coordinates of a particle inside a box to plus or minus its half width h: it "
      "jumps to the nearest corner. Only the coordinate of least penetration must move. Speeds are those of "
      "v = dx/dt for h = 0.5 m and a step of 1 ms.");
  const CubePush push = cube_push();
  Comparison(study, "Displacement of a particle found inside a cube, in half widths h")
      .row("all three, mean over the cube", 0.961, push.mean_corner, "h")
      .row("least penetration, mean over the cube", 0.250, push.mean_least, "h")
      .row("all three, at (0.1, 0.99, 0.2) h", 1.204, push.corner, "h")
      .row("least penetration, at (0.1, 0.99, 0.2) h", 0.010, push.least, "h")
      .row("all three: speed of that jump", 602, push.corner * 0.5 / 1e-3, "m/s")
      .row("least penetration: speed of that jump", 5, push.least * 0.5 / 1e-3, "m/s")
      .add();
  const auto [printed, right] = leaving_particle();
  page.paragraph(
      "Eq. (17) reflects the velocity of every touching particle. One that is already on its way out is "
      "turned back in; the response must be left out where v . n is not negative.");
  study.plot("errata-leaving",
             {.title = "A particle inside a ball, leaving at 1 m/s",
              .x = {.label = "time", .unit = "s", .low = 0, .high = 0.02},
              .y = {.label = "distance from the surface", .unit = "m"},
              .series = {series_of("reflected although it leaves", printed.distance),
                         series_of("left alone", right.distance)},
              .lines = {{.at = 0, .label = "surface"}},
              .plot_height = 260},
             "Steps of 1 ms, friction coefficient 0.9. As printed the particle is sent back in and must be "
             "put out a second time.");
  Comparison(study, "Velocity along the outward normal after the first response")
      .row("Eq. (17) for every touching particle", -0.9, printed.velocity, "m/s")
      .row("only where v . n < 0", 1, right.velocity, "m/s")
      .add();
}

void show_euler(StudyPage& study) {
  HtmlPage& page = study.page();
  page.heading("Eqs. (6) and (7): semi-implicit is not implicit", 3);
  Curve semi, implicit;
  for (int k = 0; k <= 120; ++k) {
    const double w = 0.1 * std::pow(10.0, k / 60.0);
    semi.emplace_back(w, amplification("semi-implicit-euler", w, 0));
    implicit.emplace_back(w, amplification("implicit-euler", w, 0));
  }
  study.plot(
      "errata-euler",
      {.title = "Growth of an undamped oscillation in one step",
       .x = {.label = "frequency times step", .scale = AxisScale::logarithmic},
       .y = {.label = "spectral radius", .scale = AxisScale::logarithmic},
       .series = {series_of("semi-implicit Euler, Eqs. (6), (7)", semi),
                  series_of("implicit Euler", implicit)},
       .lines = {{.at = 1, .label = "neither grows nor dies"}},
       .plot_height = 300},
      "What the report calls implicit Euler evaluates the forces at the old positions: it is stable up "
      "to a step of 2/omega only, and there loses no energy.");
  Comparison(study, "Spectral radius at omega h = w")
      .row("semi-implicit Euler, w = 1.9", 1, amplification("semi-implicit-euler", 1.9, 0))
      .row("semi-implicit Euler, w = 2.1", 1.88, amplification("semi-implicit-euler", 2.1, 0))
      .row("semi-implicit Euler, w = 10", 98, amplification("semi-implicit-euler", 10, 0))
      .row("implicit Euler, w = 2.1", 0.43, amplification("implicit-euler", 2.1, 0))
      .row("implicit Euler, w = 10", 0.0995, amplification("implicit-euler", 10, 0))
      .add();
}

/// The same said by a cloth: just below the limit it hangs, just above it does not.
void show_limit(StudyPage& study) {
  const Scene scene = scene_run("corners-free", {"integrator.method=semi-implicit-euler"}).scene;
  const double limit = *stable_step("semi-implicit-euler", scene);
  for (const double part : {0.95, 1.1}) {
    Scene tried = scene;
    tried.integrator.time_step = part * limit;
    Simulation simulation(tried);
    std::optional<Divergence> divergence;
    while (simulation.time() < 1 && !divergence && study.go_on(0.9)) divergence = simulation.step();
    study.number(fmt::format("corners-free at {} of the limit: steps until it diverged (0: never)", part),
                 divergence ? static_cast<double>(divergence->step) : 0);
    study.page().paragraph(
        HtmlText(fmt::format("corners-free with a step of {:.3f} ms, {} of the stability limit: {} ",
                             1e3 * part * limit, part,
                             divergence ? fmt::format("diverged in step {}.", divergence->step)
                                        : std::string("1 s without trouble."))) +
        html_code(
            fmt::format("clothlab-cli run corners-free --set integrator.method=semi-implicit-euler --set "
                        "integrator.time_step={:.6g}",
                        part * limit)));
  }
}

}  // namespace

void reproduce_errata(StudyPage& study) {
  HtmlPage& page = study.page();
  page.heading("Errata, by experiment");
  page.paragraph(HtmlText("What the report prints against what is right. All of it is made by ") +
                 html_code(study.part_command()) + "; the unit of Table 1 is discussed there.");
  constexpr std::array<void (*)(StudyPage&), 6> experiments{show_orders,  show_turns, show_hooke,
                                                            show_contact, show_euler, show_limit};
  for (std::size_t k = 0; k < experiments.size(); ++k) {
    if (!study.go_on(static_cast<double>(k) / experiments.size())) return;
    experiments[k](study);
  }
}

}  // namespace cloth

// Table 1: the time of 2500 steps with each method at the same step.
#include <fmt/format.h>

#include <algorithm>
#include <chrono>

#include "integrators/registry.h"
#include "study/reproduce/study_page.h"

namespace cloth {
namespace {

constexpr int frames = 2500, repeats = 5;

struct TimedMethod {
  const char* method;
  double printed;  ///< Table 1's time of 2500 frames
  std::vector<double> seconds{};
  double least() const { return *std::min_element(seconds.begin(), seconds.end()); }
  double most() const { return *std::max_element(seconds.begin(), seconds.end()); }
};

std::vector<TimedMethod> printed_table() {
  return {{"semi-implicit-euler", 4885511}, {"rk4", 12793878}, {"verlet", 4844902}};
}

/// Seconds of 2500 steps; nullopt where stopped or diverged. Nothing but steps between the two looks at the
/// clock.
std::optional<double> time_frames(const Scene& scene) {
  Simulation simulation(scene);
  const auto start = std::chrono::steady_clock::now();
  for (int frame = 0; frame < frames; ++frame)
    if (simulation.step()) return std::nullopt;
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

/// All methods in turn, starting with another one every time; the first round does not count.
bool time_methods(std::vector<TimedMethod>& methods, const char* scene, StudyPage& study, double from,
                  double to) {
  for (int repeat = 0; repeat <= repeats; ++repeat)
    for (std::size_t k = 0; k < methods.size(); ++k) {
      const double done = repeat * 3.0 + static_cast<double>(k);
      if (!study.go_on(from + (to - from) * done / (3.0 * (repeats + 1)))) return false;
      TimedMethod& method = methods[(k + static_cast<std::size_t>(repeat)) % methods.size()];
      const SceneRun run = scene_run(scene, {fmt::format("integrator.method={}", method.method),
                                             "integrator.time_step=0.0005", "duration=1.25"});
      const auto seconds = time_frames(run.scene);
      if (!seconds) return false;
      if (repeat > 0) method.seconds.push_back(*seconds);
    }
  return true;
}

void add_timed_table(const std::vector<TimedMethod>& methods, const std::string& scene, StudyPage& study) {
  HtmlTable table = number_table(
      HtmlText("2500 steps of 0.5 ms of ") + html_code(scene) +
          fmt::format(" (33 x 33 particles), {} interleaved repeats: minimum, and maximum over minimum",
                      repeats),
      {"method", "2500 frames", "spread", "one frame", "ratio measured", "ratio in the report"});
  const TimedMethod& euler = methods.front();
  for (const TimedMethod& method : methods) {
    const double ratio = method.least() / euler.least(), printed = method.printed / euler.printed;
    const std::string title = facts_of(method.method).title;
    study.number(fmt::format("{}: {}, 2500 frames", scene, method.method), method.least(), "s");
    study.number(fmt::format("{}: {}, ratio to semi-implicit Euler", scene, method.method), ratio, "",
                 printed);
    table.rows.push_back(
        {{title, fmt::format("{:.1f} ms", 1e3 * method.least()),
          fmt::format("+{:.0f} %", 100 * (method.most() / method.least() - 1)),
          fmt::format("{:.1f} µs", 1e6 * method.least() / frames),
          HtmlCell(html_strong(fmt::format("{:.2f}", ratio))), fmt::format("{:.2f}", printed)}});
  }
  study.page().table(table);
}

}  // namespace

void reproduce_table(StudyPage& study) {
  HtmlPage& page = study.page();
  page.heading("The report's Table 1: 2500 frames");
  std::vector<TimedMethod> smooth = printed_table(), limited = printed_table();
  if (!time_methods(smooth, "corners-free", study, 0, 0.4)) return;
  add_timed_table(smooth, "corners-free", study);
  if (!time_methods(limited, "corners-shear", study, 0.4, 1)) return;
  add_timed_table(limited, "corners-shear", study);
  page.paragraph(
      "Runge-Kutta 4 evaluates the forces four times a step, the others once, so about 4 is expected where "
      "nothing but integration is timed; what every frame does besides (limiting the deformation, and "
      "drawing in the report's program) is the same for all methods and pulls the ratio toward 1. The "
      "report's 2.62 is what a frame gives of which 46 % is such fixed work: 4 e + f = 2.62 (e + f). Verlet "
      "here also solves for the velocity that centres the damping, which the report's does not; and it keeps "
      "the "
      "force over to the next step, so that after a step that the limiter changed it evaluates once more.");
  page.heading("The unit of Table 1", 3);
  HtmlTable units =
      number_table("What a frame of the report would take in either unit",
                   {"method", "printed", "if milliseconds", "if microseconds", "measured here"});
  for (const TimedMethod& method : smooth)
    units.rows.push_back({{facts_of(method.method).title, fmt::format("{:.0f}", method.printed),
                           fmt::format("{:.2f} s a frame, {:.0f} min in all", method.printed / frames / 1e3,
                                       method.printed / 6e4),
                           fmt::format("{:.2f} ms a frame", method.printed / frames / 1e3),
                           fmt::format("{:.3f} ms a step", 1e3 * method.least() / frames)}});
  page.table(units);
  page.paragraph(
      "A program that shows a moving cloth does not take 2 s for a frame: the printed unit is off by a "
      "factor "
      "of 1000. The ratios do not depend on it.");
  page.paragraph(HtmlText("The same runs, one by one: ") +
                 html_code("clothlab-cli run corners-free --set integrator.method=rk4 --set "
                           "integrator.time_step=0.0005 --set duration=1.25") +
                 ". All of it: " + html_code(study.part_command()) + ".");
}

}  // namespace cloth

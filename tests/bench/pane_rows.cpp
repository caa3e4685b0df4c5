#include "pane_rows.h"

#include <fmt/format.h>
#include <stdlib.h>

#include <array>
#include <limits>

#include "bench_tools.h"
#include "main_window/lab_window.h"
#include "scene/builtin_scenes.h"

namespace clothlab {
namespace {

using json = nlohmann::ordered_json;

constexpr double warm_up = 1.5;  // s

cloth::Comparison comparison_of(int panes, int side) {
  const std::vector<std::string> methods{"verlet", "semi-implicit-euler", "rk4", "verlet"};
  cloth::Comparison comparison;
  comparison.scene = cloth::builtin_scene("corners-free");
  comparison.scene.cloth.rows = comparison.scene.cloth.columns = side;
  comparison.panes = cloth::panes_for({methods.begin(), methods.begin() + panes});
  comparison.reference = "A";
  return comparison;
}

json event_json(const EventTime& event) {
  return {{"wall_ms", event.wall},
          {"processor_ms", event.processor},
          {"kind", fmt::format("{} type {}", event.kind.first, event.kind.second)}};
}

/// Processes that ran or wanted to, on average over the last minute.
double machine_load() {
  std::array<double, 1> load{};
  return ::getloadavg(load.data(), 1) == 1 ? load[0] : std::numeric_limits<double>::quiet_NaN();
}

json kinds_json(const TimedApplication& application) {
  json kinds = json::array();
  for (const auto& [kind, times] : application.times())
    kinds.push_back({{"kind", fmt::format("{} type {}", kind.first, kind.second)},
                     {"count", times.size()},
                     {"median_ms", median(times)},
                     {"most_ms", quantile(times, 1)}});
  return kinds;
}

}  // namespace

json pane_row(TimedApplication& application, int panes, int side, const std::string& look, double seconds) {
  LabWindow window;
  window.setAsksToSave(false);
  window.show();
  window.document().load(comparison_of(panes, side));
  window.simulation().settle();
  run_events(0.5);
  const char* const mode = look == "strain"      ? "modeStrain"
                           : look == "wireframe" ? "modeWireframe"
                                                 : "modeTextured";
  window.findChild<QAction*>(mode)->trigger();
  std::vector<std::int64_t> drawn_in;  // the number of the event of each drawing
  std::vector<double> drawings;        // ms
  for (int i = 0; i < panes; ++i)
    QObject::connect(&window.panes().pane(static_cast<std::size_t>(i)).view(), &ClothView::frameDrawn,
                     &window, [&](double milliseconds) {
                       drawn_in.push_back(application.event_number());
                       drawings.push_back(milliseconds);
                     });
  window.simulation().send(command::Speed{std::numeric_limits<double>::infinity()});
  window.simulation().send(command::Play{});
  run_events(warm_up);
  drawn_in.clear();
  drawings.clear();
  const double began = window.simulation().status().time;
  application.watch();
  run_events(seconds);
  application.stop_watching();
  std::ptrdiff_t most = 0;
  for (const std::int64_t event : drawn_in)
    most = std::max(most, std::count(drawn_in.begin(), drawn_in.end(), event));
  const QSize size = window.panes().pane(0).view().size();
  const json row{{"panes", panes},
                 {"side", side},
                 {"look", look},
                 {"view_px", {size.width(), size.height()}},
                 {"drawings_per_second", static_cast<double>(drawings.size()) / seconds},
                 {"drawing_ms", median(drawings)},
                 {"most_drawings_in_an_event", most},
                 {"longest_event", event_json(application.longest())},
                 {"busiest_event", event_json(application.busiest())},
                 {"simulated_s", window.simulation().status().time - began},
                 {"machine_load", machine_load()},
                 {"kinds", kinds_json(application)}};
  window.simulation().send(command::Pause{});
  window.simulation().settle();
  return row;
}

void print_pane_head() {
  fmt::print("\n{:>5} {:>4} {:<10} {:>10} {:>10} {:>8} {:>6} {:>9} {:>9} {:>9} {:>6}\n", "panes", "side",
             "look", "view", "drawings/s", "drawing", "at once", "longest", "(its cpu)", "most cpu", "load");
}

void print_pane_row(const json& row) {
  fmt::print("{:>5} {:>4} {:<10} {:>10} {:>10.1f} {:>8.1f} {:>6} {:>9.1f} {:>9.1f} {:>9.1f} {:>6.1f}  {}\n",
             row["panes"].get<int>(), row["side"].get<int>(), row["look"].get<std::string>(),
             fmt::format("{} x {}", row["view_px"][0].get<int>(), row["view_px"][1].get<int>()),
             row["drawings_per_second"].get<double>(), row["drawing_ms"].get<double>(),
             row["most_drawings_in_an_event"].get<int>(), row["longest_event"]["wall_ms"].get<double>(),
             row["longest_event"]["processor_ms"].get<double>(),
             row["busiest_event"]["processor_ms"].get<double>(), row["machine_load"].get<double>(),
             row["longest_event"]["kind"].get<std::string>());
  std::fflush(stdout);
}

}  // namespace clothlab

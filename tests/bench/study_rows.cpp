#include "study_rows.h"

#include <fmt/format.h>

#include <QElapsedTimer>
#include <QTemporaryDir>

#include "bench_tools.h"
#include "bridge/study_runner.h"
#include "main_window/lab_window.h"
#include "scene/builtin_scenes.h"

namespace clothlab {
namespace {

using json = nlohmann::ordered_json;

/// What a person sees of the run: how far apart its pictures are, and what a step takes.
struct Watched {
  std::vector<double> intervals, steps;  ///< ms
  double simulated = 0, watched = 0;     ///< s

  json summary() const {
    return {{"frame_ms",
             {{"median", median(intervals)},
              {"p95", quantile(intervals, 0.95)},
              {"worst", quantile(intervals, 1)}}},
            {"step_ms",
             {{"median", median(steps)}, {"p95", quantile(steps, 0.95)}, {"worst", quantile(steps, 1)}}},
            {"real_time", simulated / watched}};
  }
};

void watch(LabWindow& window, double seconds, Watched& watched) {
  QObject context;
  QElapsedTimer clock;
  clock.start();
  double last = -1;
  QObject::connect(&window.view(), &ClothView::frameDrawn, &context, [&] {
    const double now = 1e-6 * static_cast<double>(clock.nsecsElapsed());
    if (last >= 0) watched.intervals.push_back(now - last);
    last = now;
  });
  QObject::connect(&window.simulation(), &RunLink::samplesReady, &context,
                   [&](const std::vector<ChartSample>& samples) {
                     for (const ChartSample& sample : samples)
                       if (sample.step_ms > 0) watched.steps.push_back(sample.step_ms);
                   });
  const double before = window.simulation().status().time;
  run_events(seconds);
  watched.simulated += window.simulation().status().time - before;
  watched.watched += 1e-3 * static_cast<double>(clock.elapsed());
}

/// Long enough for a round, and cancelled at its end.
StudyOrder study_of(const cloth::Scene& scene, const QTemporaryDir& folder) {
  cloth::WorkPrecisionOptions options;
  return {.scene = scene,
          .options = std::move(options),
          .folder = folder.filePath("study").toStdString(),
          .command = "clothlab-window-bench"};
}

}  // namespace

json study_row(int side, double seconds, int rounds) {
  cloth::Scene scene = cloth::builtin_scene("wind");
  scene.cloth.rows = scene.cloth.columns = side;
  scene.duration = 1e6;
  LabWindow window;
  window.setAsksToSave(false);
  window.show();
  window.document().load(scene);
  window.simulation().settle();
  window.simulation().send(command::Play{});
  run_events(1.5);
  cloth::Scene studied = cloth::builtin_scene("wind");
  studied.duration = 1;
  const QTemporaryDir folder;
  Watched alone, beside;
  for (int round = 0; round < rounds; ++round) {
    watch(window, seconds, alone);
    StudyRunner study;
    study.start(study_of(studied, folder));
    run_events(0.3);
    watch(window, seconds, beside);
    if (!study.is_running()) fmt::print(stderr, "the study ended before its round\n");
  }
  return {{"side", side},
          {"seconds", seconds * rounds},
          {"alone", alone.summary()},
          {"beside_a_study", beside.summary()}};
}

void print_study_head() {
  fmt::print("\n{:>4} {:<16} {:>8} {:>8} {:>8} {:>10} {:>8} {:>8} {:>10}\n", "side", "", "interval", "p95",
             "worst", "step", "p95", "worst", "real time");
}

void print_study_row(const json& row) {
  for (const char* const which : {"alone", "beside_a_study"}) {
    const json& part = row[which];
    const auto of = [&](const char* what, const char* how) { return part[what][how].get<double>(); };
    fmt::print("{:>4} {:<16} {:>8.1f} {:>8.1f} {:>8.1f} {:>10.3f} {:>8.3f} {:>8.3f} {:>9.2f}x\n",
               row["side"].get<int>(), std::string(which) == "alone" ? "alone" : "beside a study",
               of("frame_ms", "median"), of("frame_ms", "p95"), of("frame_ms", "worst"),
               of("step_ms", "median"), of("step_ms", "p95"), of("step_ms", "worst"),
               part["real_time"].get<double>());
  }
  std::fflush(stdout);
}

}  // namespace clothlab

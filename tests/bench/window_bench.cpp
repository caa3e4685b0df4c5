// clothlab-window-bench: what a drawing takes in the real window, its view 900 x 700 px. Prints figures;
// judges nothing, ends with 0. Needs a display of some 1700 x 900 px (an Xvfb will do).
//
//     clothlab-window-bench [--sides 33 128 256] [--looks textured wireframe strain]
//                           [--panes 2 4] [--pane-side 128] [--study-rounds 0] [--study-side 33]
//                           [--starts 5] [--answers 20] [--answer-side 256] [--seconds 4] [--idle 5] [--json]
//
// First what a start takes, see start_row.h. For each size and look, while the simulation runs beside it as
// fast as it goes:
//   drawings/s  how often a new picture of the cloth is in the window
//   interval    ms between two pictures: median, and 95th percentile (p95)
//   drawing     ms until a picture is complete: median
//   upload      ms of that for giving a new frame to OpenGL: median
//   longest     ms of the window's longest event: what a click waits for at worst
// and with the simulation paused, while pictures made before are shown again one after another:
//   cpu         ms of processor time for a picture in all of the program's threads. It hardly depends on
//               what else the machine does: the figure to compare between two builds.
// Then the charts, 900 px wide with a full history: ms of processor time to bring all three up to date, and
// to paint each, and the paused window: its share of one processor, and its events. At last comparisons of
// that many panes, for each look:
//   at once     the most pictures made in one event
//   longest     ms of the longest event by the clock, what the thread itself did of that, and which it was
//   most cpu    ms of the event that the thread was busiest in
//   load        of the machine in the last minute: above its cores, "longest" is also what others took
// and with --study-rounds the interval between two pictures, and the time of a step, of a run at real time,
// alone and beside a study. --sides 0 leaves out all but start, comparisons and study.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <QTemporaryDir>
#include <QTimer>
#include <algorithm>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>

#include "answer_row.h"
#include "bench_tools.h"
#include "main_window/lab_window.h"
#include "pane_rows.h"
#include "scene/builtin_scenes.h"
#include "start_row.h"
#include "study_rows.h"
#include "support/timed_application.h"
#include "theme/theme.h"
#include "viewport/gl/gl_probe.h"

namespace clothlab {
namespace {

using json = nlohmann::ordered_json;

constexpr QSize view_size{900, 700};
constexpr int warm_up_ms = 1200;
constexpr int replayed_frames = 16, replayed_drawings = 64;
const std::map<std::string, ViewMode> looks{
    {"textured", ViewMode::textured}, {"wireframe", ViewMode::wireframe}, {"strain", ViewMode::strain}};

struct Options {
  std::vector<int> sides{33, 128, 256};
  std::vector<std::string> looks{"textured", "wireframe", "strain"};
  std::vector<int> panes{2, 4};
  int pane_side = 128;
  int study_side = 33, study_rounds = 0, starts = 5;
  int answer_side = 256, answers = 20;
  double seconds = 4, idle = 5;
  bool json = false;
};

class WindowBench {
 public:
  WindowBench(TimedApplication& application, const Options& options)
      : application_(application), options_(options) {
    window_.setAsksToSave(false);
    window_.view().setFixedSize(view_size);
    window_.show();
    QObject::connect(&window_.view(), &ClothView::frameDrawn, &window_, [this](double milliseconds) {
      drawings_.push_back(milliseconds);
      if (const double upload = window_.view().lastUploadMilliseconds(); upload > 0)
        uploads_.push_back(upload);
      ends_.push_back(1e-6 * static_cast<double>(clock_.nsecsElapsed()));
      if (replaying_) show_next();
    });
    QObject::connect(&window_.simulation(), &RunLink::frameReady, &window_,
                     [this](std::size_t, const std::shared_ptr<const ClothFrame>& frame) {
                       if (keeping_ && frames_.size() < replayed_frames) frames_.push_back(frame);
                     });
    clock_.start();
  }

  json drawing_row(int side, const std::string& look) {
    open(side, look);
    window_.simulation().send(command::Play{});
    run_events(1e-3 * warm_up_ms);
    const Live live = watch_live();
    window_.simulation().send(command::Pause{});
    window_.simulation().settle();
    run_events(0.3);
    const Replay replay = watch_replay();
    return {{"side", side},
            {"look", look},
            {"drawings_per_second", live.per_second},
            {"interval_ms", {{"median", live.interval}, {"p95", live.interval_p95}}},
            {"drawing_ms", live.drawing},
            {"upload_ms", live.upload},
            {"longest_event_ms", live.longest},
            {"longest_event", fmt::format("{} type {}", live.longest_kind.first, live.longest_kind.second)},
            {"simulation_steps_per_second", live.steps_per_second},
            {"chart_repaint_ms", live.chart},
            {"chart_updates_per_second", live.chart_updates},
            {"paused_drawings_per_second", replay.per_second},
            {"processor_ms_per_drawing", replay.processor}};
  }

  /// The window as it is, paused.
  json idle_row() {
    window_.simulation().send(command::Pause{});
    run_events(1.5);  // the picture comes to rest
    application_.watch();
    const double before = processor_time();
    run_events(options_.idle);
    const double used = processor_time() - before;
    application_.stop_watching();
    std::size_t events = 0;
    for (const auto& [kind, times] : application_.times()) events += times.size();
    return {{"seconds", options_.idle},
            {"processor_share", used / options_.idle},
            {"events", events - std::min<std::size_t>(events, 1)}};  // not the timer that ends it
  }

  QSize size_of_view() const { return const_cast<LabWindow&>(window_).view().size(); }

 private:
  struct Live {
    double per_second, interval, interval_p95, drawing, upload, longest, steps_per_second, chart,
        chart_updates;
    EventKind longest_kind;
  };
  struct Replay {
    double per_second, processor;
  };

  void open(int side, const std::string& look) {
    cloth::Scene scene = cloth::builtin_scene("wind");
    scene.cloth.rows = scene.cloth.columns = side;
    window_.document().load(scene);
    window_.view().setMode(looks.at(look));
    window_.simulation().send(command::Speed{std::numeric_limits<double>::infinity()});
    window_.simulation().settle();
  }

  void forget() {
    drawings_.clear();
    uploads_.clear();
    ends_.clear();
  }

  Live watch_live() {
    forget();
    frames_.clear();
    keeping_ = true;
    application_.watch();
    run_events(options_.seconds);
    application_.stop_watching();
    keeping_ = false;
    std::vector<double> intervals;
    for (std::size_t i = 1; i < ends_.size(); ++i) intervals.push_back(ends_[i] - ends_[i - 1]);
    return {.per_second = static_cast<double>(drawings_.size()) / options_.seconds,
            .interval = median(intervals),
            .interval_p95 = quantile(intervals, 0.95),
            .drawing = median(drawings_),
            .upload = median(uploads_),
            .longest = application_.longest().wall,
            .steps_per_second = window_.simulation().status().steps_per_second,
            .chart = median(application_.times({"clothlab::PlotView", QEvent::Paint})),
            .chart_updates =
                static_cast<double>(application_.times({"clothlab::ChartPanel", QEvent::Timer}).size()) /
                options_.seconds,
            .longest_kind = application_.longest().kind};
  }

  Replay watch_replay() {
    if (frames_.empty()) return {};
    forget();
    replaying_ = true;
    const double before = processor_time(), start = 1e-6 * static_cast<double>(clock_.nsecsElapsed());
    show_next();
    QEventLoop loop;
    finished_ = &loop;
    loop.exec();
    replaying_ = false;
    const double count = static_cast<double>(drawings_.size());
    return {.per_second = 1e3 * count / (ends_.back() - start),
            .processor = 1e3 * (processor_time() - before) / count};
  }

  void show_next() {
    if (drawings_.size() >= replayed_drawings) return finished_->quit();
    // Not from within the drawing before.
    QTimer::singleShot(0, &window_,
                       [this] { window_.view().showFrame(frames_[drawings_.size() % frames_.size()]); });
  }

  TimedApplication& application_;
  const Options& options_;
  LabWindow window_;
  QElapsedTimer clock_;
  std::vector<double> drawings_, uploads_, ends_;  // ms
  std::vector<std::shared_ptr<const ClothFrame>> frames_;
  bool keeping_ = false, replaying_ = false;
  QEventLoop* finished_ = nullptr;
};

/// Charts of the view's width over as long a run as they keep.
json chart_row(TimedApplication& application) {
  constexpr int samples = 1 << 19, updates = 40;
  ChartPanel panel;
  panel.resize(view_size);
  panel.setTimeSpan(ChartPanel::TimeSpan::whole_run);
  panel.show();
  const auto sample_at = [](int i) {
    const double t = 0.01 * i;
    return ChartSample{.time_s = t,
                       .kinetic_J = 5 + 4 * std::sin(3 * t),
                       .elastic_J = 2 + std::sin(11 * t),
                       .gravity_J = 3 - std::sin(3 * t),
                       .total_J = 10 + 0.1 * std::sin(0.001 * t),
                       .max_strain = 0.1 + 0.02 * std::sin(5 * t) * std::sin(0.01 * t),
                       .step_ms = 1.5 + 0.1 * std::cos(97 * t)};
  };
  std::vector<ChartSample> history;
  for (int i = 0; i < samples; ++i) history.push_back(sample_at(i));
  panel.append(history);
  for (int i = 0; i < samples; ++i)
    panel.appendDrawTime(history[static_cast<std::size_t>(i)].time_s, 9 + i % 3);
  run_events(0.5);
  application.watch();
  for (int i = 0; i < updates; ++i) {
    panel.append(std::vector{sample_at(samples + i)});
    run_events(0.04);
  }
  application.stop_watching();
  std::vector<double> refresh = application.times({"clothlab::ChartPanel", QEvent::Timer});
  return {{"samples", samples},
          {"width_px", panel.width()},
          {"update_ms", quantile(refresh, 0.5)},
          {"repaint_ms_each", median(application.times({"clothlab::PlotView", QEvent::Paint}))}};
}

void print_row(const json& row) {
  fmt::print("{:>4} {:<10} {:>10.1f} {:>8.1f} {:>8.1f} {:>8.1f} {:>8.2f} {:>8.1f} {:>10.1f} {:>12.0f}\n",
             row["side"].get<int>(), row["look"].get<std::string>(), row["drawings_per_second"].get<double>(),
             row["interval_ms"]["median"].get<double>(), row["interval_ms"]["p95"].get<double>(),
             row["drawing_ms"].get<double>(), row["upload_ms"].get<double>(),
             row["longest_event_ms"].get<double>(), row["processor_ms_per_drawing"].get<double>(),
             row["simulation_steps_per_second"].get<double>());
  std::fflush(stdout);
}

void measure_window(TimedApplication& application, const Options& options, json& result) {
  WindowBench bench(application, options);
  run_events(0.5);
  const QSize size = bench.size_of_view();
  result["view_px"] = {size.width(), size.height()};
  if (!options.json) {
    fmt::print("view {} x {} px, {}\n\n", size.width(), size.height(), result["renderer"].get<std::string>());
    fmt::print("{:>4} {:<10} {:>10} {:>8} {:>8} {:>8} {:>8} {:>8} {:>10} {:>12}\n", "side", "look",
               "drawings/s", "interval", "p95", "drawing", "upload", "longest", "cpu", "sim steps/s");
  }
  for (const int side : options.sides)
    for (const std::string& look : options.looks) {
      result["rows"].push_back(bench.drawing_row(side, look));
      if (!options.json) print_row(result["rows"].back());
    }
  result["charts"] = chart_row(application);
  result["idle"] = bench.idle_row();
  if (options.json) return;
  fmt::print(
      "\ncharts {} px wide, {} samples: {:.2f} ms to bring all three up to date, {:.2f} ms to paint each\n",
      result["charts"]["width_px"].get<int>(), result["charts"]["samples"].get<int>(),
      result["charts"]["update_ms"].get<double>(), result["charts"]["repaint_ms_each"].get<double>());
  fmt::print("paused for {:.0f} s: {:.2f} % of a processor, {} events\n", options.idle,
             100 * result["idle"]["processor_share"].get<double>(), result["idle"]["events"].get<int>());
}

void measure_panes(TimedApplication& application, const Options& options, json& result) {
  if (options.panes == std::vector{0}) return;
  if (!options.json) print_pane_head();
  for (const int panes : options.panes)
    for (const std::string& look : options.looks) {
      result["panes"].push_back(pane_row(application, panes, options.pane_side, look, options.seconds));
      if (!options.json) print_pane_row(result["panes"].back());
    }
}

int run(TimedApplication& application, const Options& options) {
  json result{{"renderer", gl_abilities().renderer.toStdString()}, {"rows", json::array()}};
  if (options.starts > 0) {
    result["start"] = start_row(options.starts);
    if (!options.json) print_start_row(result["start"]);
  }
  if (options.sides != std::vector{0}) measure_window(application, options, result);
  if (options.answers > 0) {
    result["answers"] = answer_row(options.answer_side, options.answers);
    if (!options.json) print_answer_row(result["answers"]);
  }
  measure_panes(application, options, result);
  if (options.study_rounds > 0) {
    result["study"] = study_row(options.study_side, options.seconds, options.study_rounds);
    if (!options.json) print_study_head(), print_study_row(result["study"]);
  }
  if (options.json) fmt::print("{}\n", result.dump(2));
  return 0;
}

}  // namespace
}  // namespace clothlab

int main(int argc, char** argv) {
  if (const int exit_code = clothlab::one_start(argc, argv); exit_code >= 0) return exit_code;
  const QTemporaryDir home;  // what an earlier window remembered is not measured
  qputenv("XDG_CONFIG_HOME", home.filePath("config").toUtf8());
  qputenv("XDG_DATA_HOME", home.filePath("data").toUtf8());
  TimedApplication application(argc, argv);
  clothlab::Options options;
  CLI::App app{"What a drawing takes in the window."};
  app.add_option("--sides", options.sides, "Particles per side; 0: only the comparisons")
      ->check(CLI::Range(0, 2048));
  app.add_option("--looks", options.looks, "Looks of the cloth")
      ->check(CLI::IsMember({"textured", "wireframe", "strain"}));
  app.add_option("--panes", options.panes, "Panes of the comparisons; 0: none")->check(CLI::Range(0, 4));
  app.add_option("--pane-side", options.pane_side, "Particles per side of a pane")
      ->check(CLI::Range(2, 2048));
  app.add_option("--study-rounds", options.study_rounds, "Rounds of a run beside a study; 0: none")
      ->check(CLI::Range(0, 1000));
  app.add_option("--study-side", options.study_side, "Particles per side of that run")
      ->check(CLI::Range(2, 2048));
  app.add_option("--starts", options.starts, "Starts of the window; 0: none")->check(CLI::Range(0, 1000));
  app.add_option("--answers", options.answers, "Answers to a hand; 0: none")->check(CLI::Range(0, 1000));
  app.add_option("--answer-side", options.answer_side, "Particles per side of the cloth beside them")
      ->check(CLI::Range(2, 2048));
  app.add_option("--seconds", options.seconds, "Seconds of each row")->check(CLI::Range(0.2, 600.0));
  app.add_option("--idle", options.idle, "Seconds of the paused window")->check(CLI::Range(0.2, 600.0));
  app.add_flag("--json", options.json, "Give the result as one JSON object");
  CLI11_PARSE(app, argc, argv);
  QSurfaceFormat::setDefaultFormat(clothlab::ClothView::surface_format());
  clothlab::apply_theme(application);
  return clothlab::run(application, options);
}

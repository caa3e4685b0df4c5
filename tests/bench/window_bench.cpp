// clothlab-window-bench: how long the window's events and pictures take with a cloth running. Prints figures;
// judges nothing. Needs a display.
//
//     clothlab-window-bench [PARTICLES PER SIDE] [SECONDS] [PANES]
#include <QAction>
#include <QApplication>
#include <QElapsedTimer>
#include <QStandardPaths>
#include <QTimer>
#include <algorithm>
#include <cstdio>
#include <map>
#include <string>
#include <vector>

#include "compare/compare_window.h"
#include "main_window/main_window.h"
#include "scene/builtin_scenes.h"
#include "theme/theme.h"

namespace {

/// Times every event that the window's thread handles, nested ones with the one around them.
class TimedApplication : public QApplication {
 public:
  using QApplication::QApplication;

  bool notify(QObject* receiver, QEvent* event) override {
    if (depth_ > 0 || !watching) return QApplication::notify(receiver, event);
    const int type = event->type();
    const char* const name = receiver->metaObject()->className();  // it may not outlive the event
    QElapsedTimer timer;
    timer.start();
    ++depth_;
    const bool handled = QApplication::notify(receiver, event);
    --depth_;
    const double taken = static_cast<double>(timer.nsecsElapsed()) * 1e-6;
    ++events;
    auto& kind = kinds[{name, type}];
    kind.total += taken;
    ++kind.count;
    if (taken > longest) longest = taken, longest_type = type, longest_receiver = name;
    return handled;
  }

  struct Kind {
    double total = 0;  // ms
    long count = 0;
  };

  bool watching = false;
  std::map<std::pair<std::string, int>, Kind> kinds;  // by receiver and QEvent::Type
  long events = 0;
  double longest = 0;  // ms
  int longest_type = 0;
  const char* longest_receiver = "";

 private:
  int depth_ = 0;
};

double quantile(std::vector<double> values, double part) {
  if (values.empty()) return 0;
  std::sort(values.begin(), values.end());
  return values[static_cast<std::size_t>(part * static_cast<double>(values.size() - 1))];
}

void print_busiest(const TimedApplication& application, double seconds) {
  std::vector<std::pair<double, std::string>> busiest;
  for (const auto& [key, kind] : application.kinds) {
    char line[160];
    std::snprintf(line, sizeof line, "  %6.1f ms each, %5.1f a second, type %d to %s",
                  kind.total / static_cast<double>(kind.count), static_cast<double>(kind.count) / seconds,
                  key.second, key.first.c_str());
    busiest.emplace_back(kind.total, line);
  }
  std::sort(busiest.rbegin(), busiest.rend());
  constexpr std::size_t shown = 6;
  std::printf("busiest events of the window's thread\n");
  for (std::size_t i = 0; i < std::min(shown, busiest.size()); ++i)
    std::printf("%5.1f %%%s\n", 0.1 * busiest[i].first / seconds, busiest[i].second.c_str());
}

struct Bench {
  TimedApplication& application;
  int side;
  double seconds;
  std::vector<double> drawings;

  void watch(clothlab::ClothView& view) {
    QObject::connect(&view, &clothlab::ClothView::frameDrawn, &application, [this](double milliseconds) {
      if (application.watching) drawings.push_back(milliseconds);
    });
  }

  void run() {
    constexpr int warm_up = 2000;  // ms
    QTimer::singleShot(warm_up, &application, [this] { application.watching = true; });
    QTimer::singleShot(warm_up + static_cast<int>(1000 * seconds), &application, &QApplication::quit);
    QApplication::exec();
    application.watching = false;
  }

  void print(const clothlab::ClothView& view, int views) const {
    std::printf("cloth %d x %d, %d view%s of %d x %d px, %.0f s\n", side, side, views, views == 1 ? "" : "s",
                view.width(), view.height(), seconds);
    std::printf("drawings per second   %8.1f\n", static_cast<double>(drawings.size()) / seconds);
    std::printf("drawing, ms           %8.2f median, %.2f lower and %.2f upper quartile\n",
                quantile(drawings, 0.5), quantile(drawings, 0.25), quantile(drawings, 0.75));
    std::printf("longest event, ms     %8.1f of %ld (type %d to %s)\n", application.longest,
                application.events, application.longest_type, application.longest_receiver);
  }
};

void bench_one(Bench& bench) {
  clothlab::MainWindow window;
  window.setAsksToSave(false);
  window.show();
  cloth::Scene scene = cloth::builtin_scene("wind");
  scene.cloth.rows = scene.cloth.columns = bench.side;
  window.document().load(scene);
  bench.watch(window.view());
  window.simulation().send(clothlab::command::Play{});
  bench.run();
  bench.print(window.view(), 1);
  const clothlab::WorkerStatus status = window.simulation().status();
  std::printf("simulation            %8.0f steps/s, %.3f x real time\n", status.steps_per_second,
              status.real_time_factor);
}

void bench_panes(Bench& bench, int panes) {
  clothlab::CompareWindow window;
  window.setAsksToSave(false);
  window.show();
  cloth::Comparison comparison{.title = {}, .scene = cloth::builtin_scene("wind"), .panes = {}};
  comparison.scene.cloth.rows = comparison.scene.cloth.columns = bench.side;
  comparison.scene.duration = 1000;
  comparison.reference = "A";
  const std::vector<std::string> methods{"verlet", "semi-implicit-euler", "rk4", "verlet"};
  comparison.panes = cloth::panes_for({methods.begin(), methods.begin() + panes});
  window.document().load(comparison);
  window.findChild<QAction*>("modeDifference")->trigger();
  for (std::size_t i = 0; i < window.panes().paneCount(); ++i) bench.watch(window.panes().pane(i).view());
  window.simulation().send(clothlab::compare_command::Play{});
  bench.run();
  bench.print(window.panes().pane(0).view(), panes);
  std::printf("simulation            %8.3f s\n", window.simulation().status().time);
}

}  // namespace

int main(int argc, char** argv) {
  TimedApplication application(argc, argv);
  QStandardPaths::setTestModeEnabled(true);
  Bench bench{
      application, argc > 1 ? std::max(2, std::atoi(argv[1])) : 128, argc > 2 ? std::atof(argv[2]) : 10, {}};
  const int panes = argc > 3 ? std::clamp(std::atoi(argv[3]), 1, 4) : 1;
  QSurfaceFormat::setDefaultFormat(clothlab::ClothView::surface_format());
  clothlab::apply_theme(application);
  if (panes == 1)
    bench_one(bench);
  else
    bench_panes(bench, panes);
  print_busiest(application, bench.seconds);
  return 0;
}

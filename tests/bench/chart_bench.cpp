// clothlab-chart-bench: what a frame of three live charts takes, drawn by Qt Charts' own series, axes and
// legends, and as Clothlab draws it. Each chart is 400 x 200 px on the raster engine; every frame has one
// more sample, a time axis that has moved on, and all points anew, decimated to the chart's width for both.
// Prints the median and the 95th percentile over the frames after a warm-up, ms of processor time; judges
// nothing.
//
//     QT_QPA_PLATFORM=offscreen clothlab-chart-bench [frames]
#include <fmt/format.h>

#include <QApplication>
#include <QChart>
#include <QGraphicsScene>
#include <QImage>
#include <QLegend>
#include <QLineSeries>
#include <QPainter>
#include <QValueAxis>
#include <cmath>
#include <functional>
#include <memory>

#include "bench_tools.h"
#include "charts/live_chart.h"
#include "theme/theme.h"

namespace clothlab {
namespace {

constexpr QSize chart_size{400, 200};
constexpr int warm_up_frames = 30;
constexpr double sample_interval = 0.01;  // s
constexpr double shown_seconds = 60;

/// `rough`: the curves swing from sample to sample, as measured times do.
ChartSample sample_at(int i, bool rough) {
  const double t = sample_interval * i, noise = rough ? std::sin(1e4 * t * t) : 0;
  return {.time_s = t,
          .kinetic_J = 5 + 4 * std::sin(3 * t) + noise,
          .elastic_J = 2 + std::sin(11 * t) + noise,
          .gravity_J = 3 - std::sin(3 * t) + noise,
          .total_J = 10 + 0.1 * std::sin(t) + noise,
          .max_strain = 0.1 + 0.02 * std::sin(5 * t) + 0.01 * noise,
          .step_ms = 1.5 + 0.1 * std::cos(97 * t) + noise,
          .draw_ms = 9 + std::sin(7 * t) + noise};
}

/// One way to draw the three charts.
struct Drawing {
  virtual ~Drawing() = default;
  virtual void update(const ChartRecord& record, Range time) = 0;
  virtual void paint(QPainter& painter) = 0;
};

/// A chart as Qt Charts is meant to be used: a line series for each curve, value axes, the legend above.
class QtChart {
 public:
  explicit QtChart(const ChartSpec& spec) : spec_(spec), chart_(new QChart), shown_(spec.curves.size()) {
    scene_.addItem(chart_);
    scene_.setSceneRect(QRectF(QPointF(), QSizeF(chart_size)));
    chart_->resize(chart_size);
    chart_->legend()->setAlignment(Qt::AlignTop);
    chart_->setAnimationOptions(QChart::NoAnimation);
    time_ = new QValueAxis;
    values_ = new QValueAxis;
    chart_->addAxis(time_, Qt::AlignBottom);
    chart_->addAxis(values_, Qt::AlignLeft);
    for (const CurveSpec& curve : spec.curves) {
      auto* series = new QLineSeries;
      series->setName(curve.name);
      series->setPen(QPen(theme().*curve.style.colour, curve.style.width));
      chart_->addSeries(series);
      series->attachAxis(time_);
      series->attachAxis(values_);
      series_.push_back(series);
    }
  }

  void update(const ChartRecord& record, Range time) {
    const int pixels = static_cast<int>(chart_->plotArea().width());
    for (std::size_t i = 0; i < series_.size(); ++i) {
      const CurveSpec& curve = spec_.curves[i];
      curve.series(record).query(curve.column, time.low, time.high, pixels, Keep::finite, points_);
      QList<QPointF>& list = shown_[i];
      list.clear();
      for (const CurvePoint& point : points_) list << QPointF(point.time_s, point.value * curve.scale);
      series_[i]->replace(list);
    }
    time_->setRange(time.low, time.high);
    values_->setRange(spec_.key == "energy" ? -1 : 0, 20);
  }
  QGraphicsScene& scene() { return scene_; }
  std::size_t points() const {
    std::size_t sum = 0;
    for (const auto& list : shown_) sum += static_cast<std::size_t>(list.size());
    return sum;
  }

 private:
  const ChartSpec& spec_;
  QGraphicsScene scene_;
  QChart* chart_;
  QValueAxis *time_, *values_;
  std::vector<QLineSeries*> series_;
  std::vector<QList<QPointF>> shown_;
  std::vector<CurvePoint> points_;
};

class QtCharts : public Drawing {
 public:
  QtCharts() {
    for (const ChartSpec& spec : chart_specs()) charts_.push_back(std::make_unique<QtChart>(spec));
  }
  void update(const ChartRecord& record, Range time) override {
    for (const auto& chart : charts_) chart->update(record, time);
  }
  void paint(QPainter& painter) override {
    for (const auto& chart : charts_)
      chart->scene().render(&painter, QRectF(QPointF(), QSizeF(chart_size)), chart->scene().sceneRect());
  }
  std::size_t points() const {
    std::size_t sum = 0;
    for (const auto& chart : charts_) sum += chart->points();
    return sum;
  }

 private:
  std::vector<std::unique_ptr<QtChart>> charts_;
};

/// The charts of the window: Qt Charts' axes and items of our own for the curves, and a head of widgets with
/// the legend, which is not drawn anew for a frame.
class OurCharts : public Drawing {
 public:
  OurCharts() {
    for (const ChartSpec& spec : chart_specs()) {
      charts_.push_back(std::make_unique<LiveChart>(spec, true));
      charts_.back()->resize(chart_size);
      charts_.back()->apply_look();
    }
  }
  void update(const ChartRecord& record, Range time) override {
    double gutter = 0;
    for (const auto& chart : charts_) gutter = std::max(gutter, chart->prepare(record, time));
    for (const auto& chart : charts_) chart->draw(record, gutter);
  }
  void paint(QPainter& painter) override {
    for (const auto& chart : charts_) {
      const QRectF whole(QPointF(), QSizeF(chart->view().size()));
      chart->scene().render(&painter, whole, whole, Qt::IgnoreAspectRatio);
    }
  }

 private:
  std::vector<std::unique_ptr<LiveChart>> charts_;
};

struct Frame {
  double update, paint, both;  // ms
};

std::vector<Frame> frames_of(Drawing& drawing, bool rough, int frames) {
  ChartRecord record;
  const int before = static_cast<int>(2 * shown_seconds / sample_interval);
  for (int i = 0; i < before; ++i) record.append(std::vector{sample_at(i, rough)});
  QImage image(chart_size, QImage::Format_ARGB32_Premultiplied);
  std::vector<Frame> taken;
  for (int i = 0; i < warm_up_frames + frames; ++i) {
    record.append(std::vector{sample_at(before + i, rough)});
    const double now = record.samples.last_time();
    image.fill(Qt::white);
    const double start = processor_time();
    drawing.update(record, {now - shown_seconds, now});
    QCoreApplication::processEvents();  // Qt Charts puts off some of its work
    const double updated = processor_time();
    QPainter painter(&image);
    painter.setRenderHint(QPainter::Antialiasing);
    drawing.paint(painter);
    painter.end();
    const double end = processor_time();
    if (i >= warm_up_frames)
      taken.push_back({1e3 * (updated - start), 1e3 * (end - updated), 1e3 * (end - start)});
  }
  return taken;
}

void print_row(const char* name, bool rough, const std::vector<Frame>& frames) {
  const auto all = [&](double Frame::*part) {
    std::vector<double> values;
    for (const Frame& frame : frames) values.push_back(frame.*part);
    return values;
  };
  fmt::print("{:<10} {:<7} {:>8.2f} {:>8.2f} {:>8.2f} {:>8.2f}\n", name, rough ? "rough" : "smooth",
             median(all(&Frame::update)), median(all(&Frame::paint)), median(all(&Frame::both)),
             quantile(all(&Frame::both), 0.95));
}

void measure(int frames) {
  fmt::print("three charts of {} x {} px, 4 + 1 + 2 curves, {} frames; ms of processor time\n\n",
             chart_size.width(), chart_size.height(), frames);
  fmt::print("{:<10} {:<7} {:>8} {:>8} {:>8} {:>8}\n", "drawn by", "curves", "update", "paint", "frame",
             "p95");
  for (const bool rough : {false, true}) {
    QtCharts qt;
    const auto frames_of_qt = frames_of(qt, rough, frames);
    print_row("Qt Charts", rough, frames_of_qt);
    OurCharts ours;
    print_row("Clothlab", rough, frames_of(ours, rough, frames));
    fmt::print("           {} points in all\n", qt.points());
  }
}

}  // namespace
}  // namespace clothlab

int main(int argc, char** argv) {
  QApplication application(argc, argv);
  clothlab::apply_theme(application, false);
  clothlab::measure(argc > 1 ? std::max(1, std::atoi(argv[1])) : 200);
}

// Connects a worker to the window's thread: a QTimer fetches frames, samples and status at the screen's rate
// and emits them as signals. The timer stops while the worker is idle.
#pragma once

#include <QObject>
#include <QTimer>

#include "bridge/compare_worker.h"
#include "bridge/simulation_worker.h"

namespace clothlab {

class WorkerLink : public QObject {
  Q_OBJECT

 protected:
  explicit WorkerLink(QObject* parent);

  /// Starts the timer; called after each command sent.
  void wake() {
    if (!timer_.isActive()) timer_.start();
  }

  /// Emits what is new. Returns false if nothing more will come until a command is sent; the timer then
  /// stops.
  virtual bool fetch() = 0;

 private:
  QTimer timer_;
};

/// The link to one kind of worker, which it owns.
template <class Worker>
class LinkTo : public WorkerLink {
 public:
  void send(typename Worker::Command command) {
    worker_.send(std::move(command));
    wake();
  }
  const typename Worker::Status& status() const { return status_; }

  /// Blocks until the commands sent so far are carried out, then emits their results. For tests and for
  /// closing.
  void settle() {
    worker_.wait_until_idle();
    fetch();
  }

 protected:
  using WorkerLink::WorkerLink;

  bool fetch() override {
    const bool more_to_come = worker_.is_busy();  // asked first: what comes after it is fetched next time
    tellFrames(worker_);
    if (const auto samples = worker_.take_samples(); !samples.empty()) tellSamples(samples);
    status_ = worker_.status();
    tellStatus(status_);
    return more_to_come;
  }
  virtual void tellFrames(Worker& worker) = 0;
  virtual void tellSamples(const std::vector<typename Worker::Sample>& samples) = 0;
  virtual void tellStatus(const typename Worker::Status& status) = 0;

 private:
  Worker worker_;
  typename Worker::Status status_;
};

class SimulationLink : public LinkTo<SimulationWorker> {
  Q_OBJECT

 public:
  explicit SimulationLink(QObject* parent = nullptr) : LinkTo(parent) {}

  void send(SceneCommand command) {
    ++sent_;
    LinkTo::send(std::move(command));
  }
  /// Whether the status already reflects every command sent.
  bool isUpToDate() const { return status().commands == sent_; }

 Q_SIGNALS:
  void frameReady(std::shared_ptr<const clothlab::ClothFrame> frame);
  void samplesReady(const std::vector<clothlab::ChartSample>& samples);
  void statusChanged(const clothlab::WorkerStatus& status);

 private:
  void tellFrames(SimulationWorker& worker) override;
  void tellSamples(const std::vector<ChartSample>& samples) override { Q_EMIT samplesReady(samples); }
  void tellStatus(const WorkerStatus& status) override { Q_EMIT statusChanged(status); }

  std::uint64_t sent_ = 0;  ///< commands
};

class CompareLink : public LinkTo<CompareWorker> {
  Q_OBJECT

 public:
  explicit CompareLink(QObject* parent = nullptr) : LinkTo(parent) {}

 Q_SIGNALS:
  /// Emitted for every pane that has a new frame.
  void frameReady(std::size_t pane, std::shared_ptr<const clothlab::ClothFrame> frame);
  void samplesReady(const std::vector<clothlab::CompareSample>& samples);
  void statusChanged(const clothlab::CompareStatus& status);

 private:
  void tellFrames(CompareWorker& worker) override;
  void tellSamples(const std::vector<CompareSample>& samples) override { Q_EMIT samplesReady(samples); }
  void tellStatus(const CompareStatus& status) override { Q_EMIT statusChanged(status); }
};

}  // namespace clothlab

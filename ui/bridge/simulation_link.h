// The simulation's worker as the window sees it.
#pragma once

#include <memory>
#include <vector>

#include "bridge/simulation_worker.h"
#include "bridge/worker_link.h"

namespace clothlab {

class SimulationLink : public WorkerLink {
  Q_OBJECT

 public:
  explicit SimulationLink(QObject* parent = nullptr);

  void send(Command command);
  const WorkerStatus& status() const { return status_; }
  /// Whether the status knows of everything that was sent.
  bool isUpToDate() const { return status_.commands == sent_; }

  /// Waits for the commands sent so far and delivers what they gave. For tests and for orderly ends.
  void settle();

 Q_SIGNALS:
  void frameReady(std::shared_ptr<const clothlab::ClothFrame> frame);
  void samplesReady(const std::vector<clothlab::ChartSample>& samples);
  void statusChanged(const clothlab::WorkerStatus& status);

 private:
  bool fetch() override;

  SimulationWorker worker_;
  WorkerStatus status_;
  std::uint64_t sent_ = 0;  ///< commands
};

}  // namespace clothlab

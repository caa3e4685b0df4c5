// The worker of a comparison as the window sees it.
#pragma once

#include "bridge/compare_worker.h"
#include "bridge/worker_link.h"

namespace clothlab {

class CompareLink : public WorkerLink {
  Q_OBJECT

 public:
  explicit CompareLink(QObject* parent = nullptr);

  void send(CompareCommand command);
  const CompareStatus& status() const { return status_; }

  /// Waits for the commands sent so far and delivers what they gave. For tests and for orderly ends.
  void settle();

 Q_SIGNALS:
  /// For every pane that has a new one.
  void frameReady(std::size_t pane, std::shared_ptr<const clothlab::ClothFrame> frame);
  void samplesReady(const std::vector<clothlab::CompareSample>& samples);
  void statusChanged(const clothlab::CompareStatus& status);

 private:
  bool fetch() override;

  CompareWorker worker_;
  CompareStatus status_;
};

}  // namespace clothlab

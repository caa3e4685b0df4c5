// Connects the worker to the window's thread: a QTimer fetches frames, samples and status at the screen's
// rate and emits them as signals. The timer stops while the worker is idle.
#pragma once

#include <QObject>
#include <QTimer>

#include "bridge/run_worker.h"

namespace clothlab {

class RunLink : public QObject {
  Q_OBJECT

 public:
  explicit RunLink(QObject* parent = nullptr);

  void send(Command command);
  const WorkerStatus& status() const { return status_; }
  /// Whether the status already reflects every command sent.
  bool isUpToDate() const { return status_.commands == sent_; }

  /// Blocks until the commands sent so far are carried out, then emits their results. For tests and for
  /// closing.
  void settle();

 Q_SIGNALS:
  /// Emitted for every pane that has a new frame; a scene is pane 0.
  void frameReady(std::size_t pane, std::shared_ptr<const clothlab::ClothFrame> frame);
  void samplesReady(const std::vector<clothlab::ChartSample>& samples);
  void paneSamplesReady(const std::vector<clothlab::CompareSample>& samples);
  void statusChanged(const clothlab::WorkerStatus& status);

 private:
  bool fetch();

  RunWorker worker_;
  std::uint64_t sent_ = 0;           ///< commands
  bool panes_wanted_ = false;        ///< the content sent last is a comparison
  std::uint64_t of_other_kind_ = 0;  ///< results before this command are of a scene where panes are wanted,
                                     ///< or of panes where a scene is, and are not fetched
  WorkerStatus status_;
  QTimer timer_;
};

}  // namespace clothlab

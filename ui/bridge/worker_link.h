// Connects the workers to the window's thread: a QTimer fetches frames, samples and status at the screen's
// rate and emits them as signals. The timer stops while the workers are idle. One worker is active, that of a
// scene or that of a comparison, by what was loaded last; the other one rests.
#pragma once

#include <QObject>
#include <QTimer>

#include "bridge/compare_worker.h"
#include "bridge/simulation_worker.h"

namespace clothlab {

class RunLink : public QObject {
  Q_OBJECT

 public:
  explicit RunLink(QObject* parent = nullptr);

  void send(Command command);
  /// Goes on with the present run, with its history: the scene as panes of a comparison, or a pane as a
  /// scene. Starts from the beginning where the run does not fit. A recording ends.
  void continueAs(const cloth::Comparison& comparison);
  void continueAs(const cloth::Scene& scene);
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
  template <class Worker>
  bool fetch_from(Worker& worker);
  template <class Content>
  void pass_on(const Content& content, const cloth::Scene& scene);
  void activate(bool comparison);
  template <class Worker>
  void send_to(Worker& worker, Command command);
  void tell(const std::vector<ChartSample>& samples) { Q_EMIT samplesReady(samples); }
  void tell(const std::vector<CompareSample>& samples) { Q_EMIT paneSamplesReady(samples); }

  SimulationWorker scene_;
  CompareWorker comparison_;
  bool compares_ = false;           ///< `comparison_` is the active one
  std::uint64_t sent_ = 0;          ///< commands to the active worker
  std::uint64_t active_since_ = 0;  ///< the number of the command that made it active; what it shows from
                                    ///< before is not wanted
  WorkerStatus status_;
  QTimer timer_;
};

}  // namespace clothlab

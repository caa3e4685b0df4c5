// The places of a run where something was done to the cloth, for the marks on the timeline.
#pragma once

#include "bridge/worker_status.h"
#include "simulation/history.h"

namespace clothlab {

/// One mark for a whole pull or gust, and one for edits of the same parameter that follow closely on each
/// other, as a dragged slider sends them. `scene` names the parameters.
std::vector<HistoryMark> marks_of(const std::vector<cloth::SessionCommand>& commands,
                                  const cloth::Scene& scene);

/// The marks of a history, made anew only when its commands have changed.
class HistoryMarks {
 public:
  std::shared_ptr<const std::vector<HistoryMark>> of(const cloth::History& history,
                                                     const cloth::Scene& scene);

 private:
  std::int64_t changes_ = -1;
  std::shared_ptr<const std::vector<HistoryMark>> marks_;
};

}  // namespace clothlab

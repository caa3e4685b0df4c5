#include "study/study_team.h"

#include <algorithm>
#include <utility>

#include "simulation/in_threads.h"

namespace cloth {
namespace {

StudyTeam::Options with_limits(StudyTeam::Options options) {
  options.jobs = std::max(1, options.jobs);
  options.at_once = options.at_once > 0 ? std::min(options.at_once, options.jobs) : options.jobs;
  return options;
}

}  // namespace

StudyTeam::StudyTeam(Options options) : options_(with_limits(std::move(options))) {}

bool StudyTeam::run(std::size_t cells, const std::function<bool(std::size_t)>& make) {
  left_ = cells;
  in_threads(cells, options_.at_once, [&](std::size_t cell) {
    if (is_stopped()) return;
    try {
      if (make(cell)) --left_;
    } catch (...) {
      stopped_ = true;
      throw;
    }
  });
  return left_ == 0;
}

int StudyTeam::threads() const {
  const auto left = static_cast<std::size_t>(std::max<std::size_t>(1, left_));
  const std::size_t at_once = std::min(static_cast<std::size_t>(options_.at_once), left);
  return options_.jobs / static_cast<int>(at_once);
}

void StudyTeam::report(const StudyProgress& progress) {
  if (options_.progress && !options_.progress(progress)) stopped_ = true;
}

}  // namespace cloth

// What is done to a running comparison, as the lines of edits.jsonl beside its recording (docs/compare.md):
//
//   {"time_s":0.3,"path":"springs.shear","value":40}             shared
//   {"time_s":0.3,"pane":"B","path":"springs.shear","value":40}  the pane's own; null: shared again
//   {"time_s":0.3,"pane":"D","copy_of":"B"}  {"time_s":0.3,"pane":"D","removed":true}
//   {"time_s":0.3,"reference":"A"}
//   {"time_s":0.3,"path":"pull","value":{...}}  and "brush"; null: let go
#pragma once

#include <string>
#include <vector>

#include "compare/comparison.h"
#include "simulation/session.h"

namespace cloth {

/// An edit at `time` (s), a line for each thing that changed. Precondition: acts_at_once(before, after).
std::vector<std::string> comparison_log_lines(const Comparison& before, const Comparison& after, double time);

/// A hand at `time` (s).
std::vector<std::string> comparison_log_lines(const SessionAction& hand, double time);

}  // namespace cloth

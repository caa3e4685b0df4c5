// Rows of the window's bench: how smoothly a simulation goes beside a running study.
#pragma once

#include <nlohmann/json.hpp>

namespace clothlab {

/// The built-in scene wind with `side` x `side` particles at real time, by turns alone and beside a
/// work-precision study, `seconds` each and `rounds` times.
nlohmann::ordered_json study_row(int side, double seconds, int rounds);
void print_study_head();
void print_study_row(const nlohmann::ordered_json& row);

}  // namespace clothlab

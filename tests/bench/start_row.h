// A row of the window's bench: what it takes until the first picture of the default scene is in the window.
#pragma once

#include <nlohmann/json.hpp>

namespace clothlab {

/// What main() of a bench does first: where the program was started by start_row(), it starts the window as
/// the program does, prints what that took, and ends. Returns the exit code, or a negative number.
int one_start(int argc, char** argv);

/// Medians over `rounds` new processes, ms of processor time of all threads since their start: until main(),
/// the application, the window, and the first picture; and of an OpenGL context with one drawing alone in a
/// process of its own, which is the machine's part.
nlohmann::ordered_json start_row(int rounds);
void print_start_row(const nlohmann::ordered_json& row);

}  // namespace clothlab

// A row of the window's bench: how soon the window answers a hand while a large cloth runs in it.
#pragma once

#include <nlohmann/json.hpp>

namespace clothlab {

/// The built-in scene wind with `side` x `side` particles, as fast as it goes. ms of wall time, median and
/// most of `rounds`: from the press on File in the menu bar until its menu has been painted, and from an
/// arrow key on the slider of the structural stiffness until the slider shows the new value.
nlohmann::ordered_json answer_row(int side, int rounds);
void print_answer_row(const nlohmann::ordered_json& row);

}  // namespace clothlab

// Rows of the window's bench: how long the window's thread is held by a comparison of many large panes.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "support/timed_application.h"

namespace clothlab {

/// `panes` cloths of `side` x `side` particles, played as fast as they go in a window of the screen's size.
nlohmann::ordered_json pane_row(TimedApplication& application, int panes, int side, const std::string& look,
                                double seconds);
void print_pane_head();
void print_pane_row(const nlohmann::ordered_json& row);

}  // namespace clothlab

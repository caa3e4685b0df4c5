// Whether a text is JSON at all, with the place where it stops being so.
#pragma once

#include <optional>
#include <string>

#include "params/problem.h"

namespace cloth {

/// Where and why `text` is not JSON, or is nested so deeply or has so many values that it cannot be a file of
/// this program; nothing if it is. `place` names the text in the message.
std::optional<Problem> syntax_problem(const std::string& text, const std::string& place);

/// A JSON text as it stands within an object: all lines but the first two spaces deeper, no line end behind.
std::string indented_json(const std::string& text);

}  // namespace cloth

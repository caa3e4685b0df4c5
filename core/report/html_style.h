// The style sheet of reports.
#pragma once

#include <string>

namespace cloth {

/// Light and dark, screen and paper; with the dark colours of inline drawings.
std::string html_style();

}  // namespace cloth

// A speed report as text, Markdown and JSON.
#pragma once

#include <string>

#include "bench/speed/speed_study.h"

namespace cloth::speed {

std::string speed_text(const SpeedReport& report);
std::string speed_markdown(const SpeedReport& report);

/// bench.json
std::string speed_json(const SpeedReport& report);

}  // namespace cloth::speed

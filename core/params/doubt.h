// Values that are accepted although they are beyond all sense for a cloth.
#pragma once

#include <optional>
#include <string>

#include "params/parameter.h"

namespace cloth {

/// Why an accepted value makes no sense, as a sentence without a full stop, or nothing.
std::optional<std::string> doubt_about(const ParameterInfo& info, const ParameterValue& value);

}  // namespace cloth

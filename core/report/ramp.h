// Colours for values from low to high: from blue over purple to orange, which colour-blind readers tell apart
// too, and lighter towards the high end on dark paper.
#pragma once

#include <vector>

#include "report/palette.h"

namespace cloth {

/// "ramp0", the lowest, to "ramp6"; each at least 3 : 1 against the surface of its scheme.
const std::vector<PageColour>& ramp_colours();

/// The class of a value in [low, high], 0 to 6.
std::size_t ramp_class(double value, double low, double high);

}  // namespace cloth

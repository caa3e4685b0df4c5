// What the view shows and what the left mouse button does in it.
#pragma once

namespace clothlab {

enum class ViewMode { textured, wireframe, strain };
enum class Tool { pull, brush, pin, probe };

}  // namespace clothlab

// What this program is: its version, licence, and the machine that it runs on.
#pragma once

#include <QString>

namespace clothlab {

/// As HTML: versions of Clothlab, Qt, OpenGL and the compiler, processor and instruction set. Asks OpenGL for
/// its name.
QString about_page();

}  // namespace clothlab

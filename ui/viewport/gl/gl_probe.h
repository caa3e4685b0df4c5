// What the machine's OpenGL can do, found out once with a throw-away context before any widget relies on it.
#pragma once

#include <QString>

namespace clothlab {

struct GlAbilities {
  bool usable = false;    ///< OpenGL 3.3 core or later
  bool software = false;  ///< drawn by the processor (Mesa's llvmpipe and the like)
  QString renderer;       ///< the driver's own name
  QString version;        ///< the driver's own text
  QString problem;        ///< why it is not usable, in words for a person
};

/// Needs a QGuiApplication. Asked once per process, on the GUI thread.
const GlAbilities& gl_abilities();

}  // namespace clothlab

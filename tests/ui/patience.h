// How long a test waits for what has to come: on a busy machine the window manager alone may take seconds.
#pragma once

namespace clothlab::test {

inline constexpr int patience = 30000;  // ms

}  // namespace clothlab::test

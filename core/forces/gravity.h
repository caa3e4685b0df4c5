// The energy of gravity, Eq. (3) of the report: F_i = m_i g. The force itself is in gravity.cpp.
#pragma once

#include "cloth/cloth_system.h"

namespace cloth {

/// -sum m g . (x - x(0)), in J, for `acceleration` g in m/s^2.
double gravity_energy(const ClothSystem& system, const Vec3& acceleration, const Vec3Field& position);

}  // namespace cloth

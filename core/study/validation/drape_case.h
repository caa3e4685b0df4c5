// Cusick's drape test (Cusick 1968; ISO 9073-9) of a material on a grid: a round specimen of 15 cm radius on
// a disc of 9 cm, at rest.
#pragma once

#include <cstdint>
#include <string>

#include "measure/drape.h"
#include "measure/oblique_locking.h"
#include "scene/scene.h"
#include "simulation/rest_shape.h"
#include "study/study_progress.h"

namespace cloth {

inline constexpr double specimen_radius = 0.15, drape_disc_radius = 0.09;  // m

/// `cells`: across the specimen's diameter. It lies level around the origin, gravity along -y.
Scene drape_scene(const Material& material, int cells);

struct DrapeReading {
  Drape drape;
  ObliqueLocking locking;
  RestShape rest;
  bool is_minimum = false;  ///< the energy rises in every direction; of an elastic cloth
  std::string failure{};    ///< why there is no rest; empty: there is one
};

/// The rest that is found from the flat specimen, whose free particles were moved up or down at random by up
/// to 2 mm. A flat cloth is in equilibrium with its weight along every fold alike: other seeds lead to other
/// rests.
DrapeReading measure_drape_of(const Material& material, int cells, std::uint64_t seed,
                              const StopTest& stop = {});

}  // namespace cloth

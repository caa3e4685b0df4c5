// What may help a run that diverged: edits of the scene, to be followed by a restart.
#pragma once

#include <QString>
#include <utility>
#include <vector>

#include "params/parameter.h"
#include "scene/scene.h"
#include "simulation/outcome.h"

namespace clothlab {

struct Remedy {
  QString text;                                                      ///< of a button: "Use auto and restart"
  std::vector<std::pair<std::string, cloth::ParameterValue>> edits;  ///< a parameter's path and new value
};

/// For `scene` as it is now, which may have been edited since it diverged: first a shorter time step, then
/// another method. The step and the method that failed are never among them. None for a pinched cloth.
std::vector<Remedy> remedies_for(const cloth::Scene& scene, const cloth::Divergence& divergence);

}  // namespace clothlab

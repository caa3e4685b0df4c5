// What a fuzz target runs beyond the reader: only what takes milliseconds.
#pragma once

#include <string>

#include "scene/scene.h"

namespace cloth::test {

/// Whether what is made of a scene's JSON text stays small: no cloth of more than some thousand particles.
/// True for what is no scene at all.
bool stays_small(const std::string& json_text);

/// Assembles the scene and takes a few steps, if it is one of few particles and steps that are bounded in
/// time. Bad numerics are data: nothing is expected of the motion.
void take_few_steps(const Scene& scene);

}  // namespace cloth::test

// Whether a study is the one that an order would make.
#pragma once

#include "bridge/study_runner.h"

namespace clothlab {

/// Whether the study has the scene and the options of the order, whatever its folder.
bool has_inputs(const cloth::StudyTable& table, const StudyOrder& order);

}  // namespace clothlab

// What an edit of a scene changes, and how a running simulation applies it.
#pragma once

#include <QString>
#include <string>
#include <vector>

#include "scene/scene_parameters.h"

namespace clothlab {

/// How a running simulation applies an edit, from ParameterInfo::cost: a live edit before the next step, a
/// restart by starting again at t = 0. Adding or removing a block is a restart if an edit of one of its
/// parameters is.
struct SceneChange {
  /// `none`: the run already has the change, see LabDocument::follow().
  enum class Effect { none, live, restart } effect = Effect::live;
  std::string path;  ///< of the parameter or block; "cloth.pins" for pins; empty after follow() and for panes
};

SceneChange::Effect effect_of(cloth::EditCost cost);
SceneChange::Effect effect_of(const cloth::Block& block);
/// Of all parameters in which the scenes differ.
SceneChange::Effect effect_between(const cloth::Scene& before, const cloth::Scene& after);

std::optional<cloth::Block> find_block(const cloth::Scene& scene, const std::string& path);
/// The block that `after` has and `before` has not.
std::optional<cloth::Block> added_block(const cloth::Scene& before, const cloth::Scene& after);
/// Whether a form of both scenes has the same rows.
bool have_same_rows(const cloth::Scene& one, const cloth::Scene& other);
/// The parameters that both scenes have, with different values.
std::vector<std::string> differing_parameters(const cloth::Scene& before, const cloth::Scene& after);

/// "must be ..." if the value is of another type than the parameter's.
QString broken_kind(const cloth::ParameterInfo& info, const cloth::ParameterValue& value);

/// A label inside a sentence: "Structural stiffness" -> "structural stiffness"; abbreviations keep their
/// capitals.
QString in_sentence(const std::string& label);

}  // namespace clothlab

Q_DECLARE_METATYPE(clothlab::SceneChange)

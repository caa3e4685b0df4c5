#include "document/scene_change.h"

#include <algorithm>

namespace clothlab {

using cloth::Block;
using cloth::Kind;
using cloth::Parameter;
using cloth::Scene;
using Effect = SceneChange::Effect;

Effect effect_of(cloth::EditCost cost) {
  return cost == cloth::EditCost::restart ? Effect::restart : Effect::live;
}

Effect effect_of(const Block& block) {
  const bool restart = std::any_of(block.parameters.begin(), block.parameters.end(), [](const Parameter& p) {
    return p.info.cost == cloth::EditCost::restart;
  });
  return restart ? Effect::restart : Effect::live;
}

Effect effect_between(const Scene& before, const Scene& after) {
  Effect effect = Effect::live;
  for (const std::string& path : differing_parameters(before, after))
    effect = std::max(effect, effect_of(find_parameter(after, path)->info.cost));
  return effect;
}

std::optional<Block> find_block(const Scene& scene, const std::string& path) {
  for (Block& block : blocks_of(scene))
    if (block.path == path) return std::move(block);
  return std::nullopt;
}

std::optional<Block> added_block(const Scene& before, const Scene& after) {
  for (Block& block : blocks_of(after))
    if (!find_block(before, block.path)) return std::move(block);
  return std::nullopt;
}

bool have_same_rows(const Scene& one, const Scene& other) {
  const auto rows_of = [](const Scene& scene) {
    std::vector<std::string> rows;
    for (const Block& block : blocks_of(scene)) {
      rows.push_back(block.path + " " + block.title);
      for (const Parameter& parameter : block.parameters) rows.push_back(parameter.path);
    }
    return rows;
  };
  return rows_of(one) == rows_of(other);
}

std::vector<std::string> differing_parameters(const Scene& before, const Scene& after) {
  const std::vector<Parameter> old_parameters = parameters_of(before);
  std::vector<std::string> paths;
  for (const Parameter& parameter : parameters_of(after)) {
    const auto same = std::find_if(old_parameters.begin(), old_parameters.end(),
                                   [&](const Parameter& old) { return old.path == parameter.path; });
    if (same != old_parameters.end() && same->get(before) != parameter.get(after))
      paths.push_back(parameter.path);
  }
  return paths;
}

QString broken_kind(const cloth::ParameterInfo& info, const cloth::ParameterValue& value) {
  if (info.auto_allowed && value == cloth::ParameterValue(std::string("auto"))) return {};
  const auto unless = [](bool holds, const char* rule) {
    return holds ? QString() : QString::fromLatin1(rule);
  };
  switch (info.kind) {
    case Kind::number:
      return unless(std::holds_alternative<double>(value), "must be a number");
    case Kind::integer:
      return unless(std::holds_alternative<std::int64_t>(value), "must be a whole number");
    case Kind::vector:
      return unless(std::holds_alternative<cloth::Vec3>(value), "must be three numbers");
    case Kind::choice:
    case Kind::text:
      return unless(std::holds_alternative<std::string>(value), "must be a text");
    case Kind::words:
      return unless(std::holds_alternative<cloth::Words>(value), "must be a list of words");
  }
  return {};
}

QString in_sentence(const std::string& label) {
  QString text = QString::fromStdString(label);
  if (text.size() > 1 && text[1].isLower()) text[0] = text[0].toLower();
  return text;
}

}  // namespace clothlab

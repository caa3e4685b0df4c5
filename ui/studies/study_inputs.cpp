#include "studies/study_inputs.h"

#include "study/refined_scene.h"

namespace clothlab {
namespace {

std::vector<std::string> names_of(const std::vector<cloth::MethodStudy>& methods) {
  std::vector<std::string> names;
  for (const cloth::MethodStudy& method : methods) names.push_back(method.ladder.facts.name);
  return names;
}

bool is_same(const cloth::StudyAxis& a, const cloth::StudyAxis& b) {
  return a.path == b.path && a.low == b.low && a.high == b.high && a.count == b.count && a.scale == b.scale;
}

bool has_inputs(const cloth::WorkPrecision& study, const cloth::Scene& given,
                const cloth::WorkPrecisionOptions& options) {
  const cloth::Scene scene = cloth::studied_scene(given);
  return study.scene == scene && names_of(study.methods) == options.methods &&
         study.repeats == options.repeats &&
         study.horizon == options.horizon.value_or(cloth::default_horizon(scene));
}

bool has_inputs(const cloth::StabilityMap& map, const cloth::Scene& scene,
                const cloth::StabilityOptions& options) {
  return map.scene == scene && map.options.methods == options.methods &&
         map.options.criterion.periods == options.criterion.periods && is_same(map.options.x, options.x) &&
         is_same(map.options.y, options.y);
}

bool has_inputs(const cloth::GridConvergence& study, const cloth::Scene& scene,
                const cloth::GridConvergenceOptions& options) {
  const cloth::GridConvergence plan = cloth::plan_grid_convergence(scene, options);
  return study.scene == plan.scene && study.cells == plan.cells && study.outputs == plan.outputs;
}

bool has_inputs(const cloth::ExtremesTable& table, const cloth::Scene&,
                const cloth::ExtremesOptions& options) {
  return table.scene == options.scene && table.methods == options.methods;
}

bool has_inputs(const cloth::ValidationStudy& study, const cloth::Scene&,
                const cloth::ValidationOptions& options) {
  return study.protocols == options.protocols;
}

bool has_inputs(const cloth::IterationsStudy& study, const cloth::Scene& scene,
                const cloth::IterationsOptions& options) {
  const cloth::IterationsStudy plan = cloth::plan_iterations_study(scene, options);
  return study.scene == plan.scene && study.asked == plan.asked && study.asked_time == plan.asked_time &&
         study.most == plan.most;
}

}  // namespace

bool has_inputs(const cloth::StudyTable& table, const StudyOrder& order) {
  return std::visit(
      [&order](const auto& shown, const auto& options) {
        if constexpr (requires { has_inputs(shown, order.scene, options); })
          return has_inputs(shown, order.scene, options);
        return false;  // another kind
      },
      table, order.options);
}

}  // namespace clothlab

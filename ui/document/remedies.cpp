#include "document/remedies.h"

#include <QCoreApplication>

#include "simulation/time_step.h"

namespace clothlab {
namespace {

constexpr char step_path[] = "integrator.time_step", method_path[] = "integrator.method";
constexpr double clearly_shorter = 0.99;
const std::string automatic = "auto";

/// Implicit Euler: its damping grows with stiffness and step, and nothing swings up.
const std::string steadiest_method = "implicit-euler";

QString words(const char* text) {
  return QCoreApplication::translate("clothlab::Remedy", text);
}

cloth::Scene with_automatic_step(cloth::Scene scene) {
  scene.integrator.time_step.reset();
  return scene;
}

Remedy shorter_step(const cloth::Scene& scene, double failed) {
  const double present = cloth::resolved_time_step(scene).value_or(failed);
  const double by_auto = cloth::resolved_time_step(with_automatic_step(scene)).value_or(failed);
  const double short_enough = clearly_shorter * failed;
  if (present < short_enough && (present <= by_auto || by_auto >= short_enough))
    return {words("Restart with the shorter step"), {}};
  if (by_auto < short_enough) return {words("Use auto and restart"), {{step_path, automatic}}};
  return {words("Halve the time step and restart"), {{step_path, 0.5 * failed}}};
}

}  // namespace

std::vector<Remedy> remedies_for(const cloth::Scene& scene, const cloth::Divergence& divergence) {
  std::vector<Remedy> remedies;
  if (divergence.pinched) return remedies;
  if (divergence.stable_step > 0 || divergence.solver_failed)
    remedies.push_back(shorter_step(scene, divergence.time_step));
  if (scene.integrator.method != steadiest_method)
    remedies.push_back(
        {words("Use implicit Euler and restart"), {{method_path, steadiest_method}, {step_path, automatic}}});
  return remedies;
}

}  // namespace clothlab

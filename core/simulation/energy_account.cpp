#include "simulation/energy_account.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "simulation/simulation.h"

namespace cloth {
namespace {

constexpr double rounding = 1e-12;  // of the largest energy

/// std::max loses a NaN; a run that has one must not look better for it.
void raise(double& largest, double value) {
  if (!(value <= largest)) largest = value;
}

}  // namespace

void EnergyAccount::add(const Measurement& m) {
  const std::array energies{m.energy.kinetic, m.energy.elastic, m.energy.gravity};
  if (rows_++ == 0) first_ = energies;
  error_ = m.energy_error();
  raise(largest_error_, std::abs(error_));
  raise(largest_error_, std::abs(error_ + std::max(0.0, m.ledger.limiter)));
  for (std::size_t k = 0; k < energies.size(); ++k) {
    raise(exchanged_, std::abs(energies[k] - first_[k]));
    raise(largest_energy_, std::abs(energies[k]));
  }
  const Work& forces = m.ledger.forces;
  for (const double work :
       {forces.damping_loss, forces.hysteresis_loss, forces.air, forces.brush, forces.pull, m.ledger.limiter, m.ledger.contact}) {
    raise(exchanged_, std::abs(work));
    raise(largest_energy_, std::abs(work));
  }
}

double EnergyAccount::share() const {
  if (largest_error_ <= rounding * largest_energy_) return 0;
  return largest_error_ / exchanged_;
}

std::string describe(const EnergyAccount& account) {
  if (!account.is_doubtful()) return "";
  return fmt::format(
      "energy is not accounted for: an error of up to {:.3g} J, {:.3g} % of the {:.3g} J that were exchanged "
      "(trusted up to {:.3g} %); a shorter time step or another method would tell what of this motion is "
      "real",
      account.largest_error(), 100 * account.share(), account.exchanged(),
      100 * EnergyAccount::doubtful_share);
}

}  // namespace cloth

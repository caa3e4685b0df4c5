// Watches the energy account of a run and warns when its error is too large. The run may go back to an
// earlier step.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "simulation/energy_account.h"
#include "simulation/simulation.h"

namespace clothlab {

class EnergyWatch {
 public:
  /// Adds a measurement; its step is later than those of all rows so far.
  void add(const cloth::Measurement& measurement);
  /// Deletes the rows after a step, because the run continues differently from there.
  void cut(std::int64_t step);
  /// The warning for the user. Empty while the account closes, and in the first rows, where almost no energy
  /// was exchanged. The text changes only when the error's share has doubled.
  const std::string& notice() const { return notice_; }

 private:
  struct Row {
    std::int64_t step = 0;
    cloth::EnergyAccount account;
  };

  std::int64_t rows_ = 0, stride_ = 1;
  cloth::EnergyAccount account_;
  std::vector<Row> kept_;  ///< every stride_-th row, for cut()
  std::string notice_;
  double said_share_ = 0;
};

}  // namespace clothlab

// The account of the energy of a run that one may go back in: what it says when its error is too large.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "simulation/energy_account.h"
#include "simulation/simulation.h"

namespace clothlab {

class EnergyWatch {
 public:
  /// A row later than all before it.
  void add(const cloth::Measurement& measurement);
  /// Forgets the rows after a step: something else happens there now.
  void cut(std::int64_t step);
  /// Empty while the account closes, and in the first rows, where next to nothing was exchanged. Changes only
  /// where the error has grown to twice its share.
  const std::string& notice() const { return notice_; }

 private:
  struct Row {
    std::int64_t step = 0;
    cloth::EnergyAccount account;
  };

  std::int64_t rows_ = 0, stride_ = 1;
  cloth::EnergyAccount account_;
  std::vector<Row> kept_;  ///< every stride_th row, to go back to
  std::string notice_;
  double said_share_ = 0;
};

}  // namespace clothlab

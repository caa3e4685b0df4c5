// Rates the error of the energy ledger by the energies that the motion exchanged.
#pragma once

#include <array>
#include <cstdint>
#include <string>

namespace cloth {

struct Measurement;

/// Collects the rows of a run. The error of a row is total energy - that at the start - works + losses; a
/// deformation rate that is kept only ever takes energy, so that what the limiter has given in sum is an
/// error too. What was exchanged is the largest that the kinetic, elastic or potential energy has changed by
/// since the first row, or that any one work or loss of the ledger has come to.
class EnergyAccount {
 public:
  /// Above this part of the energy exchanged a run reports that its motion is not reliable.
  static constexpr double doubtful_share = 0.05;

  void add(const Measurement& measurement);

  double error() const { return error_; }                  ///< J, of the last row
  double largest_error() const { return largest_error_; }  ///< J, without its sign, of all rows
  double exchanged() const { return exchanged_; }          ///< J
  /// largest_error() / exchanged(); 0 where the error is rounding.
  double share() const;
  bool is_doubtful() const { return !(share() <= doubtful_share); }
  /// The same while the run goes on: not yet in its first rows, where next to nothing was exchanged.
  bool is_doubtful_so_far() const { return rows_ > first_rows && is_doubtful(); }

 private:
  static constexpr std::int64_t first_rows = 10;

  std::int64_t rows_ = 0;
  std::array<double, 3> first_{};  ///< J: kinetic, elastic, potential energy of the first row
  double error_ = 0, largest_error_ = 0, exchanged_ = 0;
  double largest_energy_ = 0;  ///< J, what rounding is measured by
};

/// One sentence for a run whose account is doubtful; empty for any other.
std::string describe(const EnergyAccount& account);

}  // namespace cloth

// Ours and other libraries' solvers on the linear systems of implicit Euler, to the same relative residual,
// one thread, timed in turns, phase by phase.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "bench/solvers/newton_system.h"
#include "bench/speed/interleaved_timing.h"
#include "io/machine.h"

namespace cloth::solvers {

/// Medians and quartiles in ms of processor time; zeros where a solver has no such phase.
struct SolverRow {
  std::string name, library;  ///< library empty: ours
  int iterations = 0;         ///< of an iterative solve
  double residual = 0;        ///< |b - A x| / |b| that was reached
  speed::Spread analysis, conversion, set_up, solve;
  std::string failure;  ///< not empty: no times

  bool is_ours() const { return library.empty(); }
  /// What one system costs once the pattern is known and its numbers are where the solver wants them, in ms.
  double whole() const { return set_up.median + solve.median; }
};

struct SolverTable {
  ClothShape shape = ClothShape::smooth;
  int size = 0;
  int iteration = 0;  ///< of Newton's method that the system is of
  bool is_exact = true;
  double compressed_part = 0;  ///< of all springs
  int unknowns = 0;
  std::vector<SolverRow> rows;

  /// The cheapest of ours by whole(); none where all failed.
  const SolverRow* best_of_ours() const;
};

struct SolverOptions {
  std::vector<int> sizes{33, 65, 129};
  double residual = 1e-6;
  int repeats = 7;
  bool quick = false;
  /// Asked before every sample; false ends the study, and what is finished is kept.
  std::function<bool(double fraction, const std::string& text)> progress = {};
  /// The report so far, after every system.
  std::function<void(const struct SolverReport&)> partial = {};
};

struct SolverReport {
  MachineFacts machine;
  bool complete = false;
  double residual = 0;
  int repeats = 0;
  std::vector<std::string> missing;  ///< packages without which this program was built
  std::vector<SolverTable> tables;
};

/// What this program was built without, as Debian's packages.
std::vector<std::string> missing_libraries();

SolverReport study_solvers(const SolverOptions& options);

std::string solver_text(const SolverReport& report, bool markdown);
/// The head of that text, and the part of one system.
std::string solver_head(const SolverReport& report, bool markdown);
std::string solver_text(const SolverTable& table, bool markdown);
std::string solver_json(const SolverReport& report);

}  // namespace cloth::solvers

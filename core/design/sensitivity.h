// What an output depends on, from the outputs of a design's rows: Morris' elementary effects and Sobol'
// indices. Outputs stand in the order of the rows of unit_design (design.h); one that is not finite is a
// failed run.
//
//     const UnitPoints rows = unit_design(Design::saltelli, n, k, seed);
//     const SobolIndices found = sobol_indices(outputs_at(rows), k);
//     found.parameters[0].first.value   // with .low and .high
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "design/design.h"

namespace cloth {

/// A value with the ends of its 95 % interval: the 2.5 % and 97.5 % quantiles of what 1000 samples drawn from
/// the sample with replacement give (Efron 1979). Not numbers where there are too few rows.
struct Estimate {
  double value = 0, low = 0, high = 0;
};

struct MorrisEffect {
  double mu = 0;            ///< mean of the elementary effects
  Estimate mu_star{};       ///< mean of their magnitudes (Campolongo, Cariboni and Saltelli 2007)
  double sigma = 0;         ///< their standard deviation: effects that differ, by interactions or curvature
  std::size_t effects = 0;  ///< that were had
};

struct MorrisScreening {
  std::vector<MorrisEffect> parameters;
  std::size_t trajectories = 0, failed = 0;  ///< `failed`: runs; each takes the effects on both sides out
};

/// The effect of a parameter: the change of the output over the whole range of the parameter, if it went on
/// as over a step of 2/3 of the range (Morris 1991). `points` are the rows of Design::morris, `outputs` one
/// number for each; rows at the end that miss are those of trajectories not yet run.
MorrisScreening morris_screening(const UnitPoints& points, std::span<const double> outputs,
                                 std::uint64_t seed = 1);

struct SobolIndex {
  Estimate first;  ///< S: the part of the variance that the parameter makes alone
  Estimate total;  ///< ST: the part that it makes alone and with others
};

struct SobolIndices {
  std::vector<SobolIndex> parameters;
  double mean = 0, variance = 0;         ///< of the output, over A and B
  std::size_t rows = 0;                  ///< of A that are used
  std::size_t failed = 0, left_out = 0;  ///< failed runs, and the rows of A that they took out
};

/// S = mean(f_B (f_AB - f_A))/V (Saltelli et al. 2010), with the mean taken from f_B, and
/// ST = mean((f_A - f_AB)^2)/(2 V) (Jansen 1999). `outputs`: of the rows of Design::saltelli for so many
/// dimensions; rows at the end that miss are those not yet run. Not numbers where fewer than two rows are
/// left or the output does not vary.
SobolIndices sobol_indices(std::span<const double> outputs, std::size_t dimensions, std::uint64_t seed = 1);

}  // namespace cloth

// What values on finer and finer grids say of the value on a grid without end: differences, observed order,
// Richardson's extrapolation and the grid convergence index (Richardson 1911; Roache 1994; for any ratio of
// refinement Celik et al. 2008). No order is claimed where the differences do not shrink.
//
//     const Richardson found = richardson({{0.1, 1.25}, {0.05, 1.0625}, {0.025, 1.015625}});
//     // found.order 2, found.extrapolate 1, found.band 0.01953125
#pragma once

#include <string>
#include <vector>

namespace cloth {

/// A quantity as one grid gives it.
struct GridValue {
  double cell = 0;   ///< m, more than 0
  double value = 0;  ///< any unit, finite
};

enum class GridVerdict {
  converging,   ///< the last three differences fit a power law with an order above 0
  oscillating,  ///< they shrink, but change their sign
  diverging,    ///< they do not shrink, or more slowly than any power of the cells' size
  unchanged,    ///< the finest two values are the same but for rounding
  two_grids,    ///< an order has to be assumed
  too_few       ///< less than two grids
};

/// As files have it.
inline constexpr const char* grid_verdict_names[] = {"converging", "oscillating", "diverging",
                                                     "unchanged",  "two-grids",   "too-few"};
inline const char* name_of(GridVerdict verdict) {
  return grid_verdict_names[static_cast<std::size_t>(verdict)];
}

/// Roache's factors: three grids or more, and fewer.
inline constexpr double gci_safety = 1.25, gci_safety_of_two = 3;

/// Two successive observed orders that differ by no more are in the asymptotic range.
inline constexpr double order_slack = 0.2;

struct Richardson {
  GridVerdict verdict = GridVerdict::too_few;
  std::vector<double> differences;  ///< of each grid from the coarser one before it
  std::vector<double> orders;       ///< of each three successive grids; not a number where they show none
  // What follows is not a number where it is not known.
  double order = 0;        ///< of the finest three; of two grids the assumed one
  double extrapolate = 0;  ///< to cells without size
  double band = 0;   ///< error of the finest value, with the safety factor: the index in the values' unit
  double index = 0;  ///< the grid convergence index: `band` over the finest value's size
  double safety = 0;
  /// Of the coarser of the last two successive differences over what the power law of the finest three says
  /// of it: 1 in the asymptotic range. Needs four grids.
  double range_ratio = 0;
  bool is_asymptotic = false;  ///< the last two observed orders agree to order_slack, and are at least 1/2
  std::string words;           ///< one sentence or two
};

/// The order p of f = f_0 + C cell^p through three values, from the equation of Celik et al. 2008:
/// d_32/d_21 = r_21^p (r_32^p - 1)/(r_21^p - 1). Its right side rises with p from 0 to infinity, so that
/// there is exactly one where both differences have one sign; not a number where they have not. May be
/// negative.
double observed_order(const GridValue& coarse, const GridValue& middle, const GridValue& fine);

/// From the coarsest grid to the finest, cells smaller from one to the next. `formal_order` is assumed where
/// there are two grids, and is the most that the index believes of an observed one (Oberkampf and Roy 2010).
Richardson richardson(const std::vector<GridValue>& grids, double formal_order = 2);

}  // namespace cloth

// Zeros of Bessel functions: critical loads of heavy strips and the frequencies of a hanging chain.
#pragma once

namespace cloth::exact {

/// The least positive zero of J_order, order > -1, by its power series (Abramowitz and Stegun 1964, 9.1.10).
double first_bessel_zero(double order);

}  // namespace cloth::exact

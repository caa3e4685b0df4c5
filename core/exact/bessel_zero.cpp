#include "exact/bessel_zero.h"

#include <cmath>

#include "exact/elastica.h"

namespace cloth::exact {

double first_bessel_zero(double order) {
  // J_order(x) over its leading term: the sum of (-x^2/4)^k/(k! (order + 1)...(order + k)).
  const auto value = [&](double x) {
    double sum = 1, term = 1;
    for (int k = 1; k < 100 && std::abs(term) > 1e-18; ++k) sum += term *= -x * x / 4 / (k * (order + k));
    return sum;
  };
  double high = 0.1;
  while (value(high) > 0) high += 0.1;
  return root_between(value, high - 0.1, high);
}

}  // namespace cloth::exact

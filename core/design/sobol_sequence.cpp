#include "design/sobol_sequence.h"

#include <boost/random/sobol.hpp>

#include "design/random_choice.h"

namespace cloth {

UnitPoints sobol_sequence(std::size_t count, const std::vector<std::uint64_t>& shifts) {
  const std::size_t dimensions = shifts.size();
  UnitPoints points(count, UnitPoint(dimensions));
  boost::random::sobol engine(dimensions);  // begins with the second point: the first is 0
  for (std::size_t i = 0; i < count; ++i)
    for (std::size_t j = 0; j < dimensions; ++j)
      points[i][j] = unit_number((i == 0 ? 0 : engine()) ^ shifts[j]);
  return points;
}

std::vector<std::uint64_t> digital_shifts(std::size_t dimensions, std::uint64_t seed) {
  SplitMix random(seed);
  std::vector<std::uint64_t> shifts(dimensions);
  for (std::uint64_t& shift : shifts) shift = random.bits();
  return shifts;
}

}  // namespace cloth

#include "design/latin_hypercube.h"

#include <algorithm>
#include <limits>

#include "design/random_choice.h"

namespace cloth {
namespace {

constexpr std::size_t most_tries = 50, most_pairs = 200'000'000;

/// One point in each of `count` slices of every dimension.
UnitPoints random_hypercube(SplitMix& random, std::size_t count, std::size_t dimensions) {
  UnitPoints points(count, UnitPoint(dimensions));
  for (std::size_t j = 0; j < dimensions; ++j) {
    const std::vector<std::size_t> slices = random_order(random, count);
    for (std::size_t i = 0; i < count; ++i) {
      const double place = static_cast<double>(slices[i]) + unit_number(random.bits());
      points[i][j] = std::min(place / static_cast<double>(count), 1 - 0x1p-53);
    }
  }
  return points;
}

double squared_distance(const UnitPoint& a, const UnitPoint& b) {
  double sum = 0;
  for (std::size_t j = 0; j < a.size(); ++j) sum += (a[j] - b[j]) * (a[j] - b[j]);
  return sum;
}

}  // namespace

double closest_pair(const UnitPoints& points, double enough) {
  std::vector<const UnitPoint*> sorted;  // by the first number: only near ones need a look
  for (const UnitPoint& point : points) sorted.push_back(&point);
  std::sort(sorted.begin(), sorted.end(), [](auto* a, auto* b) { return *a < *b; });
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < sorted.size(); ++i)
    for (std::size_t k = i + 1; k < sorted.size(); ++k) {
      const double along = (*sorted[k])[0] - (*sorted[i])[0];
      if (along * along >= least) break;
      least = std::min(least, squared_distance(*sorted[i], *sorted[k]));
      if (least < enough) return least;
    }
  return least;
}

UnitPoints latin_hypercube(std::size_t count, std::size_t dimensions, std::uint64_t seed) {
  SplitMix random(seed);
  const std::size_t tries =
      std::clamp<std::size_t>(most_pairs / std::max<std::size_t>(count * count, 1), 1, most_tries);
  UnitPoints best = random_hypercube(random, count, dimensions);
  double apart = tries > 1 ? closest_pair(best) : 0;
  for (std::size_t k = 1; k < tries; ++k) {
    UnitPoints points = random_hypercube(random, count, dimensions);
    const double distance = closest_pair(points, apart);
    if (distance <= apart) continue;
    apart = distance;
    best = std::move(points);
  }
  return best;
}

}  // namespace cloth

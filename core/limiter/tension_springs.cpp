#include "limiter/tension_springs.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <limits>

namespace cloth {
namespace {

constexpr std::size_t no_spring = std::numeric_limits<std::size_t>::max();

/// Cosine of the angle at which one spring may follow another in a line: at most 60 degrees from straight.
constexpr double straight_enough = -0.5;

/// The spring that follows in the line at each spring's first and second end.
using Followers = std::vector<std::array<std::size_t, 2>>;

struct Junction {
  double cosine;     ///< of the angle between the two springs, -1: straight on
  std::size_t a, b;  ///< springs
};

std::size_t end_at(const TensionSpring& spring, std::size_t particle) {
  return spring.first == particle ? 0 : 1;
}

/// At every particle the straightest pair of springs is joined first, then the straightest of the rest, and
/// so on.
Followers followers_of(std::span<const TensionSpring> springs, const ClothSystem& system) {
  std::vector<std::vector<std::size_t>> around(system.pinned.size());
  for (std::size_t s = 0; s < springs.size(); ++s) {
    around[springs[s].first].push_back(s);
    around[springs[s].second].push_back(s);
  }
  Followers followers(springs.size(), {no_spring, no_spring});
  std::vector<Junction> meetings;
  for (std::size_t particle = 0; particle < around.size(); ++particle) {
    const std::vector<std::size_t>& here = around[particle];
    const auto away = [&](std::size_t s) {
      const TensionSpring& spring = springs[s];
      const std::size_t other = spring.first == particle ? spring.second : spring.first;
      return Vec3((system.start[other] - system.start[particle]) / spring.rest_length);
    };
    meetings.clear();
    for (std::size_t k = 0; k < here.size(); ++k)
      for (std::size_t l = k + 1; l < here.size(); ++l) {
        const double cosine = away(here[k]).dot(away(here[l]));
        if (cosine < straight_enough) meetings.push_back({cosine, here[k], here[l]});
      }
    std::stable_sort(meetings.begin(), meetings.end(),
                     [](const Junction& m, const Junction& n) { return m.cosine < n.cosine; });
    for (const Junction& meeting : meetings) {
      std::size_t& after_a = followers[meeting.a][end_at(springs[meeting.a], particle)];
      std::size_t& after_b = followers[meeting.b][end_at(springs[meeting.b], particle)];
      if (after_a != no_spring || after_b != no_spring) continue;
      after_a = meeting.b, after_b = meeting.a;
    }
  }
  return followers;
}

}  // namespace

bool is_limited(const Deformation& deformation, SpringFamily family) {
  return std::find(deformation.springs.begin(), deformation.springs.end(), name_of(family)) !=
         deformation.springs.end();
}

std::vector<SpringRun> limited_runs(const Deformation& deformation, const ClothSystem& system) {
  std::vector<SpringRun> limited;
  for (const SpringRun& run : system.springs)
    if (is_limited(deformation, run.family) && run.rest_length > 0) limited.push_back(run);
  return limited;
}

std::vector<TensionSpring> tension_springs(const Deformation& deformation, const ClothSystem& system) {
  std::vector<TensionSpring> springs;
  for (const SpringRun& run : limited_runs(deformation, system)) {
    for (int i = run.first; i < run.first + run.count; ++i)
      springs.push_back({static_cast<std::size_t>(i), static_cast<std::size_t>(i + run.offset),
                         run.rest_length, (1 + deformation.rate) * run.rest_length});
  }
  return springs;
}

double largest_excess(const std::vector<TensionSpring>& springs, const Vec3Field& position) {
  double largest = 0;
  for (const TensionSpring& spring : springs) largest = std::max(largest, spring.excess(position));
  return largest;
}

SpringLines spring_lines(std::span<const TensionSpring> springs, const ClothSystem& system) {
  const Followers followers = followers_of(springs, system);
  SpringLines lines;
  lines.springs.reserve(springs.size());
  std::vector<std::uint8_t> taken(springs.size(), 0);
  std::vector<std::size_t> met(system.pinned.size(), no_spring);  // the line that last met each particle

  // From one spring to both sides, until the line ends or reaches a spring or particle that it has.
  const auto follow = [&](std::size_t line, std::size_t from, std::size_t end,
                          std::vector<std::size_t>& found) {
    for (std::size_t spring = from;;) {
      const std::size_t next = followers[spring][end];
      if (next == no_spring || taken[next]) return;
      const TensionSpring& s = springs[spring];
      const std::size_t joint = end == 0 ? s.first : s.second;
      end = 1 - end_at(springs[next], joint);
      const std::size_t beyond = end == 0 ? springs[next].first : springs[next].second;
      if (met[beyond] == line) return;
      met[beyond] = line;
      taken[next] = 1;
      found.push_back(spring = next);
    }
  };
  for (std::size_t s = 0; s < springs.size(); ++s) {
    if (taken[s]) continue;
    const std::size_t line = lines.begin.size();
    lines.begin.push_back(lines.springs.size());
    taken[s] = 1;
    met[springs[s].first] = met[springs[s].second] = line;
    std::vector<std::size_t> back, forth;
    follow(line, s, 0, back);
    follow(line, s, 1, forth);
    lines.springs.insert(lines.springs.end(), back.rbegin(), back.rend());
    lines.springs.push_back(s);
    lines.springs.insert(lines.springs.end(), forth.begin(), forth.end());
  }
  lines.begin.push_back(lines.springs.size());
  return lines;
}

}  // namespace cloth

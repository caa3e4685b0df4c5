#include "contact/close_pairs.h"

#include <algorithm>

#include "contact/obstacle_body.h"
#include "geometry/at.h"
#include "kernels/in_shares.h"

namespace cloth {
namespace {

constexpr std::size_t least_kept = 500;  ///< pairs that are worth a thread of their own
/// Candidates are found for this many more displacements like the present one, at most for one more reach.
constexpr double ways_ahead = 4;
constexpr double least_ahead = 0.1;  ///< of the reach, for rounding and small motions

double furthest_reach(const SweptBounds& swept) {
  return std::max(swept.reach, swept.own_reach);
}

/// Equal poses, where the rotation of a sphere does not matter.
bool same_place(const ObstacleBody& body, const Pose& a, const Pose& b) {
  return a == b ||
         (body.kind == BodyKind::ball && a.at(body.center) == b.at(body.center) && a.stretch == b.stretch);
}

}  // namespace

void ClosePairs::set_team(WorkerTeam* team) {
  team_ = team;
  search_.set_team(team);
  parts_.resize(team ? static_cast<std::size_t>(team->size()) : 1);
}

void ClosePairs::measure(const PairQuery& now) {
  longest_ = 0;
  range_.resize(now.swept.particles.size());
  for (std::size_t i = 0; i < range_.size(); ++i) {
    const Capsule& capsule = now.swept.particles[i];
    const double length = (capsule.to - capsule.from).norm();
    longest_ = std::max(longest_, length);
    range_[i] = length + capsule.radius;
  }
  obstacle_paths_.clear();
  for (std::size_t k = 0; k < bodies_.size(); ++k)
    obstacle_paths_.push_back(longest_path(bodies_[k], now.paths[k]));
}

bool ClosePairs::all_at_rest(const PairQuery& now) const {
  for (std::size_t k = 0; k < bodies_.size(); ++k)
    if (!same_place(bodies_[k], now.paths[k].from(), now.paths[k].to())) return false;
  return true;
}

/// Whether the candidates still contain all pairs.
bool ClosePairs::holds(const PairQuery& now) const {
  if (cached_range_.size() != range_.size()) return false;
  for (std::size_t k = 0; k < bodies_.size(); ++k)
    if (!same_place(bodies_[k], now.poses[k], cached_poses_[k])) return false;
  for (std::size_t i = 0; i < range_.size(); ++i)
    if (moved_[i] + range_[i] > cached_range_[i]) return false;
  return true;
}

/// Finds the candidates and their distances.
void ClosePairs::collect_candidates(const PairQuery& now) {
  const double reach = furthest_reach(now.swept);
  SweptBounds around = now.swept;
  cached_range_.resize(range_.size());
  for (std::size_t i = 0; i < range_.size(); ++i) {
    const Vec3 here = now.position[i];
    const double length = (around.particles[i].to - around.particles[i].from).norm();
    cached_range_[i] = range_[i] + std::min(ways_ahead * length, reach) + least_ahead * reach;
    around.particles[i] = {here, here, cached_range_[i]};
  }
  search_.find(around, now.paths, cached_);
  cached_distance_.resize(cached_.size()), cached_ends_.resize(cached_.size());
  in_shares(team_, cached_.size(), least_kept, [&](int, std::size_t begin, std::size_t end) {
    for (std::size_t k = begin; k < end; ++k) {
      cached_distance_[k] = distance_of(cached_[k], cloth_, now.position, bodies_, now.poses);
      cached_ends_[k] = ends_of(cached_[k]);
    }
  });
  cached_position_ = now.position;
  cached_poses_ = now.poses;
  moved_.assign(range_.size(), 0);
}

double ClosePairs::reach_of(const FeaturePair& pair, const SweptBounds& swept) const {
  return pair.obstacle == FeaturePair::cloth_itself ? swept.own_reach : swept.reach;
}

ClosePairs::Ends ClosePairs::ends_of(const FeaturePair& pair) const {
  const PairParticles all = particles_of(pair, cloth_);
  const int none = static_cast<int>(range_.size());
  Ends ends{{none, none, none}, {none, none, none}};
  for (int j = 0; j < all.count; ++j)
    (j < all.near_count ? ends.near[at(j)] : ends.far[at(j - all.near_count)]) = all.particle[at(j)];
  return ends;
}

void ClosePairs::add_spent(const PairQuery& now) {
  spent_.assign(range_.size() + 1, 0);
  most_spent_ = 0;
  for (std::size_t i = 0; i < range_.size(); ++i) {
    spent_[i] = moved_[i] + range_[i];
    most_spent_ = std::max(most_spent_, spent_[i]);
  }
  most_spent_ = 2 * most_spent_ + furthest_reach(now.swept);
}

/// Whether is_far() holds for a candidate, from its cached distance.
bool ClosePairs::is_known_far(std::size_t k, const SweptBounds& swept) const {
  constexpr double rounding = 1e-9;
  const double distance = (1 - rounding) * cached_distance_[k];
  if (distance > most_spent_) return true;
  const auto most = [&](const std::array<int, 3>& of) {
    return std::max({spent_[at(of[0])], spent_[at(of[1])], spent_[at(of[2])]});
  };
  return distance > reach_of(cached_[k], swept) + most(cached_ends_[k].near) + most(cached_ends_[k].far);
}

/// Whether the pair cannot come within its reach: the displacements are too short, or lead along or away.
bool ClosePairs::is_far(const FeaturePair& pair, const Separation& s, const SweptBounds& swept) const {
  const double reach = reach_of(pair, swept);
  double near_range = 0, far_range = 0;
  Interval near, far{s.far_level, s.far_level};
  for (int j = 0; j < s.count; ++j) {
    const std::size_t i = at(s.particle[at(j)]);
    double& range = j < s.near_count ? near_range : far_range;
    range = std::max(range, range_[i]);
    (j < s.near_count ? near : far).add(along(s.normal, swept.particles[i]));
  }
  if (pair.obstacle != FeaturePair::cloth_itself) {
    far_range = obstacle_paths_[at(pair.obstacle)];
    far.high += far_range;
  }
  if (s.distance > reach + near_range + far_range) return true;
  return !s.normal.isZero(0) && near.low > far.high + reach;
}

template <class Skip>
void ClosePairs::separate_all(const PairQuery& now, const std::vector<FeaturePair>& candidates,
                              const Skip& skip, std::vector<FeaturePair>& pairs,
                              std::vector<Separation>& separations) {
  const int shares =
      in_shares(team_, candidates.size(), least_kept, [&](int share, std::size_t begin, std::size_t end) {
        Part& part = parts_[at(share)];
        part.pairs.clear(), part.separations.clear();
        for (std::size_t k = begin; k < end; ++k) {
          if (skip(k)) continue;
          const FeaturePair& pair = candidates[k];
          const Separation s = separate(pair, cloth_, now.position, bodies_, now.poses,
                                        near_factor * reach_of(pair, now.swept));
          if (is_far(pair, s, now.swept)) continue;
          part.pairs.push_back(pair);
          part.separations.push_back(s);
        }
      });
  pairs.clear(), separations.clear();
  for (int share = 0; share < shares; ++share) {
    const Part& part = parts_[at(share)];
    pairs.insert(pairs.end(), part.pairs.begin(), part.pairs.end());
    separations.insert(separations.end(), part.separations.begin(), part.separations.end());
  }
}

/// Candidates are cached where the next step will find nearly the same positions.
void ClosePairs::find(const PairQuery& now, std::vector<FeaturePair>& pairs,
                      std::vector<Separation>& separations) {
  measure(now);
  if (longest_ > furthest_reach(now.swept) || !all_at_rest(now)) {
    search_.find(now.swept, now.paths, found_);
    return separate_all(
        now, found_, [](std::size_t) { return false; }, pairs, separations);
  }
  if (cached_position_.size() == now.position.size())
    for (std::size_t i = 0; i < moved_.size(); ++i)
      moved_[i] = (now.position[i] - cached_position_[i]).norm();
  if (!holds(now)) collect_candidates(now);
  add_spent(now);
  separate_all(
      now, cached_, [&](std::size_t k) { return is_known_far(k, now.swept); }, pairs, separations);
}

}  // namespace cloth

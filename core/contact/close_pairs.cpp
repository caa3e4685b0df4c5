#include "contact/close_pairs.h"

#include <algorithm>
#include <array>
#include <numeric>
#include <utility>

#include "contact/obstacle_body.h"
#include "geometry/at.h"
#include "kernels/in_shares.h"

namespace cloth {
namespace {

/// Candidates are found for this many more displacements like the present one.
constexpr double ways_ahead = 6;
/// Of the reach, how much further at most, and at least: for rounding and small motions.
constexpr double most_ahead = 1.5, least_ahead = 0.25;
constexpr double of_rounding = 1e-9;  ///< of a distance

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
  parts_.resize(std::max(parts_.size(), team ? static_cast<std::size_t>(team->size()) : 1));
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

/// Whether the candidates still contain all pairs: those whose distance is at most what may be taken from it
/// (motion_of()) beyond their reach. What a feature may have moved by, and may yet, is bounded by the largest
/// of its particles' displacements and ranges, which may be those of two particles of an edge.
bool ClosePairs::holds(const PairQuery& now) const {
  if (cached_range_.size() != range_.size() || cached_poses_.size() != bodies_.size()) return false;
  for (std::size_t k = 0; k < bodies_.size(); ++k)
    if (!same_place(bodies_[k], now.poses[k], cached_poses_[k])) return false;
  for (std::size_t i = 0; i < range_.size(); ++i)
    if (moved_[i] + range_[i] > (1 - of_rounding) * cached_range_[i]) return false;
  return std::all_of(cloth_.edges.begin(), cloth_.edges.end(), [&](const std::array<int, 2>& edge) {
    const std::size_t a = at(edge[0]), b = at(edge[1]);
    return std::max(moved_[a] + range_[b], moved_[b] + range_[a]) <=
           (1 - of_rounding) * std::max(cached_range_[a], cached_range_[b]);
  });
}

/// Finds the candidates and their distances.
void ClosePairs::collect_candidates(const PairQuery& now) {
  const double reach = furthest_reach(now.swept);
  SweptBounds around = now.swept;
  cached_range_.resize(range_.size());
  for (std::size_t i = 0; i < range_.size(); ++i) {
    const Vec3 here = now.position[i];
    const double length = (around.particles[i].to - around.particles[i].from).norm();
    cached_range_[i] = range_[i] + std::min(ways_ahead * length, most_ahead * reach) + least_ahead * reach;
    around.particles[i] = {here, here, cached_range_[i]};
  }
  // All of a feature's points may move by the largest range of its particles.
  for (const auto& [a, b] : cloth_.edges)
    for (const auto& [i, beside] : {std::pair(at(a), at(b)), std::pair(at(b), at(a))})
      around.particles[i].radius = std::max(around.particles[i].radius, cached_range_[beside]);
  search_.find(around, now.paths, cached_);
  cached_room_.resize(cached_.size()), cached_sides_.resize(cached_.size());
  const PairSetting setting{cloth_, now.position, bodies_, now.poses, now.placed};
  in_shares(team_, cached_.size(), least_pairs, [&](int, std::size_t begin, std::size_t end) {
    PairBatch(setting).find_distances(std::span(cached_).subspan(begin, end - begin),
                                      cached_room_.data() + begin);
    for (std::size_t k = begin; k < end; ++k) {
      cached_room_[k] = (1 - of_rounding) * cached_room_[k] - reach_of(cached_[k], now.swept);
      cached_sides_[k] = sides_of(cached_[k]);
    }
  });
  drop_far_candidates();
  take_features(cached_sides_);
  cached_position_ = now.position;
  cached_poses_ = now.poses;
  moved_.assign(range_.size(), 0);
}

/// Those that cannot come within their reach while the candidates hold.
void ClosePairs::drop_far_candidates() {
  features_.resize(at(first_face()) + cloth_.triangles.size());
  std::iota(features_.begin(), features_.end(), 0);
  spread(cached_range_, spent_);
  std::size_t kept = 0;
  for (std::size_t k = 0; k < cached_.size(); ++k) {
    const Sides sides = cached_sides_[k];
    const double room = cached_room_[k];
    cached_[kept] = cached_[k], cached_sides_[kept] = sides, cached_room_[kept] = room;
    kept += room <= spent_[at(sides.near)] + spent_[at(sides.far)] ? 1 : 0;
  }
  cached_.resize(kept), cached_sides_.resize(kept), cached_room_.resize(kept);
}

/// Of sides by the features' numbers, places in features_, which has no others.
void ClosePairs::take_features(std::vector<Sides>& sides) {
  place_of_feature_.assign(at(first_face()) + cloth_.triangles.size(), -1);
  for (const Sides& both : sides) place_of_feature_[at(both.near)] = place_of_feature_[at(both.far)] = 0;
  features_.clear();
  for (std::size_t f = 0; f < place_of_feature_.size(); ++f) {
    if (place_of_feature_[f] < 0) continue;
    place_of_feature_[f] = static_cast<int>(features_.size());
    features_.push_back(static_cast<int>(f));
  }
  for (Sides& both : sides) both = {place_of_feature_[at(both.near)], place_of_feature_[at(both.far)]};
}

double ClosePairs::reach_of(const FeaturePair& pair, const SweptBounds& swept) const {
  return pair.obstacle == FeaturePair::cloth_itself ? swept.own_reach : swept.reach;
}

ClosePairs::Sides ClosePairs::sides_of(const FeaturePair& pair) const {
  const int none = first_edge() - 1, edges = first_edge(), faces = first_face();
  const bool is_own = pair.obstacle == FeaturePair::cloth_itself;
  switch (pair.kind) {
    case PairKind::vertex_plane:
    case PairKind::vertex_box:
      return {pair.feature, none};
    case PairKind::vertex_face:
      return {pair.feature, is_own ? faces + pair.far_feature : none};
    case PairKind::edge_edge:
      return {edges + pair.feature, is_own ? edges + pair.far_feature : none};
    case PairKind::face_sphere:
    case PairKind::face_vertex:
      return {faces + pair.feature, none};
  }
  return {none, none};
}

/// How far each feature may be at the end of this round from where it was when the candidates were found, and
/// may go in it. Returns whether some candidate may be within its reach; without one these are not found.
bool ClosePairs::add_spent() {
  const auto largest = [](const std::vector<double>& of) {
    return of.empty() ? 0 : *std::max_element(of.begin(), of.end());
  };
  const double most = 2 * (largest(moved_) + largest(range_));
  if (std::none_of(cached_room_.begin(), cached_room_.end(), [&](double room) { return room <= most; }))
    return false;
  spread(range_, range_of_feature_);
  spread(moved_, spent_);
  for (std::size_t f = 0; f < spent_.size(); ++f) spent_[f] += range_of_feature_[f];
  return true;
}

/// The largest of each feature's particles; 0 of an obstacle's.
void ClosePairs::spread(const std::vector<double>& of_particles, std::vector<double>& of_features) const {
  of_features.clear();
  const auto particle = [&](int i) { return of_particles[at(i)]; };
  auto next = features_.begin();
  for (; next != features_.end() && *next + 1 < first_edge(); ++next) of_features.push_back(particle(*next));
  if (next != features_.end() && *next < first_edge()) of_features.push_back(0), ++next;
  for (; next != features_.end() && *next < first_face(); ++next) {
    const auto& [a, b] = cloth_.edges[at(*next - first_edge())];
    of_features.push_back(std::max(particle(a), particle(b)));
  }
  for (; next != features_.end(); ++next) {
    const auto& [a, b, c] = cloth_.triangles[at(*next - first_face())];
    of_features.push_back(std::max({particle(a), particle(b), particle(c)}));
  }
}

/// Whether the motion since the candidates were found, and in this round, leaves one beyond its reach.
bool ClosePairs::is_beyond(std::size_t k) const {
  return cached_room_[k] > spent_[at(cached_sides_[k].near)] + spent_[at(cached_sides_[k].far)];
}

/// m, bound of what this round's motion takes from the distance of a pair.
double ClosePairs::motion_of(const FeaturePair& pair, const Sides& sides) const {
  const double far = pair.obstacle == FeaturePair::cloth_itself ? 0 : obstacle_paths_[at(pair.obstacle)];
  return range_of_feature_[at(sides.near)] + range_of_feature_[at(sides.far)] + far;
}

/// A pair cannot come within its reach where the displacements are too short, or lead along or away. (Pairs
/// that wait without a separation are not asked for the direction.)
ClosePairs::Role ClosePairs::role_of(const FeaturePair& pair, const Separation& s, double motion,
                                     const SweptBounds& swept) const {
  const double reach = reach_of(pair, swept);
  const bool is_within = s.distance <= reach && s.gap() <= reach, holds = is_contact(s, reach);
  if (is_within && holds) return Role::acts;
  if (s.distance > reach + motion) return Role::none;
  const Role role = !holds && s.gap() > 2 * motion ? Role::waits : Role::acts;
  if (is_within || s.normal.isZero(0)) return role;
  Interval near, far{s.far_level, s.far_level};
  for (int j = 0; j < s.count; ++j)
    (j < s.near_count ? near : far).add(along(s.normal, swept.particles[at(s.particle[at(j)])]));
  if (pair.obstacle != FeaturePair::cloth_itself) far.high += obstacle_paths_[at(pair.obstacle)];
  return near.low > far.high + reach ? Role::none : role;
}

/// Of the part's pairs, those that act remain.
void ClosePairs::separate_part(const PairQuery& now, Part& part) const {
  std::vector<FeaturePair>& pairs = part.pairs;
  if (part.every.size() < pairs.size()) part.every.resize(pairs.size());
  part.needs.resize(pairs.size());
  part.separations.clear(), part.waiting.clear();
  const PairSetting setting{cloth_, now.position, bodies_, now.poses, now.placed};
  PairBatch(setting).separate(pairs, {near_factor * now.swept.reach, near_factor * now.swept.own_reach},
                              {part.motion, {now.swept.reach, now.swept.own_reach}}, part.every.data(),
                              part.needs.data());
  std::size_t kept = 0;
  for (std::size_t k = 0; k < pairs.size(); ++k) {
    if (part.needs[k] == PairNeed::apart) continue;
    const FeaturePair pair = pairs[k];
    const Role role = part.needs[k] == PairNeed::waits
                          ? Role::waits
                          : role_of(pair, part.every[k], part.motion[k], now.swept);
    if (role == Role::waits) part.waiting.push_back({pair, kept});
    if (role != Role::acts) continue;
    pairs[kept++] = pair;
    part.separations.push_back(part.every[k]);
  }
  pairs.resize(kept);
}

/// Of the candidates, with the sides of each, those that are not beyond(k). The result is that of the first
/// part.
template <class Beyond>
void ClosePairs::separate_all(const PairQuery& now, const std::vector<FeaturePair>& candidates,
                              const std::vector<Sides>& sides, const Beyond& beyond) {
  const int shares =
      shares_.run(team_, candidates.size(), least_pairs, [&](int share, std::size_t begin, std::size_t end) {
        Part& part = parts_[at(share)];
        part.chosen.resize(std::max(part.chosen.size(), end - begin));
        std::size_t chosen = 0;  // without branches: a processor cannot predict them
        for (std::size_t k = begin; k < end; ++k) {
          part.chosen[chosen] = k;
          chosen += beyond(k) ? 0 : 1;
        }
        part.pairs.resize(chosen), part.motion.resize(chosen);
        for (std::size_t j = 0; j < chosen; ++j) {
          const std::size_t k = part.chosen[j];
          part.pairs[j] = candidates[k], part.motion[j] = motion_of(candidates[k], sides[k]);
        }
        separate_part(now, part);
      });
  const auto append = [](auto& to, const auto& from) { to.insert(to.end(), from.begin(), from.end()); };
  for (int share = 1; share < shares; ++share) {
    for (WaitingPair& waiting : parts_[at(share)].waiting) waiting.place += parts_[0].pairs.size();
    append(parts_[0].pairs, parts_[at(share)].pairs);
    append(parts_[0].separations, parts_[at(share)].separations);
    append(parts_[0].waiting, parts_[at(share)].waiting);
  }
}

/// Candidates are cached where the next step will find nearly the same positions.
void ClosePairs::find(const PairQuery& now, std::vector<FeaturePair>& pairs,
                      std::vector<Separation>& separations, std::vector<WaitingPair>& waiting) {
  measure(now);
  if (longest_ > furthest_reach(now.swept) || !all_at_rest(now)) {
    search_.find(now.swept, now.paths, found_);
    cached_range_.clear();  // features_ are no longer those of the cached candidates
    found_sides_.clear();
    for (const FeaturePair& pair : found_) found_sides_.push_back(sides_of(pair));
    take_features(found_sides_);
    spread(range_, range_of_feature_);
    separate_all(now, found_, found_sides_, [](std::size_t) { return false; });
  } else {
    if (cached_position_.size() == now.position.size())
      for (std::size_t i = 0; i < moved_.size(); ++i)
        moved_[i] = (now.position[i] - cached_position_[i]).norm();
    if (!holds(now)) collect_candidates(now);
    if (add_spent()) {
      separate_all(now, cached_, cached_sides_, [&](std::size_t k) { return is_beyond(k); });
    } else {
      parts_[0].pairs.clear(), parts_[0].separations.clear(), parts_[0].waiting.clear();
    }
  }
  pairs.swap(parts_[0].pairs), separations.swap(parts_[0].separations), waiting.swap(parts_[0].waiting);
}

}  // namespace cloth

#include "contact/candidates.h"

#include <algorithm>
#include <array>
#include <numeric>
#include <span>
#include <utility>

#include "contact/motion_kernels.h"
#include "contact/obstacle_body.h"
#include "geometry/at.h"
#include "kernels/in_shares.h"
#include "kernels/instruction_set.h"

namespace cloth {
namespace {

/// Candidates are found for this many more displacements like the present one.
constexpr double ways_ahead = 4;
/// Of the reach, how much further at most, and at least: for rounding and small motions.
constexpr double most_ahead = 1.5, least_ahead = 0.25;
constexpr double of_rounding = 1e-9;  ///< of a distance

}  // namespace

void Candidates::collect(const PairQuery& now, const std::vector<double>& length,
                         const std::vector<double>& range, PairSearch& search, WorkerTeam* team) {
  const double reach = std::max(now.swept.reach, now.swept.own_reach);
  position_ = now.position, poses_ = now.poses;
  around_.reach = now.swept.reach, around_.own_reach = now.swept.own_reach;
  around_.from = around_.to = position_;
  around_.radius.resize(range.size()), range_.resize(range.size());
  for (std::size_t i = 0; i < range.size(); ++i) {
    range_[i] = range[i] + std::min(ways_ahead * length[i], most_ahead * reach) + least_ahead * reach;
    around_.radius[i] = range_[i];
  }
  // All of a feature's points may move by the largest range of its particles.
  for (const auto& [a, b] : cloth_.edges)
    for (const auto& [i, beside] : {std::pair(at(a), at(b)), std::pair(at(b), at(a))})
      around_.radius[i] = std::max(around_.radius[i], range_[beside]);
  allow();
  search.find(around_, now.paths, pairs_);
  measure_rooms(now, team);
  drop_far();
  take_features();
}

/// For holds(): the displacement that each particle may have, and the least of what an edge allows one of its
/// ends together with the other, the larger of both.
void Candidates::allow() {
  allowed_.clear();
  for (const double range : range_) allowed_.push_back((1 - of_rounding) * range);
  allowed_beside_.assign(range_.size(), Bounds::infinity);
  for (const auto& [a, b] : cloth_.edges) {
    const double either = std::max(allowed_[at(a)], allowed_[at(b)]);
    for (const int i : {a, b}) allowed_beside_[at(i)] = std::min(allowed_beside_[at(i)], either);
  }
}

void Candidates::take(std::vector<FeaturePair>& pairs) {
  pairs_.swap(pairs);
  sides_.clear();
  for (const FeaturePair& pair : pairs_) sides_.push_back(sides_of(pair));
  take_features();
}

void Candidates::measure_rooms(const PairQuery& now, WorkerTeam* team) {
  room_.resize(pairs_.size()), sides_.resize(pairs_.size());
  const PairSetting setting{cloth_, now.position, bodies_, now.poses, now.placed};
  bounds_.begin(setting, pairs_);
  in_shares(team, pairs_.size(), least_pairs, [&](int, std::size_t begin, std::size_t end) {
    bounds_.find(setting, std::span(pairs_).subspan(begin, end - begin), room_.data() + begin);
    for (std::size_t k = begin; k < end; ++k) {
      room_[k] = (1 - of_rounding) * room_[k] - reach_of(pairs_[k], around_);
      sides_[k] = sides_of(pairs_[k]);
    }
  });
}

/// Those that cannot come within their reach while the others are complete. Precondition: sides are features'
/// numbers.
void Candidates::drop_far() {
  features_.resize(at(first_face()) + cloth_.triangles.size());
  std::iota(features_.begin(), features_.end(), 0);
  spread(range_, range_of_feature_);
  std::size_t kept = 0;
  for (std::size_t k = 0; k < pairs_.size(); ++k) {
    const Sides sides = sides_[k];
    const double room = room_[k];
    pairs_[kept] = pairs_[k], sides_[kept] = sides, room_[kept] = room;
    kept += room <= range_of_feature_[at(sides.near)] + range_of_feature_[at(sides.far)] ? 1 : 0;
  }
  pairs_.resize(kept), sides_.resize(kept), room_.resize(kept);
}

/// Of sides that are features' numbers, places in features_, which has no others.
void Candidates::take_features() {
  place_of_feature_.assign(at(first_face()) + cloth_.triangles.size(), -1);
  for (const Sides& both : sides_) place_of_feature_[at(both.near)] = place_of_feature_[at(both.far)] = 0;
  features_.clear();
  for (std::size_t f = 0; f < place_of_feature_.size(); ++f) {
    if (place_of_feature_[f] < 0) continue;
    place_of_feature_[f] = static_cast<int>(features_.size());
    features_.push_back(static_cast<int>(f));
  }
  for (Sides& both : sides_) both = {place_of_feature_[at(both.near)], place_of_feature_[at(both.far)]};
}

Candidates::Sides Candidates::sides_of(const FeaturePair& pair) const {
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

bool Candidates::holds(const PairQuery& now, const std::vector<double>& moved,
                       const std::vector<double>& range) const {
  if (range_.size() != range.size() || poses_.size() != bodies_.size()) return false;
  if (around_.reach != now.swept.reach || around_.own_reach != now.swept.own_reach) return false;
  for (std::size_t k = 0; k < bodies_.size(); ++k)
    if (!same_place(bodies_[k], now.poses[k], poses_[k])) return false;
  const double widest = range.empty() ? 0 : *std::max_element(range.begin(), range.end());
  if (active_kernels<MotionKernels>().are_within(moved.data(), range.data(), widest, allowed_.data(),
                                                 allowed_beside_.data(), static_cast<long>(range.size())))
    return true;
  for (std::size_t i = 0; i < range.size(); ++i)
    if (moved[i] + range[i] > allowed_[i]) return false;
  return std::all_of(cloth_.edges.begin(), cloth_.edges.end(), [&](const std::array<int, 2>& edge) {
    const std::size_t a = at(edge[0]), b = at(edge[1]);
    return std::max(moved[a] + range[b], moved[b] + range[a]) <= std::max(allowed_[a], allowed_[b]);
  });
}

void Candidates::spread(const std::vector<double>& of_particles, std::vector<double>& of_features) const {
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

}  // namespace cloth

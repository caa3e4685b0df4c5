#include "contact/close_pairs.h"

#include <algorithm>
#include <utility>

#include "contact/obstacle_body.h"
#include "contact/particle_motion.h"
#include "geometry/at.h"

namespace cloth {
namespace {

double furthest_reach(const SweptBounds& swept) {
  return std::max(swept.reach, swept.own_reach);
}

}  // namespace

void ClosePairs::set_team(WorkerTeam* team) {
  team_ = team;
  search_.set_team(team);
  parts_.resize(std::max(parts_.size(), team ? static_cast<std::size_t>(team->size()) : 1));
}

void ClosePairs::measure(const PairQuery& now) {
  longest_ = find_distances(now.swept.from, now.swept.to, team_, length_);
  range_.resize(length_.size());
  for (std::size_t i = 0; i < range_.size(); ++i) range_[i] = length_[i] + now.swept.radius[i];
  obstacle_paths_.clear();
  for (std::size_t k = 0; k < bodies_.size(); ++k)
    obstacle_paths_.push_back(longest_path(bodies_[k], now.paths[k]));
}

bool ClosePairs::all_at_rest(const PairQuery& now) const {
  for (std::size_t k = 0; k < bodies_.size(); ++k)
    if (!same_place(bodies_[k], now.paths[k].from(), now.paths[k].to())) return false;
  return true;
}

/// How far each feature may be at the end of this round from where it was when the candidates were found, and
/// may go in it. Returns whether some candidate may be within its reach; without one these are not found.
bool ClosePairs::add_spent() {
  const auto largest = [](const std::vector<double>& of) {
    return of.empty() ? 0 : *std::max_element(of.begin(), of.end());
  };
  const double most = 2 * (largest(moved_) + largest(range_));
  if (std::none_of(kept_.room().begin(), kept_.room().end(), [&](double room) { return room <= most; }))
    return false;
  kept_.spread(range_, range_of_feature_);
  kept_.spread(moved_, spent_);
  for (std::size_t f = 0; f < spent_.size(); ++f) spent_[f] += range_of_feature_[f];
  return true;
}

/// Whether the motion since the candidates were found, and in this round, leaves one beyond its reach.
bool ClosePairs::is_beyond(std::size_t k) const {
  const Candidates::Sides& sides = kept_.sides()[k];
  return kept_.room()[k] > spent_[at(sides.near)] + spent_[at(sides.far)];
}

/// m, bound of what this round's motion takes from the distance of a pair.
double ClosePairs::motion_of(const FeaturePair& pair, const Candidates::Sides& sides) const {
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
    (j < s.near_count ? near : far).add(along(s.normal, swept[at(s.particle[at(j)])]));
  if (pair.obstacle != FeaturePair::cloth_itself) far.high += obstacle_paths_[at(pair.obstacle)];
  return near.low > far.high + reach ? Role::none : role;
}

/// Of the part's pairs, those that act remain.
void ClosePairs::separate_part(const PairQuery& now, Part& part) const {
  part.acting.clear(), part.separations.clear(), part.waiting.clear();
  const PairSetting setting{cloth_, now.position, bodies_, now.poses, now.placed};
  PairBatch(setting).separate(part.pairs, {near_factor * now.swept.reach, near_factor * now.swept.own_reach},
                              {part.motion, {now.swept.reach, now.swept.own_reach}},
                              [&](std::size_t k, PairNeed need, const Separation& separation) {
                                if (need == PairNeed::apart) return;
                                const FeaturePair& pair = part.pairs[k];
                                const Role role = need == PairNeed::waits
                                                      ? Role::waits
                                                      : role_of(pair, separation, part.motion[k], now.swept);
                                if (role == Role::waits) part.waiting.push_back({pair, part.acting.size()});
                                if (role != Role::acts) return;
                                part.acting.push_back(pair);
                                part.separations.push_back(separation);
                              });
  part.pairs.swap(part.acting);
}

/// Of the candidates, with the sides of each, those that are not beyond(k). The result is that of the first
/// part.
template <class Beyond>
void ClosePairs::separate_all(const PairQuery& now, const Candidates& candidates, const Beyond& beyond) {
  const std::vector<FeaturePair>& pairs = candidates.pairs();
  const int shares =
      shares_.run(team_, pairs.size(), least_pairs, [&](int share, std::size_t begin, std::size_t end) {
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
          part.pairs[j] = pairs[k], part.motion[j] = motion_of(pairs[k], candidates.sides()[k]);
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
    search_.find(now.swept, now.paths, found_pairs_);
    found_.take(found_pairs_);
    found_.spread(range_, range_of_feature_);
    separate_all(now, found_, [](std::size_t) { return false; });
  } else {
    find_distances(kept_.position(), now.position, team_, moved_);
    if (!kept_.holds(now, moved_, range_)) {
      kept_.collect(now, length_, range_, search_, team_);
      moved_.assign(range_.size(), 0);
    }
    if (add_spent()) {
      separate_all(now, kept_, [&](std::size_t k) { return is_beyond(k); });
    } else {
      parts_[0].pairs.clear(), parts_[0].separations.clear(), parts_[0].waiting.clear();
    }
  }
  pairs.swap(parts_[0].pairs), separations.swap(parts_[0].separations), waiting.swap(parts_[0].waiting);
}

}  // namespace cloth

// Narrow phase of continuous contact: the pairs of features that can come within their reach of each other in
// a round of contact, with their separations.
//
// The result depends on the present positions and swept bounds only. While the obstacles are at rest,
// candidates from PairSearch are cached for several rounds, as in neighbour lists with a skin (Verlet 1967):
// the distance of a pair decreases by at most the displacements of its particles, so that a pair whose cached
// distance exceeds them is skipped without computing its separation.
#pragma once

#include "contact/near_pairs.h"
#include "contact/separations.h"
#include "kernels/balanced_shares.h"

namespace cloth {

/// Pairs nearer than this many thicknesses become contact constraints; others only bound the motion.
inline constexpr double near_factor = 1.5;
/// Least number of pairs that is worth a thread of its own.
inline constexpr std::size_t least_pairs = 100;

inline bool is_contact(const Separation& separation, double thickness) {
  return separation.nearest && separation.distance < near_factor * thickness && !separation.normal.isZero(0);
}

/// A pair that waits, see ClosePairs::find().
struct WaitingPair {
  FeaturePair pair;
  std::size_t place = 0;  ///< it comes before the acting pair with this number
  bool operator==(const WaitingPair&) const = default;
};

struct PairQuery {
  const Vec3Field& position;                    ///< m, of the particles
  const SweptBounds& swept;                     ///< of the particles in this round, and the reaches
  const std::vector<PoseInterpolation>& paths;  ///< of the obstacles in this substep
  const std::vector<Pose>& poses;               ///< of the obstacles now
  const PlacedBodies* placed = nullptr;         ///< in these poses
};

class ClosePairs {
 public:
  /// The arguments are those of PairSearch.
  ClosePairs(const Surface& cloth, const Vec3Field& start, const std::vector<ObstacleBody>& bodies,
             bool with_itself, double skin)
      : cloth_(cloth), bodies_(bodies), search_(cloth, start, bodies, with_itself, skin) {}

  /// Null: one thread. Results do not depend on the team.
  void set_team(WorkerTeam* team);

  /// All pairs that can come within their reach (SweptBounds) while particles and obstacles stay in their
  /// swept bounds. `waiting`: those that are no contacts now (is_contact()) and whose gap is more than twice
  /// what the motion can take from it, so that they do not bound it either; they may become contacts. Some of
  /// these cannot come within their reach, since the motion leads apart.
  /// The others in `pairs`, with the separation of each. All three are replaced.
  void find(const PairQuery& now, std::vector<FeaturePair>& pairs, std::vector<Separation>& separations,
            std::vector<WaitingPair>& waiting);

  /// Drops the cached candidates. Call it after the reaches have changed.
  void forget() { cached_range_.clear(), search_.forget(); }

  PairSearch& search() { return search_; }
  const PairSearch& search() const { return search_; }

 private:
  /// The features of a candidate: their numbers, or places in `features_`.
  struct Sides {
    int near, far;
  };
  struct Part {  ///< the result of one thread
    std::vector<FeaturePair> pairs;
    std::vector<WaitingPair> waiting;
    std::vector<Separation> separations;
    // scratch, of each pair before those that do not act are dropped
    std::vector<Separation> every;    ///< may be longer
    std::vector<double> motion;       ///< m, see motion_of()
    std::vector<std::size_t> chosen;  ///< of the candidates; may be longer
    std::vector<PairNeed> needs;
  };
  enum class Role { none, waits, acts };

  void measure(const PairQuery& now);
  bool all_at_rest(const PairQuery& now) const;
  bool holds(const PairQuery& now) const;
  void collect_candidates(const PairQuery& now);
  double reach_of(const FeaturePair& pair, const SweptBounds& swept) const;
  Sides sides_of(const FeaturePair& pair) const;
  void drop_far_candidates();
  bool add_spent();
  void take_features(std::vector<Sides>& sides);
  void spread(const std::vector<double>& of_particles, std::vector<double>& of_features) const;
  bool is_beyond(std::size_t kept) const;
  double motion_of(const FeaturePair& pair, const Sides& sides) const;
  Role role_of(const FeaturePair& pair, const Separation& separation, double motion,
               const SweptBounds& swept) const;
  void separate_part(const PairQuery& now, Part& part) const;
  template <class Beyond>
  void separate_all(const PairQuery& now, const std::vector<FeaturePair>& candidates,
                    const std::vector<Sides>& sides, const Beyond& beyond);
  // Numbers of features of the cloth: its vertices, one of all features of obstacles, edges, faces.
  int first_edge() const { return static_cast<int>(range_.size()) + 1; }
  int first_face() const { return first_edge() + static_cast<int>(cloth_.edges.size()); }

  const Surface& cloth_;
  const std::vector<ObstacleBody>& bodies_;
  PairSearch search_;
  WorkerTeam* team_ = nullptr;
  BalancedShares shares_;
  std::vector<Part> parts_{1};  ///< of each thread

  std::vector<double> range_;             ///< m, bound of each particle's displacement in this round
  std::vector<int> features_;             ///< of the candidates, by their numbers, ascending
  std::vector<int> place_of_feature_;     ///< scratch
  std::vector<double> range_of_feature_;  ///< m, of features_
  std::vector<double> obstacle_paths_;    ///< m, of each: bound of its points' displacement in this substep
  std::vector<double> moved_;       ///< m, displacement of each particle since the candidates were found
  double longest_ = 0;              ///< m, longest of the particles' displacements
  std::vector<FeaturePair> found_;  ///< candidates that are not cached
  std::vector<Sides> found_sides_;  ///< of each

  std::vector<FeaturePair> cached_;  ///< candidates
  std::vector<Sides> cached_sides_;  ///< of each
  std::vector<double> cached_room_;  ///< m, of each, its distance at cached_position_ beyond its reach
  /// m, of features_, how far each may be at the end of this round from where it was then.
  std::vector<double> spent_;
  Vec3Field cached_position_;
  std::vector<double>
      cached_range_;  ///< m, displacement of each particle up to which the candidates are complete
  std::vector<Pose> cached_poses_;
};

}  // namespace cloth

// The pairs of features that can come within the thickness of each other in a round, and their separations.
//
// The result depends on the present positions and swept bounds only. Candidates are cached for some rounds: a
// pair whose distance was computed cannot have become nearer by more than its particles have moved since
// (neighbour lists with a skin; Verlet 1967).
#pragma once

#include "contact/near_pairs.h"

namespace cloth {

/// Pairs nearer than this many thicknesses become contact constraints; others only bound the motion.
inline constexpr double near_factor = 1.5;

struct PairQuery {
  const Vec3Field& position;  ///< m, of the particles
  const SweptBounds& swept;
  const std::vector<PoseInterpolation>& paths;  ///< of the obstacles in this substep
  const std::vector<Pose>& poses;               ///< of the obstacles now
};

class ClosePairs {
 public:
  /// See PairSearch.
  ClosePairs(const Surface& cloth, const std::vector<ObstacleBody>& bodies, bool with_itself, double skin)
      : cloth_(cloth), bodies_(bodies), search_(cloth, bodies, with_itself, skin) {}

  /// Null: one thread. Results do not depend on the team.
  void set_team(WorkerTeam* team);

  /// All pairs that can come within the reach of each other while everything stays in its swept bounds.
  void find(const PairQuery& now, std::vector<FeaturePair>& pairs, std::vector<Separation>& separations);

  /// Drops the cached candidates: the reaches have changed.
  void forget() { cached_range_.clear(), search_.forget(); }

  PairSearch& search() { return search_; }
  const PairSearch& search() const { return search_; }

 private:
  struct Part {
    std::vector<FeaturePair> pairs;
    std::vector<Separation> separations;
  };

  void measure(const PairQuery& now);
  bool all_at_rest(const PairQuery& now) const;
  bool holds(const PairQuery& now) const;
  void collect_candidates(const PairQuery& now);
  double reach_of(const FeaturePair& pair, const SweptBounds& swept) const;
  bool is_known_far(std::size_t kept, const SweptBounds& swept) const;
  bool is_far(const FeaturePair& pair, const Separation& separation, const SweptBounds& swept) const;
  template <class Skip>
  void separate_all(const PairQuery& now, const std::vector<FeaturePair>& candidates, const Skip& skip,
                    std::vector<FeaturePair>& pairs, std::vector<Separation>& separations);

  const Surface& cloth_;
  const std::vector<ObstacleBody>& bodies_;
  PairSearch search_;
  WorkerTeam* team_ = nullptr;
  std::vector<Part> parts_{1};  ///< of each thread

  std::vector<double> range_;           ///< m, furthest displacement of each particle in this round
  std::vector<double> obstacle_paths_;  ///< m, furthest displacement of any point of each in this substep
  std::vector<double> moved_;           ///< m, of each particle since the candidates were found
  double longest_ = 0;                  ///< m, longest of the particles' displacements
  std::vector<FeaturePair> found_;

  std::vector<FeaturePair> cached_;
  std::vector<double> cached_distance_;  ///< m, of each
  Vec3Field cached_position_;
  std::vector<double> cached_range_;  ///< m, displacements for which the candidates hold
  std::vector<Pose> cached_poses_;
};

}  // namespace cloth

// The pairs of features that can come within their reach while every particle stays within some range of
// where it is: a neighbour list with a skin (Verlet 1967), for obstacles at rest. Of each a lower bound of
// its distance is known, which decreases by at most the displacements of its particles.
#pragma once

#include <vector>

#include "contact/distance_bounds.h"
#include "contact/near_pairs.h"
#include "contact/separations.h"

namespace cloth {

class WorkerTeam;

/// Least number of pairs that is worth a thread of its own.
inline constexpr std::size_t least_pairs = 100;

struct PairQuery {
  const Vec3Field& position;                    ///< m, of the particles
  const SweptBounds& swept;                     ///< of the particles in this round, and the reaches
  const std::vector<PoseInterpolation>& paths;  ///< of the obstacles in this substep
  const std::vector<Pose>& poses;               ///< of the obstacles now
  const PlacedBodies* placed = nullptr;         ///< in these poses
};

/// m, of a pair.
inline double reach_of(const FeaturePair& pair, const SweptBounds& swept) {
  return pair.obstacle == FeaturePair::cloth_itself ? swept.own_reach : swept.reach;
}

class Candidates {
 public:
  /// The arguments must outlive it.
  Candidates(const Surface& cloth, const std::vector<ObstacleBody>& bodies)
      : cloth_(cloth), bodies_(bodies) {}

  /// Finds the pairs and how far they are apart at least. `length` and `range`: m, of each particle's
  /// displacement in this round, and its bound. `team`: null is one thread.
  void collect(const PairQuery& now, const std::vector<double>& length, const std::vector<double>& range,
               PairSearch& search, WorkerTeam* team);
  /// Takes pairs that are found in another way: without rooms, and for one round alone.
  void take(std::vector<FeaturePair>& pairs);
  void clear() { range_.clear(); }

  /// Whether the pairs still contain all that can come within their reach in this round: those whose distance
  /// is at most what motion may take from it beyond the reach. What a feature may have moved by, and may yet,
  /// is bounded by the largest of its particles' displacements and ranges, which may be those of two
  /// particles of an edge. `moved`: m, of each particle since collect(); `range` as there.
  bool holds(const PairQuery& now, const std::vector<double>& moved, const std::vector<double>& range) const;

  struct Sides {
    int near, far;  ///< places among the features of all pairs, where an obstacle's are one
  };
  const std::vector<FeaturePair>& pairs() const { return pairs_; }
  const std::vector<Sides>& sides() const { return sides_; }  ///< of each pair
  /// m, of each pair: at most what its distance was in collect() beyond its reach.
  const std::vector<double>& room() const { return room_; }
  const Vec3Field& position() const { return position_; }  ///< m, in collect()
  /// The largest of each feature's particles, of the features of all pairs; 0 of an obstacle's.
  void spread(const std::vector<double>& of_particles, std::vector<double>& of_features) const;

 private:
  void allow();
  void measure_rooms(const PairQuery& now, WorkerTeam* team);
  void drop_far();
  void take_features();
  Sides sides_of(const FeaturePair& pair) const;
  // Numbers of features of the cloth: its vertices, one of all features of obstacles, edges, faces.
  int first_edge() const { return static_cast<int>(cloth_.triangle_of_vertex.size()) + 1; }
  int first_face() const { return first_edge() + static_cast<int>(cloth_.edges.size()); }

  const Surface& cloth_;
  const std::vector<ObstacleBody>& bodies_;
  std::vector<FeaturePair> pairs_;
  std::vector<Sides> sides_;
  std::vector<double> room_;
  std::vector<int> features_;             ///< of the pairs, by their numbers, ascending
  std::vector<int> place_of_feature_;     ///< scratch
  std::vector<double> range_of_feature_;  ///< scratch
  DistanceBounds bounds_;                 ///< scratch

  Vec3Field position_;
  std::vector<double> range_;  ///< m, displacement of each particle up to which the pairs are complete
  std::vector<double> allowed_, allowed_beside_;  ///< m, see allow()
  SweptBounds around_;                            ///< m, all of these displacements
  std::vector<Pose> poses_;
};

}  // namespace cloth

// Narrow phase of continuous contact: the pairs of features that can come within their reach of each other in
// a round of contact, with their separations.
//
// The result depends on the present positions and swept bounds only. While the obstacles are at rest,
// candidates from PairSearch are cached for several rounds, as in neighbour lists with a skin (Verlet 1967):
// a pair whose distance was larger than what its particles have moved by since, and may yet, is skipped
// without computing its separation.
#pragma once

#include "contact/candidates.h"
#include "kernels/balanced_shares.h"

namespace cloth {

/// Pairs nearer than this many thicknesses become contact constraints; others only bound the motion.
inline constexpr double near_factor = 1.5;

inline bool is_contact(const Separation& separation, double thickness) {
  return separation.nearest && separation.distance < near_factor * thickness && !separation.normal.isZero(0);
}

/// A pair that waits, see ClosePairs::find().
struct WaitingPair {
  FeaturePair pair;
  std::size_t place = 0;  ///< it comes before the acting pair with this number
  bool operator==(const WaitingPair&) const = default;
};

class ClosePairs {
 public:
  /// The arguments are those of PairSearch.
  ClosePairs(const Surface& cloth, const Vec3Field& start, const std::vector<ObstacleBody>& bodies,
             bool with_itself, double skin)
      : cloth_(cloth),
        bodies_(bodies),
        search_(cloth, start, bodies, with_itself, skin),
        found_(cloth, bodies),
        kept_(cloth, bodies) {}

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
  void forget() { kept_.clear(); }

  PairSearch& search() { return search_; }
  const PairSearch& search() const { return search_; }

 private:
  struct alignas(64) Part {  ///< the result of one thread, in cache lines of its own
    std::vector<FeaturePair> pairs;
    std::vector<WaitingPair> waiting;
    std::vector<Separation> separations;
    // scratch
    std::vector<FeaturePair> acting;
    std::vector<double> motion;  ///< m, see motion_of(), of each pair before those not acting are dropped
    std::vector<std::size_t> chosen;  ///< of the candidates; may be longer
  };
  enum class Role { none, waits, acts };

  void measure(const PairQuery& now);
  bool all_at_rest(const PairQuery& now) const;
  bool add_spent();
  bool is_beyond(std::size_t kept) const;
  double motion_of(const FeaturePair& pair, const Candidates::Sides& sides) const;
  Role role_of(const FeaturePair& pair, const Separation& separation, double motion,
               const SweptBounds& swept) const;
  void separate_part(const PairQuery& now, Part& part) const;
  template <class Beyond>
  void separate_all(const PairQuery& now, const Candidates& candidates, const Beyond& beyond);

  const Surface& cloth_;
  const std::vector<ObstacleBody>& bodies_;
  PairSearch search_;
  WorkerTeam* team_ = nullptr;
  BalancedShares shares_;
  std::vector<Part> parts_{1};  ///< of each thread

  std::vector<double> length_;            ///< m, of each particle's displacement in this round
  std::vector<double> range_;             ///< m, bound of each particle's displacement in this round
  std::vector<double> range_of_feature_;  ///< m, of the features of the candidates
  std::vector<double> obstacle_paths_;    ///< m, of each: bound of its points' displacement in this substep
  double longest_ = 0;                    ///< m, longest of the particles' displacements
  std::vector<FeaturePair> found_pairs_;  ///< scratch
  Candidates found_;                      ///< for one round alone
  Candidates kept_;
  std::vector<double> moved_;  ///< m, displacement of each particle since those kept were found
  /// m, of their features, how far each may be at the end of this round from where it was then.
  std::vector<double> spent_;
};

}  // namespace cloth

#include "contact/region_overlaps.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <stdexcept>

#include "contact/obstacle_body.h"
#include "geometry/at.h"
#include "kernels/in_shares.h"
#include "kernels/instruction_set.h"

namespace cloth {
namespace {

constexpr std::size_t eight = EightRegions::count;
/// Overlaps, of up to eight features each, and features to be looked for in a hierarchy, one by one and in
/// eights, that are worth a thread of their own.
constexpr std::size_t least_overlaps = 100, least_queries = 64, least_eights = 8;

/// RegionOverlap cannot count more.
void expect_to_be_counted(std::size_t features) {
  if (features / eight >= std::size_t{1} << RegionOverlap::most_bits)
    throw std::length_error("more than 134 million features of a surface in contact");
}

double median(std::vector<double>& numbers) {
  const auto middle = numbers.begin() + static_cast<std::ptrdiff_t>(numbers.size() / 2);
  std::nth_element(numbers.begin(), middle, numbers.end());
  return *middle;
}

/// For regions most of which lie side by side; some may be far away. They change rarely when these move: the
/// unit is a power of two, and the middle a multiple of two units. From a sample.
CoarseNumbers numbers_for(std::span<const RoundedRegion> regions) {
  if (regions.empty()) return {};
  constexpr std::size_t sample = 31;
  const std::size_t stride = std::max<std::size_t>(1, regions.size() / sample);
  std::vector<double> along;
  const auto median_of = [&](const auto& number_of) {
    along.clear();
    for (std::size_t i = 0; i < regions.size(); i += stride) along.push_back(number_of(regions[i]));
    return median(along);
  };
  Vec3 middle;
  double spread = std::numeric_limits<float>::min();
  for (int axis = 0; axis < 3; ++axis) {
    middle[axis] = median_of([&](const RoundedRegion& region) { return region.lower[axis]; });
    spread = std::max(spread, median_of([&](const RoundedRegion& region) {
                        return std::abs(region.lower[axis] - middle[axis]);
                      }));
  }
  const double unit = 2 * std::exp2(std::ceil(std::log2(spread)));
  for (int axis = 0; axis < 3; ++axis) middle[axis] = 2 * unit * std::round(middle[axis] / (2 * unit));
  if (!middle.allFinite() || !std::isfinite(unit)) return {};  // beyond single precision
  return {middle, unit};
}

}  // namespace

Feature RegionOverlaps::Meeting::near() const {
  if (kind == PairKind::edge_edge) return Feature::edge;
  return kind == PairKind::vertex_face ? Feature::vertex : Feature::face;
}

Feature RegionOverlaps::Meeting::far() const {
  if (kind == PairKind::edge_edge) return Feature::edge;
  return kind == PairKind::vertex_face ? Feature::face : Feature::vertex;
}

RegionOverlaps::RegionOverlaps(const Surface& cloth, const Vec3Field& start)
    : cloth_(cloth), meetings_{{PairKind::edge_edge}, {PairKind::vertex_face}} {
  for (std::size_t i = 0; i < start.size(); ++i) boxes_[Feature::vertex].push_back(bounds_of(start[i]));
  spread(cloth_, boxes_);
  for (const Feature feature : {Feature::edge, Feature::face}) {
    expect_to_be_counted(boxes_[feature].size());
    trees_[feature] = BoxTree(boxes_[feature]);
    at_vertices_[feature] = {start.size(), cloth_, feature, trees_[feature].order()};
  }
}

RegionOverlaps::RegionOverlaps(const Surface& cloth, int obstacle, const ObstacleBody& mesh)
    : cloth_(cloth),
      obstacle_(obstacle),
      meetings_{{PairKind::edge_edge}, {PairKind::vertex_face}, {PairKind::face_vertex}} {
  OfFeatures<std::vector<Bounds>> boxes;
  std::vector<RoundedRegion> vertices;
  for (const Vec3& vertex : mesh.vertices) {
    boxes[Feature::vertex].push_back(bounds_of(vertex));
    vertices.push_back(rounded(Capsule{vertex, vertex}));
  }
  spread(mesh.surface, boxes);
  numbers_ = numbers_for(vertices);
  std::vector<CoarseRegion> coarse;
  for (const RoundedRegion& vertex : vertices) coarse.push_back(numbers_.of(vertex));
  for (const Feature feature : {Feature::vertex, Feature::edge, Feature::face}) {
    expect_to_be_counted(boxes[feature].size());
    trees_[feature] = BoxTree(boxes[feature]);
    fill(regions_[feature], mesh.surface, feature, trees_[feature].order(), coarse, nullptr);
  }
  // Far from the origin rounding exceeds the room that the boxes of queries have.
  for (std::size_t i = 0; i < vertices.size(); ++i) boxes[Feature::vertex][i] = vertices[i].box();
  spread(mesh.surface, boxes);
  for (const Feature feature : {Feature::vertex, Feature::edge, Feature::face})
    trees_[feature].refit(boxes[feature]);
}

void RegionOverlaps::find(std::span<const RoundedRegion> particles, double skin, WorkerTeam* team,
                          std::vector<FeaturePair>& pairs) {
  parts_.resize(team ? at(team->size()) : 1);
  const CoarseNumbers numbers = is_own() ? numbers_for(particles) : numbers_;
  const bool are_first = kept_.size() != particles.size() || numbers != numbers_;
  numbers_ = numbers;
  if (are_first) kept_.clear();
  if (!keeps_regions(particles, skin)) {
    take_regions(kept_, team);
    is_own() ? find_own(team) : find_of_mesh(team);
  }
  if (std::all_of(meetings_.begin(), meetings_.end(), [](const Meeting& m) { return m.overlaps.empty(); }))
    return;
  take_regions(particles, team);
  for (const Meeting& meeting : meetings_) take_near(meeting, team, pairs);
}

/// Whether all particles are in the regions for which the overlaps hold; else these are made anew, of a mesh
/// for those particles that have left. Overlaps that are kept may be too many; the pairs are those whose
/// regions of this search overlap.
bool RegionOverlaps::keeps_regions(std::span<const RoundedRegion> particles, double skin) {
  has_left_.assign(particles.size(), 1);
  bool has_any_left = kept_.empty();
  for (std::size_t i = 0; i < kept_.size(); ++i) {
    has_left_[i] = !kept_[i].contains(particles[i]);
    has_any_left |= has_left_[i] != 0;
  }
  kept_.resize(particles.size());
  for (std::size_t i = 0; i < particles.size() && has_any_left; ++i)
    if (is_own() || has_left_[i] != 0) kept_[i] = grown(particles[i], skin);
  return !has_any_left;
}

void RegionOverlaps::take_regions(std::span<const RoundedRegion> particles, WorkerTeam* team) {
  constexpr std::size_t least = 512;
  fill_in_shares(team, particles.size(), least, coarse_,
                 [&](std::size_t i) { return numbers_.of(particles[i]); });
  if (!is_own()) return;
  for (const Feature feature : {Feature::edge, Feature::face})
    fill(regions_[feature], cloth_, feature, trees_[feature].order(), coarse_, team);
}

void RegionOverlaps::find_own(WorkerTeam* team) {
  boxes_[Feature::vertex].clear();
  for (const RoundedRegion& region : kept_) boxes_[Feature::vertex].push_back(region.box());
  spread(cloth_, boxes_);
  for (const Feature feature : {Feature::edge, Feature::face}) trees_[feature].refit(boxes_[feature]);
  for (Meeting& meeting : meetings_) {
    for (Part& part : parts_) part.no_pairs.assign(regions_[meeting.far()].size(), 0);
    const std::size_t eights = (number_of(meeting.near()) + eight - 1) / eight;
    collect(eights, least_eights, meeting, team,
            [&](std::size_t begin, std::size_t end, Part& part, std::vector<RegionOverlap>& overlaps) {
              for (std::size_t k = begin; k < end; ++k) find_own_of_eight(meeting, eight * k, part, overlaps);
            });
  }
}

/// Of vertices, or of edges in the order of their hierarchy, up to eight side by side: the hierarchy is gone
/// through once for all, of edges from the first on, since each pair is to be found once.
void RegionOverlaps::find_own_of_eight(const Meeting& meeting, std::size_t first, Part& part,
                                       std::vector<RegionOverlap>& overlaps) const {
  const bool are_edges = meeting.near() == Feature::edge;
  const std::size_t count = std::min(eight, number_of(meeting.near()) - first);
  std::array<CoarseRegion, eight> regions;
  std::array<int, eight> queries;
  for (std::size_t k = 0; k < count; ++k) {
    queries[k] = are_edges ? trees_[Feature::edge].order()[first + k] : static_cast<int>(first + k);
    regions[k] = region_of(cloth_, meeting.near(), queries[k], coarse_);
  }
  CoarseRegion whole = regions[0];
  for (std::size_t k = 1; k < count; ++k) whole.add(regions[k]);
  part.around.clear();
  trees_[meeting.far()].visit_eights(are_edges ? static_cast<int>(first) : 0, numbers_.box(whole),
                                     [&](int place, std::uint32_t hits) {
                                       part.around.push_back({0, static_cast<std::uint32_t>(place), hits});
                                     });
  part.left.resize(part.around.size());
  for (std::size_t k = 0; k < count; ++k) {
    if (are_edges)  // up to this one
      part.no_pairs[first / eight] = static_cast<std::uint8_t>((2U << k) - 1);
    take_own(meeting, queries[k], regions[k], part, overlaps);
  }
}

/// Those of `part.around` that overlap the query, without `part.no_pairs` and features that share a vertex
/// with it: of edges itself among them.
void RegionOverlaps::take_own(const Meeting& meeting, int query, const CoarseRegion& region, Part& part,
                              std::vector<RegionOverlap>& overlaps) const {
  const int found =
      active_kernels<RegionKernels>().narrow(regions_[meeting.far()].data(), part.around.data(),
                                             static_cast<int>(part.around.size()), region, part.left.data());
  const auto with_neighbours = [&](const auto& visit) {
    with_vertices_of(cloth_, meeting.near(), query, [&](const auto& vertices) {
      for (const int vertex : vertices)
        for (const int beside : at_vertices_[meeting.far()].of(vertex)) visit(at(beside));
    });
  };
  with_neighbours([&](std::size_t beside) {
    part.no_pairs[beside / eight] |= static_cast<std::uint8_t>(1U << (beside % eight));
  });
  for (int k = 0; k < found; ++k) {
    const RegionOverlap& left = part.left[at(k)];
    const std::uint32_t hits = left.hits & ~std::uint32_t{part.no_pairs[left.eight]};
    if (hits != 0) overlaps.push_back({query, left.eight, hits});
  }
  with_neighbours([&](std::size_t beside) { part.no_pairs[beside / eight] = 0; });
}

void RegionOverlaps::find_of_mesh(WorkerTeam* team) {
  for (Meeting& meeting : meetings_) {
    before_.swap(meeting.overlaps);
    const auto has_left = [&](std::size_t query) {
      return with_vertices_of(cloth_, meeting.near(), static_cast<int>(query), [&](const auto& vertices) {
        return std::any_of(vertices.begin(), vertices.end(), [&](int i) { return has_left_[at(i)] != 0; });
      });
    };
    collect(number_of(meeting.near()), least_queries, meeting, team,
            [&](std::size_t begin, std::size_t end, Part& part, std::vector<RegionOverlap>& overlaps) {
              const auto first_of = [&](auto from, std::size_t query) {
                return std::find_if(from, before_.end(), [&](const RegionOverlap& overlap) {
                  return overlap.query >= static_cast<int>(query);
                });
              };
              auto next = std::lower_bound(
                  before_.begin(), before_.end(), static_cast<int>(begin),
                  [](const RegionOverlap& overlap, int query) { return overlap.query < query; });
              const auto take_up_to = [&](std::size_t query) {
                const auto stop = first_of(next, query);
                overlaps.insert(overlaps.end(), next, stop);
                next = stop;
              };
              for (std::size_t q = begin; q < end; ++q) {
                if (!has_left(q)) continue;
                take_up_to(q);
                next = first_of(next, q + 1);
                take_of_mesh(meeting, static_cast<int>(q), part, overlaps);
              }
              take_up_to(end);
            });
  }
}

void RegionOverlaps::take_of_mesh(const Meeting& meeting, int query, Part& part,
                                  std::vector<RegionOverlap>& overlaps) const {
  const CoarseRegion region = region_of(cloth_, meeting.near(), query, coarse_);
  part.around.clear();
  trees_[meeting.far()].visit_eights(0, numbers_.box(region), [&](int place, std::uint32_t hits) {
    part.around.push_back({query, static_cast<std::uint32_t>(place), hits});
  });
  const std::size_t before = overlaps.size();
  overlaps.resize(before + part.around.size());
  const int found = active_kernels<RegionKernels>().narrow(regions_[meeting.far()].data(), part.around.data(),
                                                           static_cast<int>(part.around.size()), region,
                                                           overlaps.data() + before);
  overlaps.resize(before + at(found));
}

/// collect_part(begin, end, part, overlaps) for shares of the items; what they append follows each other in
/// their order.
template <class CollectPart>
void RegionOverlaps::collect(std::size_t items, std::size_t least, Meeting& meeting, WorkerTeam* team,
                             const CollectPart& collect_part) {
  const int shares = in_shares(team, items, least, [&](int share, std::size_t begin, std::size_t end) {
    Part& part = parts_[at(share)];
    part.overlaps.clear();
    collect_part(begin, end, part, part.overlaps);
  });
  meeting.overlaps.swap(parts_[0].overlaps);
  for (int share = 1; share < shares; ++share)
    meeting.overlaps.insert(meeting.overlaps.end(), parts_[at(share)].overlaps.begin(),
                            parts_[at(share)].overlaps.end());
}

std::size_t RegionOverlaps::number_of(Feature near) const {
  if (near == Feature::vertex) return kept_.size();
  return near == Feature::edge ? cloth_.edges.size() : cloth_.triangles.size();
}

/// Appends those of the overlaps whose regions still overlap.
void RegionOverlaps::take_near(const Meeting& meeting, WorkerTeam* team, std::vector<FeaturePair>& pairs) {
  const std::vector<RegionOverlap>& overlaps = meeting.overlaps;
  const std::span<const int> order = trees_[meeting.far()].order();
  const Regions& far = regions_[meeting.far()];
  const auto find = active_kernels<RegionKernels>().find;
  const auto take = [&](int share, std::size_t begin, std::size_t end) {
    Part& part = parts_[at(share)];
    part.pairs.clear();
    for (std::size_t next = begin; begin < end; begin = next) {
      const int query = overlaps[begin].query;
      while (next < end && overlaps[next].query == query) ++next;
      part.places.resize(std::max(part.places.size(), (next - begin) * eight));
      const int found = find(far.data(), overlaps.data() + begin, static_cast<int>(next - begin),
                             region_of(cloth_, meeting.near(), query, coarse_), part.places.data());
      for (int k = 0; k < found; ++k)
        part.pairs.push_back({obstacle_, meeting.kind, query, order[at(part.places[at(k)])]});
    }
  };
  const int shares = in_shares(team, overlaps.size(), least_overlaps, take);
  for (int share = 0; share < shares; ++share)
    pairs.insert(pairs.end(), parts_[at(share)].pairs.begin(), parts_[at(share)].pairs.end());
}

void RegionOverlaps::refit_hierarchy(const Vec3Field& position, double reach) {
  boxes_[Feature::vertex].clear();
  for (std::size_t i = 0; i < position.size(); ++i)
    boxes_[Feature::vertex].push_back(bounds_of(position[i]).grown(reach));
  spread(cloth_, boxes_);
  trees_[Feature::face].refit(boxes_[Feature::face]);
}

}  // namespace cloth

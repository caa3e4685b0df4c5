#include "kernels/mesh_descent.h"

#include <algorithm>
#include <cmath>

#include "geometry/at.h"
#include "kernels/mesh_pass.h"

namespace cloth {
namespace {

constexpr int lanes = kernels::widest_vector;

/// One end of a spring, seen from the other.
struct OtherEnd {
  int particle;
  double stiffness, rest_length;
};

}  // namespace

bool MeshDescent::suits(const SpringRuns& springs) {
  return std::all_of(springs.blocks().begin(), springs.blocks().end(), [](const SpringBlock& block) {
    return std::isfinite(block.run.stiffness * block.run.rest_length) && std::isfinite(block.run.stiffness);
  });
}

MeshDescent::MeshDescent(const SpringRuns& springs, const std::vector<std::vector<int>>& colours,
                         std::size_t particles) {
  std::vector<int> springs_of(particles), particle_at, place_of(particles);
  for_each_spring(springs, [&](const SpringRun& run, std::size_t, std::size_t i, std::size_t j) {
    if (run.stiffness > 0) ++springs_of[i], ++springs_of[j];
  });
  for (std::vector<int> colour : colours) {
    std::stable_sort(colour.begin(), colour.end(),
                     [&](int i, int j) { return springs_of[at(i)] > springs_of[at(j)]; });
    for (const int i : colour) {
      place_of[at(i)] = static_cast<int>(particle_at.size());
      particle_at.push_back(i);
    }
    while (particle_at.size() % lanes != 0) particle_at.push_back(-1);
  }
  const auto places = static_cast<int>(particle_at.size());
  make_room(std::move(place_of), places, descent_);
  make_slots(springs, particle_at);
  for (AlignedDoubles* vectors : {&vectors_, &start_vectors_}) {
    vectors->assign(4 * (at(places) + 1), 0.0);
    std::copy(std::begin(kernels::nowhere), std::end(kernels::nowhere), vectors->end() - 4);
  }
  descent_.vectors = vectors_.data();
}

void MeshDescent::make_slots(const SpringRuns& springs, const std::vector<int>& particle_at) {
  std::vector<std::vector<OtherEnd>> ends(places().size());
  for_each_spring(springs, [&](const SpringRun& run, std::size_t, std::size_t i, std::size_t j) {
    if (!(run.stiffness > 0)) return;
    ends[i].push_back({static_cast<int>(j), run.stiffness, run.rest_length});
    ends[j].push_back({static_cast<int>(i), run.stiffness, run.rest_length});
  });
  const OtherEnd none{-1, 0, 0};
  descent_.slices = static_cast<int>(particle_at.size()) / lanes;
  slot_begin_.push_back(0);
  for (int slice = 0; slice < descent_.slices; ++slice) {
    const int* here = particle_at.data() + slice * lanes;
    std::size_t slots = 0;
    for (int lane = 0; lane < lanes; ++lane)
      if (here[lane] >= 0) slots = std::max(slots, ends[at(here[lane])].size());
    for (std::size_t slot = 0; slot < slots; ++slot)
      for (int lane = 0; lane < lanes; ++lane) {
        const bool is_there = here[lane] >= 0 && slot < ends[at(here[lane])].size();
        const OtherEnd& end = is_there ? ends[at(here[lane])][slot] : none;
        neighbour_.push_back(4 *
                             (is_there ? places()[at(end.particle)] : static_cast<int>(particle_at.size())));
        stiffness_.push_back(end.stiffness), rest_length_.push_back(end.rest_length);
      }
    slot_begin_.push_back(static_cast<int>(stiffness_.size()) / lanes);
  }
  descent_.slot_begin = slot_begin_.data(), descent_.neighbour = neighbour_.data();
  descent_.stiffness = stiffness_.data(), descent_.rest_length = rest_length_.data();
}

void MeshDescent::positions_have_moved() {
  local_kernels().to_vectors(descent_.position[0], descent_.position[1], descent_.position[2],
                             vectors_.data(), descent_.places);
}

void MeshDescent::begin_visits(const Start& start) {
  positions_have_moved();
  descent_.damper_per_stiffness = start.stretch_time / step();
  const double* const* from = descent_.start;
  descent_.start_vectors = from[0] ? start_vectors_.data() : nullptr;
  if (from[0]) local_kernels().to_vectors(from[0], from[1], from[2], start_vectors_.data(), descent_.places);
}

}  // namespace cloth

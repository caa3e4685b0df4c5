#include "kernels/mesh_layout.h"

#include <algorithm>

namespace cloth {
namespace {

constexpr int shortest_block = 64, longest_block = 1024;  // slices

struct End {
  int neighbour;
  double stiffness, rest_length;
};

std::vector<SpringRun> single_springs(const ClothSystem& system) {
  std::vector<SpringRun> springs;
  for (const SpringRun& run : system.springs)
    for (int s = 0; s < run.count; ++s) {
      springs.push_back(run);
      springs.back().first += s;
      springs.back().count = 1;
    }
  return springs;
}

/// Every spring goes to that of its ends that owns fewer so far.
std::vector<std::vector<End>> springs_of_owners(std::vector<SpringRun> springs, std::size_t owners) {
  const auto ends = [](const SpringRun& s) { return std::minmax({s.first, s.first + s.offset}); };
  std::stable_sort(springs.begin(), springs.end(),
                   [&](const SpringRun& a, const SpringRun& b) { return ends(a) < ends(b); });
  std::vector<std::vector<End>> owned(owners);
  for (const SpringRun& spring : springs) {
    const auto [low, high] = ends(spring);
    auto &of_low = owned[static_cast<std::size_t>(low)], &of_high = owned[static_cast<std::size_t>(high)];
    const bool to_low = of_low.size() <= of_high.size();
    (to_low ? of_low : of_high).push_back({to_low ? high : low, spring.stiffness, spring.rest_length});
  }
  return owned;
}

void append_slice(const std::vector<End>* owned, int first, MeshLayout& layout) {
  std::size_t slots = 0;
  for (int lane = 0; lane < slice_width; ++lane) slots = std::max(slots, owned[lane].size());
  for (std::size_t slot = 0; slot < slots; ++slot) {
    MeshLayout::Indices neighbour;
    MeshLayout::Numbers stiffness, tension;
    for (int lane = 0; lane < slice_width; ++lane) {
      const bool empty = slot >= owned[lane].size();
      const End end = empty ? End{first + lane, 0, 0} : owned[lane][slot];
      neighbour.lane[lane] = end.neighbour;
      stiffness.lane[lane] = end.stiffness;
      tension.lane[lane] = end.stiffness * end.rest_length;
    }
    layout.neighbour.push_back(neighbour);
    layout.stiffness.push_back(stiffness);
    layout.tension.push_back(tension);
  }
  layout.slot_begin.push_back(static_cast<int>(layout.neighbour.size()));
}

/// So long that a block meets only the next one before and behind it, where the bandwidth allows it.
int block_length(const std::vector<SpringRun>& springs) {
  int bandwidth = 0;
  for (const SpringRun& spring : springs) bandwidth = std::max(bandwidth, std::abs(spring.offset));
  return std::clamp((2 * bandwidth + slice_width - 1) / slice_width, shortest_block, longest_block);
}

std::vector<int> particles_touched(const MeshLayout& layout, MeshLayout::Block block) {
  std::vector<int> touched;
  for (int i = block.begin * slice_width; i < block.end * slice_width; ++i) touched.push_back(i);
  const auto begin = static_cast<std::size_t>(layout.slot_begin[static_cast<std::size_t>(block.begin)]);
  const auto end = static_cast<std::size_t>(layout.slot_begin[static_cast<std::size_t>(block.end)]);
  for (std::size_t slot = begin; slot < end; ++slot)
    touched.insert(touched.end(), layout.neighbour[slot].lane, layout.neighbour[slot].lane + slice_width);
  std::sort(touched.begin(), touched.end());
  touched.erase(std::unique(touched.begin(), touched.end()), touched.end());
  return touched;
}

void colour(int length, MeshLayout& layout) {
  std::vector<MeshLayout::Block> blocks;
  std::vector<std::vector<int>> touched;
  for (int begin = 0; begin < layout.slices; begin += length) {
    blocks.push_back({begin, std::min(begin + length, layout.slices)});
    touched.push_back(particles_touched(layout, blocks.back()));
  }
  const std::vector<int> colours = colours_of_blocks(touched, layout.slices * slice_width);
  for (std::size_t b = 0; b < blocks.size(); ++b) {
    const auto c = static_cast<std::size_t>(colours[b]);
    if (layout.colours.size() <= c) layout.colours.resize(c + 1);
    layout.colours[c].push_back(blocks[b]);
  }
}

}  // namespace

std::vector<int> colours_of_blocks(const std::vector<std::vector<int>>& touched, int particles) {
  std::vector<std::vector<int>> colours_at(static_cast<std::size_t>(particles));
  std::vector<int> colours;
  for (const std::vector<int>& here : touched) {
    std::vector<bool> taken(touched.size(), false);
    for (const int particle : here)
      for (const int other : colours_at[static_cast<std::size_t>(particle)])
        taken[static_cast<std::size_t>(other)] = true;
    const auto free = static_cast<int>(std::find(taken.begin(), taken.end(), false) - taken.begin());
    colours.push_back(free);
    for (const int particle : here) colours_at[static_cast<std::size_t>(particle)].push_back(free);
  }
  return colours;
}

MeshLayout make_mesh_layout(const ClothSystem& system) {
  MeshLayout layout;
  layout.particles = static_cast<int>(system.mass.size());
  layout.slices = (layout.particles + slice_width - 1) / slice_width;
  const std::vector<SpringRun> springs = single_springs(system);
  const auto owned = springs_of_owners(
      springs, static_cast<std::size_t>(layout.slices) * static_cast<std::size_t>(slice_width));
  layout.slot_begin.push_back(0);
  for (int slice = 0; slice < layout.slices; ++slice)
    append_slice(owned.data() + slice * slice_width, slice * slice_width, layout);
  colour(block_length(springs), layout);
  return layout;
}

}  // namespace cloth

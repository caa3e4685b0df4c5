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
      neighbour.lane[lane] = 4 * end.neighbour;
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
    for (const int offset : layout.neighbour[slot].lane) touched.push_back(offset / 4);
  std::sort(touched.begin(), touched.end());
  touched.erase(std::unique(touched.begin(), touched.end()), touched.end());
  return touched;
}

/// Block by block, but those of a lower colour that meet a block before it: every particle is added to in the
/// order of the colours.
std::vector<int> sequence_of(const std::vector<std::vector<int>>& meeting, const std::vector<int>& colours) {
  std::vector<int> sequence;
  std::vector<bool> taken(colours.size(), false);
  const auto take = [&](const auto& self, std::size_t block) -> void {
    if (taken[block]) return;
    taken[block] = true;
    for (const int other : meeting[block])
      if (colours[static_cast<std::size_t>(other)] < colours[block])
        self(self, static_cast<std::size_t>(other));
    sequence.push_back(static_cast<int>(block));
  };
  for (std::size_t block = 0; block < colours.size(); ++block) take(take, block);
  return sequence;
}

/// The lowest and the highest particle that a slice touches.
std::pair<int, int> reach_of(const MeshLayout& layout, int slice) {
  int lowest = slice * slice_width, highest = lowest + slice_width - 1;
  for (int slot = layout.slot_begin[static_cast<std::size_t>(slice)];
       slot < layout.slot_begin[static_cast<std::size_t>(slice) + 1]; ++slot)
    for (const int offset : layout.neighbour[static_cast<std::size_t>(slot)].lane)
      lowest = std::min(lowest, offset / 4), highest = std::max(highest, offset / 4);
  return {lowest, highest};
}

/// When to load and when to store, in whole slices.
void note_progress(MeshLayout& layout) {
  std::vector<int> slices;
  for (const MeshLayout::Block block : layout.sequence)
    for (int slice = block.begin; slice < block.end; ++slice) slices.push_back(slice);
  layout.load_until.resize(slices.size());
  layout.store_until.resize(slices.size());
  int needed = 0, complete = layout.particles;
  for (const int slice : slices) {
    needed = std::max(needed, reach_of(layout, slice).second / slice_width * slice_width + slice_width);
    layout.load_until[static_cast<std::size_t>(slice)] = std::min(needed, layout.particles);
  }
  for (auto slice = slices.rbegin(); slice != slices.rend(); ++slice) {
    layout.store_until[static_cast<std::size_t>(*slice)] = complete;
    complete = std::min(complete, reach_of(layout, *slice).first / slice_width * slice_width);
  }
}

void arrange_blocks(int length, MeshLayout& layout) {
  std::vector<MeshLayout::Block> blocks;
  std::vector<std::vector<int>> touched;
  for (int begin = 0; begin < layout.slices; begin += length) {
    blocks.push_back({begin, std::min(begin + length, layout.slices)});
    touched.push_back(particles_touched(layout, blocks.back()));
  }
  const auto meeting = blocks_that_meet(touched, layout.slices * slice_width);
  const std::vector<int> colours = colours_of_blocks(meeting);
  for (std::size_t b = 0; b < blocks.size(); ++b) {
    const auto c = static_cast<std::size_t>(colours[b]);
    if (layout.colours.size() <= c) layout.colours.resize(c + 1);
    layout.colours[c].push_back(blocks[b]);
  }
  for (const int b : sequence_of(meeting, colours))
    layout.sequence.push_back(blocks[static_cast<std::size_t>(b)]);
  note_progress(layout);
}

}  // namespace

std::vector<std::vector<int>> blocks_that_meet(const std::vector<std::vector<int>>& touched, int particles) {
  std::vector<std::vector<int>> blocks_at(static_cast<std::size_t>(particles)), meeting(touched.size());
  for (std::size_t block = 0; block < touched.size(); ++block)
    for (const int particle : touched[block])
      blocks_at[static_cast<std::size_t>(particle)].push_back(static_cast<int>(block));
  for (std::size_t block = 0; block < touched.size(); ++block) {
    std::vector<bool> met(touched.size(), false);
    for (const int particle : touched[block])
      for (const int other : blocks_at[static_cast<std::size_t>(particle)])
        met[static_cast<std::size_t>(other)] = true;
    for (std::size_t other = 0; other < met.size(); ++other)
      if (met[other] && other != block) meeting[block].push_back(static_cast<int>(other));
  }
  return meeting;
}

std::vector<int> colours_of_blocks(const std::vector<std::vector<int>>& meeting) {
  std::vector<int> colours;
  for (std::size_t block = 0; block < meeting.size(); ++block) {
    std::vector<bool> taken(meeting.size(), false);
    for (const int other : meeting[block])
      if (static_cast<std::size_t>(other) < block)
        taken[static_cast<std::size_t>(colours[static_cast<std::size_t>(other)])] = true;
    colours.push_back(static_cast<int>(std::find(taken.begin(), taken.end(), false) - taken.begin()));
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
  arrange_blocks(block_length(springs), layout);
  return layout;
}

}  // namespace cloth

#include "kernels/mesh_layout.h"

#include <algorithm>
#include <optional>
#include <tuple>

namespace cloth {
namespace {

using kernels::block_width;
using kernels::slice_width;

/// One end of a spring, seen from the other.
struct End {
  int neighbour;
  double stiffness, tension;
};

/// The numbering that the system has serves where few lanes stay empty and neighbours are in the first cache
/// together: what an order of one's own gains is lost again by taking every state there and back.
bool serves_as_it_is(const ClothSystem& system) {
  constexpr int near_enough = 1000;
  constexpr double slots_too_many = 1.2;
  std::vector<int> springs_of(system.mass.size());
  if (bandwidth_of(system) > near_enough) return false;
  for_each_spring(system.springs, [&](const SpringRun&, std::size_t, std::size_t i, std::size_t j) {
    ++springs_of[i], ++springs_of[j];
  });
  double lanes = 0, used = 0;
  for (std::size_t begin = 0; begin < springs_of.size(); begin += slice_width) {
    const auto end = std::min(begin + slice_width, springs_of.size());
    int slots = 0;
    for (std::size_t i = begin; i < end; ++i) slots = std::max(slots, springs_of[i]), used += springs_of[i];
    lanes += slots * static_cast<double>(end - begin);
  }
  return lanes <= slots_too_many * used;
}

/// The springs of each lane, by the numbers of the other ends.
std::vector<std::vector<End>> springs_of_lanes(const ClothSystem& system, const ParticleOrder& order,
                                               std::size_t lanes) {
  constexpr std::size_t usual_springs = 16;
  const ParticleOrder number = inverse_of(order);
  const auto lane_of = [&](std::size_t i) { return number.empty() ? static_cast<int>(i) : number[i]; };
  std::vector<std::vector<End>> springs(lanes);
  for (auto& of_lane : springs) of_lane.reserve(usual_springs);
  for_each_spring(system.springs, [&](const SpringRun& run, std::size_t, std::size_t i, std::size_t j) {
    const int a = lane_of(i), b = lane_of(j);
    const double tension = run.stiffness * run.rest_length;
    springs[static_cast<std::size_t>(a)].push_back({b, run.stiffness, tension});
    springs[static_cast<std::size_t>(b)].push_back({a, run.stiffness, tension});
  });
  for (auto& of_lane : springs)
    std::sort(of_lane.begin(), of_lane.end(), [](const End& a, const End& b) {
      return std::tie(a.neighbour, a.stiffness, a.tension) < std::tie(b.neighbour, b.stiffness, b.tension);
    });
  return springs;
}

/// What kinds of springs there are, as long as they fit into a table.
class KindTable {
 public:
  /// Springs of the same stiffness are of one kind, or only those of the same tension as well.
  explicit KindTable(bool with_tension) : with_tension_(with_tension) {}

  std::optional<unsigned char> kind_of(const End& end) {
    for (std::size_t k = 0; k < size_; ++k)
      if (stiffness[k] == end.stiffness && (!with_tension_ || tension[k] == end.tension))
        return static_cast<unsigned char>(k);
    if (size_ == stiffness.size()) return std::nullopt;
    stiffness[size_] = end.stiffness, tension[size_] = end.tension;
    return static_cast<unsigned char>(size_++);
  }

  std::array<double, kernels::max_kinds> stiffness{}, tension{};

 private:
  bool with_tension_;
  std::size_t size_ = 0;
};

/// Whether all springs find a place in `table`.
bool fill(KindTable& table, const std::vector<std::vector<End>>& springs) {
  if (!table.kind_of({0, 0, 0})) return false;  // of empty lanes
  for (const auto& of_lane : springs)
    for (const End& end : of_lane)
      if (!table.kind_of(end)) return false;
  return true;
}

void append_slice(const std::vector<End>* springs, MeshLayout& layout) {
  std::size_t slots = 0;
  for (int lane = 0; lane < slice_width; ++lane) slots = std::max(slots, springs[lane].size());
  for (std::size_t slot = 0; slot < slots; ++slot) {
    MeshLayout::Indices neighbour;
    MeshLayout::Numbers stiffness, tension;
    for (int lane = 0; lane < slice_width; ++lane) {
      const End end = slot < springs[lane].size() ? springs[lane][slot]
                                                  : End{kernels::padding_index(layout.slices), 0, 0};
      neighbour.lane[lane] = 4 * end.neighbour;
      stiffness.lane[lane] = end.stiffness, tension.lane[lane] = end.tension;
    }
    layout.neighbour.push_back(neighbour);
    layout.stiffness.push_back(stiffness);
    layout.tension.push_back(tension);
  }
  layout.slot_begin.push_back(static_cast<int>(layout.neighbour.size()));
}

/// Numbers of which there are few are not read from memory again and again: that is most of what a slot
/// takes.
void use_tables(const std::vector<std::vector<End>>& springs, MeshLayout& layout) {
  KindTable kinds(true);
  const bool all = fill(kinds, springs);
  if (!all) {
    kinds = KindTable(false);
    if (!fill(kinds, springs)) return;
  }
  layout.stiffness_of_kind = kinds.stiffness;
  if (all) layout.tension_of_kind = kinds.tension;
  const unsigned char none = *kinds.kind_of({0, 0, 0});
  layout.kind.assign(layout.neighbour.size(), {{none, none, none, none, none, none, none, none}});
  for (int slice = 0; slice < layout.slices; ++slice)
    for (int lane = 0; lane < slice_width; ++lane) {
      auto slot = static_cast<std::size_t>(layout.slot_begin[static_cast<std::size_t>(slice)]);
      for (const End& end : springs[static_cast<std::size_t>(slice * slice_width + lane)])
        layout.kind[slot++].lane[lane] = *kinds.kind_of(end);
    }
  layout.stiffness = {};
  if (all) layout.tension = {};
}

/// Before a block all that it looks at, and its own, has to be there.
void note_loads(MeshLayout& layout) {
  int until = 0;
  for (int block = 0; block < layout.blocks; ++block) {
    const int first = block * kernels::block_slices,
              last = std::min(first + kernels::block_slices, layout.slices);
    until = std::max(until, last * slice_width);
    for (int slot = layout.slot_begin[static_cast<std::size_t>(first)];
         slot < layout.slot_begin[static_cast<std::size_t>(last)]; ++slot)
      for (const int offset : layout.neighbour[static_cast<std::size_t>(slot)].lane)
        if (offset != 4 * kernels::padding_index(layout.slices))
          until = std::max(until, (offset / 4 / slice_width + 1) * slice_width);
    layout.load_until.push_back(until);
  }
}

}  // namespace

kernels::MeshSlots MeshLayout::slots() const {
  kernels::MeshSlots slots;
  slots.slot_begin = slot_begin.data();
  slots.neighbour = reinterpret_cast<const int*>(neighbour.data());
  if (!kind.empty()) slots.kind = reinterpret_cast<const unsigned char*>(kind.data());
  if (!stiffness.empty()) slots.stiffness = reinterpret_cast<const double*>(stiffness.data());
  if (!tension.empty()) slots.tension = reinterpret_cast<const double*>(tension.data());
  std::copy(stiffness_of_kind.begin(), stiffness_of_kind.end(), slots.stiffness_of_kind);
  std::copy(tension_of_kind.begin(), tension_of_kind.end(), slots.tension_of_kind);
  return slots;
}

MeshLayout make_mesh_layout(const ClothSystem& system) {
  MeshLayout layout;
  layout.particles = static_cast<int>(system.mass.size());
  layout.slices = (layout.particles + slice_width - 1) / slice_width;
  layout.blocks = (layout.particles + block_width - 1) / block_width;
  if (!serves_as_it_is(system)) layout.order = order_for_sweeps(system);
  const auto springs = springs_of_lanes(
      system, layout.order, static_cast<std::size_t>(layout.slices) * static_cast<std::size_t>(slice_width));
  layout.slot_begin.push_back(0);
  for (int slice = 0; slice < layout.slices; ++slice)
    append_slice(springs.data() + slice * slice_width, layout);
  use_tables(springs, layout);
  note_loads(layout);
  return layout;
}

bool suits_mesh_layout(const ClothSystem& system) {
  constexpr std::size_t shortest_run = 16;
  return system.springs.spring_count() < shortest_run * system.springs.size();
}

}  // namespace cloth

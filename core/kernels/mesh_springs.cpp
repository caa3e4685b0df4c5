#include "kernels/mesh_springs.h"

#include <algorithm>
#include <cstdint>

#include "kernels/instruction_set.h"

namespace cloth {

std::vector<const MeshKernel*> supported_mesh_kernels() {
  std::vector<const MeshKernel*> kernels{&baseline_mesh_kernel()};
#if defined(__x86_64__)
  if (__builtin_cpu_supports("avx2")) kernels.push_back(&avx2_mesh_kernel());
  if (__builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq") &&
      __builtin_cpu_supports("avx512vl"))
    kernels.push_back(&avx512_mesh_kernel());
#endif
  return kernels;
}

const MeshKernel& chosen_mesh_kernel() {
  const std::vector<const MeshKernel*> kernels = supported_mesh_kernels();
  return **std::find_if(kernels.rbegin(), kernels.rend(),
                        [](const MeshKernel* kernel) { return may_run(kernel->name); });
}

bool MeshSprings::suits(const ClothSystem& system) {
  constexpr std::int64_t shortest_run = 16;
  std::int64_t springs = 0;
  for (const SpringRun& run : system.springs) springs += run.count;
  return springs < shortest_run * static_cast<std::int64_t>(system.springs.size());
}

MeshSprings::MeshSprings(const ClothSystem& system, const MeshKernel& kernel)
    : layout_(make_mesh_layout(system)),
      kernel_(&kernel),
      position_(static_cast<std::size_t>(layout_.slices) * slice_width),
      force_(position_.size()) {}

MeshArrays MeshSprings::arrays() {
  return {.slot_begin = layout_.slot_begin.data(),
          .neighbour = reinterpret_cast<const int*>(layout_.neighbour.data()),
          .stiffness = reinterpret_cast<const double*>(layout_.stiffness.data()),
          .tension = reinterpret_cast<const double*>(layout_.tension.data()),
          .position = reinterpret_cast<double*>(position_.data()),
          .force = reinterpret_cast<double*>(force_.data())};
}

void MeshSprings::add_forces(const Vec3Field& position, Vec3Field& force) {
  const MeshArrays mesh = arrays();
  MeshSweep through{.load_until = layout_.load_until.data(),
                    .store_until = layout_.store_until.data(),
                    .x = position.x(),
                    .y = position.y(),
                    .z = position.z(),
                    .fx = force.x(),
                    .fy = force.y(),
                    .fz = force.z(),
                    .loaded = 0,
                    .stored = 0};
  for (const MeshLayout::Block block : layout_.sequence)
    kernel_->sweep(mesh, through, block.begin, block.end);
}

void MeshSprings::add_forces(const Vec3Field& position, Vec3Field& force, int threads, const RunParts& run) {
  const MeshArrays mesh = arrays();
  const auto share = [threads](int part, int of) {  // where a part of `of` things begins
    return static_cast<int>(static_cast<std::int64_t>(of) * part / threads);
  };
  const auto particles = [&](int part) {
    return std::min(share(part, layout_.slices) * slice_width, layout_.particles);
  };
  run(threads, [&](int part) {
    kernel_->load(position.x(), position.y(), position.z(), particles(part), particles(part + 1), mesh);
  });
  for (const auto& blocks : layout_.colours)
    run(threads, [&](int part) {
      const int of = static_cast<int>(blocks.size());
      for (int b = share(part, of); b < share(part + 1, of); ++b) {
        const MeshLayout::Block block = blocks[static_cast<std::size_t>(b)];
        kernel_->add_springs(mesh, block.begin, block.end);
      }
    });
  run(threads, [&](int part) {
    kernel_->store(mesh, particles(part), particles(part + 1), force.x(), force.y(), force.z());
  });
}

}  // namespace cloth

// What a simulation takes beside the time of its steps: memory, and the time until its first step is done.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "bench/speed/interleaved_timing.h"

namespace cloth::speed {

/// Bytes per particle of a simulation after its first step.
struct MemoryCost {
  std::string method, feature;  ///< of the scene, see speed_scenes.h
  int size = 0;                 ///< particles along an edge
  std::optional<double> held;   ///< allocated and not given back; none where the C library does not count
  std::optional<double> peak;  ///< most resident memory on the way there; none where the system does not tell
};

/// Of the hanging cloth with the feature of this name, on one thread. Precondition: no other thread allocates
/// meanwhile.
MemoryCost measure_memory(const std::string& method, const std::string& feature, int size);

struct StartCost {
  std::string what;
  Spread milliseconds;
  int samples = 0;
  std::string remark;  ///< why there are none
};

/// From starting `program` with `arguments` as a process of its own, its output thrown away, to its end.
StartCost measure_start(const std::string& what, const std::filesystem::path& program,
                        const std::vector<std::string>& arguments, int repeats);

/// Making a simulation of `size` x `size` particles, its first step and its first measurement.
/// `top_edge`: with the whole upper edge pinned and a deformation rate of 10 %.
StartCost measure_opening(int size, bool top_edge, int repeats);

}  // namespace cloth::speed

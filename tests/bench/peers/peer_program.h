// A run of a cloth in another library, by a program of its own (bullet_main.cpp).
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "cloth/cloth_system.h"
#include "scene/scene.h"

namespace cloth::peers {

/// What one run is to do.
struct PeerTask {
  std::string model;     ///< of the program's own names
  double time_step = 0;  ///< s
  std::int64_t steps = 0;
  int samples = 0;  ///< states that are wanted after the start; 0: none, the time alone
  int iterations = 1;
};

struct PeerAnswer {
  std::string failure;             ///< not empty: there is nothing else
  std::string version;             ///< of the library
  double seconds = 0;              ///< of processor time for the steps alone
  std::vector<double> masses;      ///< kg, 0 where pinned; with samples
  std::vector<ClothState> states;  ///< the start, then after every steps / samples steps; with samples
};

/// Runs `program` to its end; never throws.
PeerAnswer run_peer(const std::filesystem::path& program, const Scene& scene, int particles,
                    const PeerTask& task);

/// What the program printed. Public for tests.
PeerAnswer read_answer(const std::string& output, int particles, const PeerTask& task);

}  // namespace cloth::peers

// What a run leaves in its folder beside record.csv: its last state and its summary.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>

#include "cloth/cloth_system.h"
#include "io/file_digest.h"
#include "simulation/energy_account.h"
#include "simulation/outcome.h"

namespace cloth {

/// final_state.csv: particle,x_m,y_m,z_m,vx_m_s,vy_m_s,vz_m_s
std::string state_csv(const ClothState& state);

struct RunSummary {
  std::string scene_hash;
  std::string title;
  std::string method;
  double time_step = 0;  ///< s
  StepCount count;       ///< steps, force evaluations and what else they took
  int particles = 0;
  double simulated = 0;       ///< s
  double wall = 0;            ///< s, of stepping alone
  double max_strain = 0;      ///< largest of all rows
  EnergyAccount energy;       ///< of all rows
  double limiter_excess = 0;  ///< largest of all rows
  Status status = Status::finished;
  std::optional<Divergence> divergence;
  std::optional<RateBreach> rate_breach;
  std::vector<StepChange> step_changes;  ///< where "auto" has shortened the step
  std::string notice;                    ///< e.g. a rate that the pins make unreachable
  int threads = 1;
  std::vector<FileDigest> files{};  ///< that lie beside summary.json

  double nanoseconds_per_particle_step() const;
};

/// What summary.json says of a deformation rate that was not kept.
nlohmann::ordered_json breach_json(const RateBreach& breach);

/// summary.json
std::string summary_json(const RunSummary& summary);

}  // namespace cloth

// Probes: what a scene asks to be measured, at particles or of the cloth's whole shape. A probe only looks
// on: the motion is the same to the bit with and without it. Each becomes columns of record.csv, probe.NAME.…
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "params/parameter.h"
#include "params/problem.h"

namespace cloth {

struct ClothSheet;
struct Scene;

/// A particle by its place on a grid, also of a round one; of a mesh the vertex `column`, and row 0.
struct ParticlePlace {
  int row = 0, column = 0;
  bool operator==(const ParticlePlace&) const = default;
};

enum class ProbeMeasure { particle, distance, angle, line, lowest_point, extent, shadow, drape, droop, rest };

/// Which members matter depends on `measure`; probe_fields(measure) and ProbeFacts list them.
struct Probe {
  std::string name;
  ProbeMeasure measure = ProbeMeasure::particle;
  std::vector<ParticlePlace> particles = {};  ///< of a line on a grid its two ends
  double radius = 0.09;                       ///< drape: of the disc under the cloth, m
  double bound = 1e-6;                        ///< rest: of the kinetic energy, J
  bool operator==(const Probe&) const = default;
};

/// One value of a measure.
struct ProbeValue {
  const char* key;    ///< end of the column's name: "x_m"
  const char* label;  ///< for people: "x"
  const char* unit;   ///< SI; empty for a pure number
  const char* doc;    ///< what it is, and where its cell is empty
};

struct ProbeFacts {
  ProbeMeasure measure;
  const char* name;   ///< in scene files: "lowest-point"
  const char* title;  ///< for people: "Lowest point"
  const char* doc;    ///< one sentence
  std::size_t least_particles, most_particles;
  std::vector<ProbeValue> values;
  bool is_of_particles() const { return most_particles > 0; }
};

/// Every measure, once; the place in the list is the number of the measure.
const std::vector<ProbeFacts>& probe_facts();
const ProbeFacts& facts_of(ProbeMeasure measure);

/// Name, and what the measure has beside particles.
const Fields<Probe>& probe_fields(ProbeMeasure measure);

/// "probe.tip.x_m"
std::string probe_column(const Probe& probe, const ProbeValue& value);

/// The columns of all probes, in the order of record.csv.
std::vector<std::string> probe_columns(const std::vector<Probe>& probes);

/// "tip: x" and "m" for "probe.tip.x_m", the unit empty for a pure number; nullopt for what is no such
/// column.
struct ProbeColumnWords {
  std::string label, unit;
};
std::optional<ProbeColumnWords> words_of_probe_column(const std::string& column);

/// The numbers in the cloth of a probe's particles; of a line on a grid all from end to end. Precondition:
/// find_probe_problems() has nothing against the probe.
std::vector<int> probed_particles(const ClothSheet& cloth, const Probe& probe);

/// Where on the grid, or which vertex of a mesh, a particle is.
ParticlePlace place_of(const ClothSheet& cloth, int particle);

/// The end nearest to `to` of a row, column or diagonal from `from` that lies in the cloth, a grid; `from`
/// itself where there is no other.
ParticlePlace straight_end(const ClothSheet& cloth, const ParticlePlace& from, const ParticlePlace& to);

/// A name that no probe of these has: "angle-1".
std::string free_probe_name(const std::vector<Probe>& probes, ProbeMeasure measure);

/// What is wrong with the probes of a scene: names, particles, places. Precondition: the cloth has a size.
std::vector<Problem> find_probe_problems(const Scene& scene);

/// Those probes that this cloth has particles for: what is left when a grid gets smaller or another mesh.
std::vector<Probe> probes_inside(const ClothSheet& cloth, const std::vector<Probe>& probes);

/// A sentence for each probe that this scene gives nothing to measure.
std::vector<std::string> probe_notices(const Scene& scene);

}  // namespace cloth

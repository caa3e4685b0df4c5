// Cusick's drape test of the built-in fabrics beside what was published of such fabrics.
#include <algorithm>

#include "scene/material_file.h"
#include "study/validation/drape_case.h"
#include "study/validation/protocols.h"

namespace cloth {
namespace {

constexpr int cells_of_seeds = 64;
constexpr std::uint64_t first_seed = 1, seed_count = 5;

/// What was published, and where.
struct PublishedDrape {
  const char* fabric;
  ValueBand coefficient;
  const char* source;
};
constexpr PublishedDrape published_drapes[] = {
    {"cotton-broad", {0.829, 0.829}, "Matsudaira et al. 2015, one specimen"},
    {"polyester-faille", {0.283, 0.283}, "Matsudaira et al. 2015, one specimen"},
    {"wool-tropical", {0.40, 0.70}, "what is usual of wool"},
    {"11oz-black-denim", {0.70, 0.90}, "what is usual of denim"}};

const PublishedDrape* published_of(const std::string& fabric) {
  const auto* found = std::find_if(std::begin(published_drapes), std::end(published_drapes),
                                   [&](const PublishedDrape& one) { return one.fabric == fabric; });
  return found == std::end(published_drapes) ? nullptr : found;
}

/// A fabric as it is, or without its hysteresis.
struct DrapedFabric {
  std::string preset;
  bool is_elastic = true;
  bool has_hysteresis = false;  ///< measured
  std::string name() const { return preset + (is_elastic && has_hysteresis ? ", elastic" : ""); }
  Material material() const {
    Material m = builtin_material(preset).material;
    if (is_elastic) m.hysteresis_warp = m.hysteresis_weft = 0;
    return m;
  }
};

/// Those that springs on square cells can be; with hysteresis and without, where it was measured.
const std::vector<DrapedFabric>& draped_fabrics() {
  static const auto fabrics = [] {
    std::vector<DrapedFabric> fitting;
    for (const BuiltinMaterial& one : builtin_materials()) {
      const Material m = builtin_material(one.name).material;
      const bool has_hysteresis = m.hysteresis_warp > 0 || m.hysteresis_weft > 0;
      if (m.shear > largest_shear(m, 1, 1)) continue;
      fitting.push_back({one.name, true, has_hysteresis});
      if (has_hysteresis) fitting.push_back({one.name, false, true});
    }
    return fitting;
  }();
  return fabrics;
}

const DrapedFabric& fabric_of(const ValidationRow& row) {
  const auto& all = draped_fabrics();
  return *std::find_if(all.begin(), all.end(),
                       [&](const DrapedFabric& one) { return one.name() == row.parameter_text; });
}

DrapeFacts facts_of(const DrapeReading& reading) {
  return {reading.drape.folds, reading.drape.amplitude, reading.locking.cells_above};
}

ValidationRow expected_drape(double parameter) {
  ValidationRow row{.quantity = "drape coefficient: the shadow beyond the disc over the flat cloth beyond it",
                    .source = "none published",
                    .method =
                        "rests by Newton's method from the flat cloth, moved at random by up to 2 mm; "
                        "with hysteresis the weight comes in twenty parts",
                    .is_measured = true,
                    .promise = Promise::none,
                    .seed_cells = cells_of_seeds};
  const DrapedFabric& fabric = draped_fabrics().at(static_cast<std::size_t>(parameter));
  row.parameter_text = fabric.name();
  if (const PublishedDrape* published = published_of(fabric.preset))
    row.band = published->coefficient, row.source = published->source;
  return row;
}

ValidationReading drape_on(const ValidationRow& row, int cells, const StopTest& stop) {
  const DrapeReading reading = measure_drape_of(fabric_of(row).material(), cells, first_seed, stop);
  return {.value = reading.drape.coefficient, .failure = reading.failure, .drape = facts_of(reading)};
}

/// The first seed's is known from the grids.
bool measure_other_seeds(ValidationRow& row, const StopTest& stop) {
  for (const ValidationValue& grid : row.grids)
    if (grid.cells == row.seed_cells && grid.drape)
      row.seeds.push_back({first_seed, grid.value, *grid.drape});
  for (std::uint64_t seed = first_seed + 1; seed < first_seed + seed_count; ++seed) {
    const DrapeReading reading = measure_drape_of(fabric_of(row).material(), row.seed_cells, seed, stop);
    if (is_to_stop(stop)) return false;
    if (!reading.failure.empty()) continue;  // fewer are listed
    row.seeds.push_back({seed, reading.drape.coefficient, facts_of(reading)});
  }
  return true;
}

}  // namespace

std::vector<ValidationProtocol> drape_protocols() {
  ValidationProtocol protocol{"drape", "material", {}, expected_drape, drape_on};
  protocol.cells = {32, 64, 96, 128};
  protocol.measure_seeds = measure_other_seeds;
  for (std::size_t k = 0; k < draped_fabrics().size(); ++k)
    protocol.parameters.push_back(static_cast<double>(k));
  return {protocol};
}

}  // namespace cloth

// Reads the outputs of a sweep's plan.
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "params/problem.h"
#include "study/run_output.h"

namespace cloth {

/// The member "outputs" of a plan; measured curves lie beside it, in `folder`. `paths`: what the plan varies,
/// whose names are taken. Adds its problems.
std::vector<RunOutput> read_sweep_outputs(const nlohmann::ordered_json& plan,
                                          const std::filesystem::path& folder,
                                          const std::vector<std::string>& paths,
                                          std::vector<Problem>& problems);

/// A field of a CSV file that is a finite number.
bool read_table_number(const std::string& text, double& number);

}  // namespace cloth

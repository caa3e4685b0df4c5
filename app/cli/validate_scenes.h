// clothlab-cli validate --scene: scenes against the points that their block `measured` names.
#pragma once

#include <string>
#include <vector>

namespace clothlab::cli {

struct SceneChecks {
  std::vector<std::string> scenes, settings;
  std::vector<int> cells;
  std::string folder;
  int threads = 0;  ///< 0: as many as the machine has
  bool json = false;
};

int validate_scenes(const SceneChecks& checks);

}  // namespace clothlab::cli

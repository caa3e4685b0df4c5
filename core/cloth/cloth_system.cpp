#include "cloth/cloth_system.h"

namespace cloth {

const char* name_of(SpringFamily family) {
  switch (family) {
    case SpringFamily::structural:
      return "structural";
    case SpringFamily::shear:
      return "shear";
    case SpringFamily::flexion:
      return "flexion";
  }
  return "";
}

std::int64_t ClothSystem::spring_count(SpringFamily family) const {
  std::int64_t count = 0;
  for (const SpringRun& run : springs)
    if (run.family == family) count += run.count;
  return count;
}

}  // namespace cloth

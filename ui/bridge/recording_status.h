// How a recording goes, of one simulation or of a comparison.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

namespace clothlab {

struct RecordingStatus {
  bool recording = false;
  std::filesystem::path recording_folder;
  std::int64_t recorded_rows = 0;
  std::string recording_error;
};

}  // namespace clothlab

// Small scenes and files for tests of the worker.
#pragma once

#include <chrono>
#include <filesystem>
#include <functional>
#include <thread>

#include "bridge/run_worker.h"
#include "io/text_file.h"
#include "scene/builtin_scenes.h"

namespace clothlab::test {

/// A folder of its own that is gone afterwards.
class ScratchFolder {
 public:
  ScratchFolder() {
    std::string pattern = (std::filesystem::temp_directory_path() / "clothlab-XXXXXX").string();
    path_ = ::mkdtemp(pattern.data());
  }
  ~ScratchFolder() { std::filesystem::remove_all(path_); }
  ScratchFolder(const ScratchFolder&) = delete;
  ScratchFolder& operator=(const ScratchFolder&) = delete;
  std::filesystem::path operator/(const char* name) const { return path_ / name; }

 private:
  std::filesystem::path path_;
};

inline cloth::Scene small_scene() {
  cloth::Scene scene = cloth::builtin_scene("wind");
  scene.cloth.columns = scene.cloth.rows = 9;
  scene.duration = 0.5;
  return scene;
}

inline std::string text_of(const std::filesystem::path& path) {
  std::string text;
  cloth::read_text_file(path, text);
  return text;
}

/// Looks again and again until `condition` holds; gives up after a minute, which only a fault takes.
inline bool eventually(const std::function<bool()>& condition) {
  const auto patience = std::chrono::steady_clock::now() + std::chrono::seconds(60);
  while (!condition()) {
    if (std::chrono::steady_clock::now() > patience) return false;
    std::this_thread::sleep_for(std::chrono::milliseconds(2));
  }
  return true;
}

}  // namespace clothlab::test

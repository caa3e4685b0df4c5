// The reader of scenes: any bytes are answered with a scene or with problems that have a place.
#include <cstdint>
#include <cstdlib>
#include <string>

#include "contact/start_check.h"
#include "fuzz/small_scene.h"
#include "scene/scene_json.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string text(reinterpret_cast<const char*>(data), size);
  if (!cloth::test::stays_small(text)) return -1;
  const cloth::SceneReading reading = cloth::read_runnable_scene(text, "x.json");
  if (reading.scene.has_value() != reading.problems.empty()) std::abort();
  for (const cloth::Problem& problem : reading.problems)
    if (problem.line < 1 || problem.column < 1 || problem.rule.empty()) std::abort();
  if (!reading.scene) return 0;
  const cloth::SceneReading again = cloth::read_runnable_scene(cloth::write_scene(*reading.scene), "x.json");
  if (!again.scene || *again.scene != *reading.scene) std::abort();
  cloth::test::take_few_steps(*reading.scene);
  return 0;
}

// The reader of sessions, and the replay of what it read.
#include <cstdint>
#include <cstdlib>
#include <string>

#include "fuzz/small_scene.h"
#include "simulation/recorder.h"
#include "simulation/session_json.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string text(reinterpret_cast<const char*>(data), size);
  if (!cloth::test::stays_small(text)) return -1;
  const cloth::SessionReading reading = cloth::read_session(text, "x.session.json");
  if (reading.session.has_value() != reading.problems.empty()) std::abort();
  for (const cloth::Problem& problem : reading.problems)
    if (problem.line < 1 || problem.column < 1 || problem.rule.empty()) std::abort();
  if (!reading.session) return 0;
  const cloth::Session& session = *reading.session;
  if (!cloth::read_session(cloth::write_session(session), "x.session.json").session) std::abort();
  constexpr int max_particles = 100, max_steps = 20;
  const cloth::Scene& scene = session.scene;
  const bool is_short = scene.cloth.rows * scene.cloth.columns <= max_particles && session.steps <= max_steps;
  if (is_short && !scene.contact && !scene.self_contact && scene.integrator.time_step)
    cloth::replay(session, {});
  return 0;
}

// clothlab-bullet and clothlab-bullet-single: one run of a cloth in Bullet, for clothlab-bench --peers.
//
//     clothlab-bullet MODEL TIME_STEP STEPS SAMPLES ITERATIONS < SCENE
//
// Prints a line with the version of Bullet and one with the processor time of the steps in s; then, with
// SAMPLES above 0, the masses and the states at the start and after every STEPS / SAMPLES steps as doubles
// (study/reference_solution.h, bytes_of). A program of its own for each precision, since both libraries have
// the same names.
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <iostream>
#include <iterator>
#include <string>

#include "bench/peers/bullet_cloth.h"
#include "scene/scene_cloth.h"
#include "scene/scene_json.h"
#include "study/reference_solution.h"

namespace {

using namespace cloth;
using namespace cloth::peers;

struct Task {
  BulletSettings settings;
  long steps = 0, samples = 0;
};

double processor_seconds() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

int fail(const std::string& message) {
  std::cerr << "clothlab-bullet: " << message << "\n";
  return 2;
}

bool read_task(char** words, Task& task) {
  bool known = false;
  for (int k = 0; k < 4; ++k)
    if (std::string(words[1]) == bullet_model_names[k])
      task.settings.model = static_cast<BulletModel>(k), known = true;
  task.settings.time_step = std::atof(words[2]);
  task.steps = std::atol(words[3]);
  task.samples = std::atol(words[4]);
  task.settings.iterations = std::atoi(words[5]);
  return known && task.settings.time_step > 0 && task.steps >= 0 && task.samples >= 0 &&
         task.settings.iterations >= 1;
}

ClothState state_of(const BulletCloth& cloth, std::size_t particles) {
  ClothState state{.position = Vec3Field(particles), .velocity = Vec3Field(particles)};
  cloth.copy_to(state.position, state.velocity);
  return state;
}

int run(const Task& task, const SpringList& list) {
  {
    BulletCloth warming(list, task.settings);
    for (long k = 0; k < std::min(task.steps, 20L); ++k) warming.step();
  }
  BulletCloth cloth(list, task.settings);
  const std::size_t particles = list.mass.size();
  std::vector<ClothState> states{state_of(cloth, particles)};
  double seconds = 0;
  const long parts = std::max(1L, task.samples);
  for (long part = 1; part <= parts; ++part) {
    const long steps = task.steps * part / parts - task.steps * (part - 1) / parts;
    const double before = processor_seconds();
    for (long k = 0; k < steps; ++k) cloth.step();
    seconds += processor_seconds() - before;
    states.push_back(state_of(cloth, particles));
  }
  std::printf("%s\n%.9g\n", BulletCloth::version().c_str(), seconds);
  if (task.samples > 0) {
    const std::vector<double> masses = cloth.masses();
    const std::string bytes = bytes_of(states);
    std::fwrite(masses.data(), sizeof(double), masses.size(), stdout);
    std::fwrite(bytes.data(), 1, bytes.size(), stdout);
  }
  return std::fflush(stdout) == 0 ? 0 : 4;
}

}  // namespace

int main(int argc, char** argv) {
  Task task;
  if (argc != 6 || !read_task(argv, task)) return fail("MODEL TIME_STEP STEPS SAMPLES ITERATIONS < SCENE");
  const std::string text{std::istreambuf_iterator<char>(std::cin), {}};
  const SceneReading reading = read_scene(text, "standard input");
  if (!reading.scene) return fail("standard input is no scene");
  const SpringList list = spring_list(make_cloth(*reading.scene), gravity_of(*reading.scene));
  if (const std::string broken = broken_bullet_rule(list); !broken.empty()) return fail(broken);
  return run(task, list);
}

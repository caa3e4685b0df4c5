#include "bench/speed/process_costs.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <spawn.h>
#include <sys/wait.h>

#include <chrono>
#include <cstring>
#include <fstream>

#ifdef __GLIBC__
#include <malloc.h>
#endif

#include "bench/speed/speed_scenes.h"
#include "simulation/simulation.h"

extern char** environ;

namespace cloth::speed {
namespace {

using Clock = std::chrono::steady_clock;

double milliseconds_since(Clock::time_point start) {
  return std::chrono::duration<double, std::milli>(Clock::now() - start).count();
}

/// Bytes that the program has allocated and not given back.
std::optional<double> allocated_bytes() {
#if defined(__GLIBC__) && (__GLIBC__ > 2 || __GLIBC_MINOR__ >= 33)
  const struct mallinfo2 info = mallinfo2();
  if (info.uordblks + info.hblkhd > 0)  // another allocator stands in: nothing is known
    return static_cast<double>(info.uordblks) + static_cast<double>(info.hblkhd);
#endif
  return std::nullopt;
}

/// A line of /proc/self/status, "VmHWM: 1234 kB", in bytes.
std::optional<double> status_bytes(const std::string& key) {
  std::ifstream file("/proc/self/status");
  for (std::string line; std::getline(file, line);)
    if (line.rfind(key + ":", 0) == 0) return 1024 * std::atof(line.c_str() + key.size() + 1);
  return std::nullopt;
}

/// Gives free memory back to the system and begins a new peak of resident memory. False: it cannot.
bool begin_peak() {
#ifdef __GLIBC__
  malloc_trim(0);
#endif
  std::ofstream file("/proc/self/clear_refs");
  file << "5";
  file.close();
  return static_cast<bool>(file);
}

/// Runs `program` to its end. Its exit code, or nothing if it could not be started.
std::optional<int> run_silently(const std::filesystem::path& program,
                                const std::vector<std::string>& arguments) {
  std::vector<std::string> words{program.string()};
  words.insert(words.end(), arguments.begin(), arguments.end());
  std::vector<char*> pointers;
  for (std::string& word : words) pointers.push_back(word.data());
  pointers.push_back(nullptr);

  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  for (const int stream : {1, 2})
    posix_spawn_file_actions_addopen(&actions, stream, "/dev/null", O_WRONLY, 0);
  pid_t child = 0;
  const int failure = posix_spawn(&child, words[0].c_str(), &actions, nullptr, pointers.data(), environ);
  posix_spawn_file_actions_destroy(&actions);
  if (failure != 0) return std::nullopt;
  int status = 0;
  while (waitpid(child, &status, 0) < 0)
    if (errno != EINTR) return std::nullopt;
  return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
}

}  // namespace

MemoryCost measure_memory(const std::string& method, const std::string& feature, int size) {
  MemoryCost cost{.method = method, .feature = feature, .size = size, .held = {}, .peak = {}};
  const double particles = static_cast<double>(size) * size;
  const Scene scene = hanging_cloth(size, method, feature_named(feature));
  const bool has_peak = begin_peak();
  const auto held_before = allocated_bytes(), resident_before = status_bytes("VmRSS");
  Simulation simulation(scene);
  simulation.step();
  const auto held = allocated_bytes(), peak = status_bytes("VmHWM");
  if (held && held_before) cost.held = (*held - *held_before) / particles;
  if (has_peak && peak && resident_before) cost.peak = (*peak - *resident_before) / particles;
  return cost;
}

StartCost measure_start(const std::string& what, const std::filesystem::path& program,
                        const std::vector<std::string>& arguments, int repeats) {
  StartCost cost{.what = what, .milliseconds = {}, .samples = 0, .remark = {}};
  std::vector<double> times;
  for (int k = -1; k < repeats; ++k) {  // the first one brings the program into memory
    const auto start = Clock::now();
    const auto code = run_silently(program, arguments);
    const double taken = milliseconds_since(start);
    if (code != 0) {
      cost.remark = code ? fmt::format("{} ended with exit code {}", program.string(), *code)
                         : fmt::format("{} could not be started", program.string());
      return cost;
    }
    if (k >= 0) times.push_back(taken);
  }
  cost.samples = repeats;
  cost.milliseconds = spread_of(std::move(times));
  return cost;
}

StartCost measure_opening(int size, bool top_edge, int repeats) {
  Scene scene = hanging_cloth(size, "verlet", top_edge ? feature_named("limit-10") : bare_feature());
  if (top_edge) scene.cloth.pins = {NamedPin::top_edge};
  std::vector<double> times;
  for (int k = 0; k < repeats; ++k) {
    const auto start = Clock::now();
    Simulation simulation(scene);
    simulation.step();
    simulation.measure();
    times.push_back(milliseconds_since(start));
  }
  return {.what = fmt::format("open {0} x {0}, {1}", size,
                              top_edge ? "upper edge pinned, limit to 10 %" : "two corners pinned"),
          .milliseconds = spread_of(std::move(times)),
          .samples = repeats,
          .remark = {}};
}

}  // namespace cloth::speed

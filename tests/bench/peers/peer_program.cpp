#include "bench/peers/peer_program.h"

#include <fmt/format.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cmath>
#include <cstdlib>
#include <cstring>

#include "scene/scene_json.h"
#include "study/reference_solution.h"

extern char** environ;

namespace cloth::peers {
namespace {

struct Pipe {
  std::array<int, 2> ends{-1, -1};
  bool open() { return pipe(ends.data()) == 0; }
  void close_end(std::size_t which) {
    if (ends[which] >= 0) close(ends[which]);
    ends[which] = -1;
  }
  ~Pipe() { close_end(0), close_end(1); }
};

bool write_all(int to, const std::string& text) {
  for (std::size_t done = 0; done < text.size();) {
    const ssize_t written = write(to, text.data() + done, text.size() - done);
    if (written < 0 && errno != EINTR) return false;
    if (written > 0) done += static_cast<std::size_t>(written);
  }
  return true;
}

std::string read_all(int from) {
  std::string text;
  std::array<char, 1 << 16> buffer;
  for (;;) {
    const ssize_t count = read(from, buffer.data(), buffer.size());
    if (count == 0 || (count < 0 && errno != EINTR)) return text;
    if (count > 0) text.append(buffer.data(), static_cast<std::size_t>(count));
  }
}

PeerAnswer failed(const std::string& why) {
  return {.failure = why, .version = {}, .seconds = 0, .masses = {}, .states = {}};
}

/// The program's standard output; `failure` where it did not end well.
std::string output_of(std::vector<std::string> words, const std::string& input, std::string& failure) {
  Pipe in, out;
  if (!in.open() || !out.open()) {
    failure = "there are no more file descriptors";
    return "";
  }
  write_all(in.ends[1], input);  // a scene is shorter than a pipe holds: nobody need read yet
  in.close_end(1);
  std::vector<char*> pointers;
  for (std::string& word : words) pointers.push_back(word.data());
  pointers.push_back(nullptr);
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_adddup2(&actions, in.ends[0], 0);
  posix_spawn_file_actions_adddup2(&actions, out.ends[1], 1);
  for (const Pipe* each : {&in, &out})
    for (const int end : each->ends)
      if (end >= 0) posix_spawn_file_actions_addclose(&actions, end);
  pid_t child = 0;
  const int error = posix_spawn(&child, words[0].c_str(), &actions, nullptr, pointers.data(), environ);
  posix_spawn_file_actions_destroy(&actions);
  in.close_end(0), out.close_end(1);
  if (error != 0) {
    failure = fmt::format("{} could not be started: {}", words[0], std::strerror(error));
    return "";
  }
  std::string text = read_all(out.ends[0]);
  int status = 0;
  while (waitpid(child, &status, 0) < 0 && errno == EINTR) {
  }
  if (WIFSIGNALED(status))
    failure = fmt::format("it was ended by signal {}", WTERMSIG(status));
  else if (WEXITSTATUS(status) != 0)
    failure = fmt::format("it ended with exit code {}", WEXITSTATUS(status));
  return text;
}

bool is_finite(const std::vector<ClothState>& states) {
  for (const ClothState& state : states)
    for (const double value : state.position.flat())
      if (!std::isfinite(value)) return false;
  return true;
}

}  // namespace

PeerAnswer read_answer(const std::string& output, int particles, const PeerTask& task) {
  const std::size_t first = output.find('\n');
  const std::size_t second = first == std::string::npos ? first : output.find('\n', first + 1);
  if (second == std::string::npos) return failed("it printed no time");
  PeerAnswer answer;
  answer.version = output.substr(0, first);
  answer.seconds = std::atof(output.c_str() + first + 1);
  if (task.samples == 0) return answer;
  const std::size_t begin = second + 1, count = static_cast<std::size_t>(particles);
  if (output.size() < begin + count * sizeof(double)) return failed("its states are cut off");
  answer.masses.resize(count);
  std::memcpy(answer.masses.data(), output.data() + begin, count * sizeof(double));
  const double end = task.time_step * static_cast<double>(task.steps);
  answer.states =
      states_from(output.substr(begin + count * sizeof(double)), particles, task.samples + 1, end);
  if (answer.states.empty()) return failed("its states are cut off");
  for (int k = 0; k <= task.samples; ++k)
    answer.states[static_cast<std::size_t>(k)].time = end * k / task.samples;
  if (!is_finite(answer.states)) answer.failure = "diverged";
  return answer;
}

PeerAnswer run_peer(const std::filesystem::path& program, const Scene& scene, int particles,
                    const PeerTask& task) {
  std::string failure;
  const std::string output =
      output_of({program.string(), task.model, fmt::format("{:.17g}", task.time_step),
                 std::to_string(task.steps), std::to_string(task.samples), std::to_string(task.iterations)},
                write_scene(scene), failure);
  if (!failure.empty()) return failed(failure);
  return read_answer(output, particles, task);
}

}  // namespace cloth::peers

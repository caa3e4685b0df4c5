#include "io/process.h"

#include <fcntl.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <exception>
#include <filesystem>
#include <fstream>
#include <new>
#include <stdexcept>
#include <system_error>

namespace cloth {
namespace {

struct LastWords {
  const char* program = "";
  int memory = 1, defect = 1;
};
LastWords last_words;

std::atomic<std::size_t> refused_memory{0};  // bytes; 0: none was noted

/// Takes no memory. `text` has room for it.
void describe_lack(char* text, std::size_t room) {
  const std::size_t bytes = refused_memory.exchange(0);
  if (bytes == 0)
    std::snprintf(text, room, "there is not enough memory for this");
  else
    std::snprintf(text, room, "there is not enough memory for this: %.6g MB were asked for at once",
                  static_cast<double>(bytes) / 1e6);
}

void write_error(const char* text) {
  [[maybe_unused]] const ssize_t written = ::write(STDERR_FILENO, text, std::strlen(text));
}

/// Takes no memory: there may be none.
[[noreturn]] void end_now() {
  int code = last_words.defect;
  write_error(last_words.program);
  try {
    if (const std::exception_ptr thrown = std::current_exception()) std::rethrow_exception(thrown);
    write_error(": stopped by a defect of the program\n");
  } catch (const std::bad_alloc&) {
    char text[100];
    describe_lack(text, sizeof text);
    code = last_words.memory;
    write_error(": ");
    write_error(text);
    write_error("\n");
  } catch (const std::exception& error) {
    write_error(": stopped by a defect of the program: ");
    write_error(error.what());
    write_error("\n");
  } catch (...) {
    write_error(": stopped by a defect of the program\n");
  }
  std::_Exit(code);
}

/// A line of /proc/meminfo or /proc/self/status, "MemAvailable:   123 kB", in bytes.
std::optional<double> entry_of(const char* file, const std::string& name) {
  std::ifstream lines(file);
  for (std::string line; std::getline(lines, line);)
    if (line.rfind(name + ":", 0) == 0) return 1024 * std::strtod(line.c_str() + name.size() + 1, nullptr);
  return std::nullopt;
}

/// A file with one number; nothing where it says "max" or is not there.
std::optional<double> number_in(const char* file) {
  std::ifstream stream(file);
  double number = 0;
  if (!(stream >> number)) return std::nullopt;
  return number;
}

}  // namespace

void settle_standard_streams() {
  // The lowest free number is the one that open() gives: after 0, 1 is the next that may be free.
  for (const int stream : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO})
    if (::fcntl(stream, F_GETFD) < 0) {
      const int opened = ::open("/dev/null", stream == STDIN_FILENO ? O_WRONLY : O_RDONLY);
      if (opened >= 0 && opened != stream) ::close(opened);
    }
  std::signal(SIGPIPE, SIG_IGN);
  std::signal(SIGXFSZ, SIG_IGN);
}

void end_by_exit_code(const char* program, int memory, int defect) {
  last_words = {program, memory, defect};
  std::set_terminate(end_now);
}

void note_refused_memory(std::size_t bytes) {
  refused_memory = bytes;
}

Failure failure_in_hand() {
  try {
    throw;
  } catch (const std::bad_alloc&) {
    char text[100];
    describe_lack(text, sizeof text);
    return {text};
  } catch (const std::length_error&) {
    return {"there is not enough memory for this: a list of it would be longer than any memory"};
  } catch (const std::filesystem::filesystem_error& error) {
    return {error.path1().string() + ": " + error.code().message()};
  } catch (const std::system_error& error) {
    return {error.what()};
  } catch (const std::exception& error) {
    return {std::string("stopped by a defect of the program: ") + error.what(), true};
  } catch (...) {
    return {"stopped by a defect of the program", true};
  }
}

std::optional<double> available_memory() {
  std::optional<double> least = entry_of("/proc/meminfo", "MemAvailable");
  const auto note = [&](double bytes) { least = std::max(0.0, std::min(bytes, least.value_or(bytes))); };
  rlimit limit{};
  if (::getrlimit(RLIMIT_AS, &limit) == 0 && limit.rlim_cur != RLIM_INFINITY)
    note(static_cast<double>(limit.rlim_cur) - entry_of("/proc/self/status", "VmSize").value_or(0));
  if (::getrlimit(RLIMIT_DATA, &limit) == 0 && limit.rlim_cur != RLIM_INFINITY)
    note(static_cast<double>(limit.rlim_cur) - entry_of("/proc/self/status", "VmData").value_or(0));
  const auto group = number_in("/sys/fs/cgroup/memory.max"),
             used = number_in("/sys/fs/cgroup/memory.current");
  if (group && used) note(*group - *used);
  return least;
}

std::string host_name() {
  std::array<char, 256> name{};
  return ::gethostname(name.data(), name.size() - 1) == 0 ? name.data() : "";
}

}  // namespace cloth

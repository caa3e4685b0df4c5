#include "io/machine.h"

#include <fmt/format.h>

#include <ctime>
#include <fstream>
#include <thread>

#if __has_include(<sys/utsname.h>)
#include <sys/utsname.h>
#endif

namespace cloth {
namespace {

/// What follows the separator in the first line that begins with the key; empty if there is none.
std::string value_in(const char* path, const std::string& key, char separator) {
  std::ifstream file(path);
  for (std::string line; std::getline(file, line);) {
    if (line.rfind(key, 0) != 0) continue;
    const std::size_t at = line.find(separator);
    if (at == std::string::npos) continue;
    std::string value = line.substr(at + 1);
    value.erase(0, value.find_first_not_of(" \t\""));
    value.erase(value.find_last_not_of(" \t\"\r") + 1);
    return value;
  }
  return "";
}

std::string kernel() {
#if __has_include(<sys/utsname.h>)
  utsname names{};  // nodename, the machine's own name, stays in here
  if (uname(&names) == 0) return fmt::format("{} {} {}", names.sysname, names.release, names.machine);
#endif
  return "";
}

std::string operating_system() {
  const std::string name = value_in("/etc/os-release", "PRETTY_NAME", '='), core = kernel();
  if (name.empty()) return core.empty() ? "unknown" : core;
  return core.empty() ? name : name + ", " + core;
}

std::string now() {
  const std::time_t time = std::time(nullptr);
  std::tm utc{};
  if (!gmtime_r(&time, &utc)) return "unknown";
  return fmt::format("{:04}-{:02}-{:02}T{:02}:{:02}:{:02}Z", utc.tm_year + 1900, utc.tm_mon + 1, utc.tm_mday,
                     utc.tm_hour, utc.tm_min, utc.tm_sec);
}

}  // namespace

std::string version() {
  return CLOTHLAB_VERSION;
}

std::string compiler_name() {
  return CLOTHLAB_COMPILER;
}

std::string build_type() {
  return CLOTHLAB_BUILD_TYPE;
}

std::string processor_name() {
  for (const char* key : {"model name", "Hardware", "cpu model"})
    if (const std::string name = value_in("/proc/cpuinfo", key, ':'); !name.empty()) return name;
  return "unknown";
}

MachineFacts machine_facts() {
  MachineFacts facts;
  facts.processor = processor_name();
  facts.cores = int(std::thread::hardware_concurrency());
  facts.operating_system = operating_system();
  facts.compiler = compiler_name();
  facts.flags = CLOTHLAB_FLAGS;
  facts.build_type = build_type();
  facts.version = version();
  facts.date = now();
  return facts;
}

std::vector<std::pair<std::string, std::string>> fact_rows(const MachineFacts& facts) {
  return {{"Processor", facts.processor},
          {"Cores", facts.cores > 0 ? fmt::format("{}", facts.cores) : "unknown"},
          {"Operating system", facts.operating_system},
          {"Compiler", facts.compiler},
          {"Build", facts.build_type},
          {"Flags", facts.flags},
          {"Clothlab", facts.version},
          {"Date", facts.date}};
}

}  // namespace cloth

// Where and with what a report was made. Never the machine's name or the user's.
#pragma once

#include <string>
#include <utility>
#include <vector>

namespace cloth {

struct MachineFacts {
  std::string processor;         // "unknown" where the system does not tell
  int cores = 0;                 // logical ones; 0: unknown
  std::string operating_system;  // name and kernel
  std::string compiler;          // of the engine
  std::string flags;             // of the engine
  std::string build_type;
  std::string version;  // of Clothlab
  std::string date;     // UTC, ISO 8601, to the second
};

MachineFacts machine_facts();

std::string version();         // of Clothlab
std::string compiler_name();   // of the engine, with its version
std::string build_type();      // of the engine
std::string processor_name();  // "unknown" where the system does not tell

/// In words, for a table or the head of a file.
std::vector<std::pair<std::string, std::string>> fact_rows(const MachineFacts& facts);

}  // namespace cloth

// Runs clothlab-cli in a shell and keeps what it said.
#pragma once

#include <string>

namespace cloth::test {

struct CommandResult {
  int exit_code = -1;  ///< 128 + n where signal n ended it
  std::string output;  ///< standard output
  std::string errors;  ///< standard error
};

/// `"$CLI"` in `command` is the program. A command that takes over a minute is ended: exit code 124.
CommandResult shell(const std::string& command);

/// clothlab-cli with these arguments.
CommandResult cli(const std::string& arguments);

}  // namespace cloth::test

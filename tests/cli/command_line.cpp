#include "cli/command_line.h"

#include <sys/wait.h>

#include <cstdlib>

#include "io/text_file.h"
#include "support/files.h"

namespace cloth::test {

CommandResult shell(const std::string& command) {
  const TemporaryFolder folder;
  const std::string script = "CLI='" CLOTHLAB_CLI "'\n" + command + "\n";
  if (write_text_file(folder / "script", script)) return {};
  const std::string line = "timeout 60 sh '" + (folder / "script").string() + "' > '" +
                           (folder / "out").string() + "' 2> '" + (folder / "err").string() + "' < /dev/null";
  const int status = std::system(line.c_str());
  CommandResult result;
  result.exit_code = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
  result.output = content_of(folder / "out");
  result.errors = content_of(folder / "err");
  return result;
}

CommandResult cli(const std::string& arguments) {
  return shell("\"$CLI\" " + arguments);
}

}  // namespace cloth::test

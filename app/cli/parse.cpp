#include "parse.h"

#include <sstream>

#include "console.h"
#include "io/printable.h"
#include "io/run_folder.h"
#include "kernels/instruction_set.h"

namespace clothlab::cli {
namespace {

/// What the parser says, and its exit code: help and the version are asked for, all else is bad usage.
int answer(const CLI::App& app, const CLI::ParseError& error) {
  std::ostringstream output, errors;
  const bool asked_for = app.exit(error, output, errors) == 0;
  write_error(cloth::printable_lines(errors.str()));
  if (const int printed = print(output.str()); printed != done) return printed;
  return asked_for ? done : bad_input;
}

}  // namespace

std::optional<int> parse(CLI::App& app, int argc, char** argv) {
  app.set_version_flag("--version", cloth::version());
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return answer(app, error);
  }
  if (const std::string problem = cloth::instruction_set_problem(); !problem.empty()) {
    say(problem);
    return bad_input;
  }
  return std::nullopt;
}

CLI::Validator is_name() {
  return CLI::Validator(
      [](const std::string& name) { return name.empty() ? std::string("must be a name") : std::string(); },
      "");
}

}  // namespace clothlab::cli

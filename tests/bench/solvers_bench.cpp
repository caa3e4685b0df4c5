// clothlab-solvers-bench: the linear systems of implicit Euler by our solvers, CHOLMOD and hypre's BoomerAMG.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <CLI/CLI.hpp>
#include <cstdio>

#include "bench/solvers/solver_study.h"

namespace {

using namespace cloth::solvers;

constexpr int not_built = 7;  ///< no library to compare with is in this build

}  // namespace

int main(int argc, char** argv) {
  SolverOptions options;
  bool as_json = false, as_markdown = false;
  CLI::App app{
      "What the linear systems of implicit Euler cost by our solvers, and by CHOLMOD and hypre where this "
      "program was built with them. Exit code 7 where it was built with neither.",
      "clothlab-solvers-bench"};
  app.add_option("--sizes", options.sizes, "Particles along an edge")
      ->delimiter(',')
      ->capture_default_str()
      ->check(CLI::Range(5, 1024));
  app.add_option("--residual", options.residual, "Relative residual that each is to reach")
      ->capture_default_str()
      ->check(CLI::Range(1e-10, 0.1));
  app.add_option("--repeats", options.repeats, "Timings of each phase")
      ->capture_default_str()
      ->check(CLI::Range(1, 1000));
  app.add_flag("--quick", options.quick, "Short timings: a look, not a measurement");
  CLI::Option* json = app.add_flag("--json", as_json, "Give the result as one JSON object");
  app.add_flag("--markdown", as_markdown, "Print the tables as Markdown")->excludes(json);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : 2;
  }
  const std::vector<std::string> missing = missing_libraries();
  if (missing.size() == 2) {
    fmt::print(
        stderr,
        "clothlab-solvers-bench: this program was built without CHOLMOD and hypre: install {}, configure "
        "and build again\n",
        fmt::join(missing, " or "));
    return not_built;
  }
  try {
    if (!as_json)  // what is finished is there to read while the larger systems take their minutes
      options.partial = [&](const SolverReport& report) {
        if (report.tables.size() == 1) fmt::print("{}", solver_head(report, as_markdown));
        fmt::print("{}", solver_text(report.tables.back(), as_markdown));
        std::fflush(stdout);
      };
    const SolverReport report = study_solvers(options);
    if (as_json) fmt::print("{}", solver_json(report));
  } catch (const std::exception& error) {
    fmt::print(stderr, "clothlab-solvers-bench: {}\n", error.what());
    return 1;
  }
  return 0;
}

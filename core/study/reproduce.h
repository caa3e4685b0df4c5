// The source report's own results, measured here: its figures, its table, and its misprints shown by
// experiment. One self-contained report.html, its pictures as files beside it.
#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "io/text_file.h"

namespace cloth {

/// One number of the report, with what theory or the literature expects where it does.
struct Measured {
  std::string part, name;
  std::string unit;  ///< empty: a pure number
  double value = 0;
  std::optional<double> expected;
};

struct ReproduceProgress {
  std::string part;
  double fraction = 0;  ///< of the whole
};

struct ReproduceOptions {
  std::filesystem::path folder{};
  std::vector<std::string> only{};  ///< of reproduce_parts(); empty: all
  /// Called often; false stops: what is done by then is written.
  std::function<bool(const ReproduceProgress&)> progress{};
  bool overwrite = false;  ///< begin anew where an unfinished reproduction of other parts lies
  /// Told once where an unfinished one goes on: how many of its parts are there.
  std::function<void(int parts)> goes_on{};
};

struct ReproduceResult {
  std::vector<Measured> numbers;
  std::vector<std::string> files;  ///< names in the folder
  bool stopped = false;
  std::optional<IoError> io_error;
};

/// fig1, fig2, ..., table1, equal-error, errata: in the order of the report.
std::vector<std::string> reproduce_parts();

/// Each finished part is in the folder before the next begins. An unfinished reproduction there goes on after
/// its last whole part, if it is of the same parts, version, instruction set and processor.
///
/// Precondition: every name in `only` is one of reproduce_parts().
ReproduceResult reproduce(const ReproduceOptions& options);

}  // namespace cloth

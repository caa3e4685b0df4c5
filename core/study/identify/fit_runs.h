// The runs of a fit in a file, so that one that was stopped goes on: its search takes the same steps again,
// and finds the runs that were made. Lines are JSON; the first one says what the runs are of.
//
//     {"format":"clothlab/fit-runs/1","model":"9f...","version":"0.3.0","instruction_set":"avx2"}
//     {"values":[120.5],"outputs":[0.31]}
#pragma once

#include <map>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "io/line_file.h"

namespace cloth {

class FitRuns {
 public:
  /// `model`: hash of what the outputs of a run depend on, beside the values of its parameters.
  explicit FitRuns(std::string model) : model_(std::move(model)) {}

  /// Takes the runs of a file of the same model, engine and instruction set, as far as its lines are whole.
  /// False: there is no such file.
  bool read(const std::filesystem::path& path);

  /// Writes what was read to the file, and from then on every run that is added.
  std::optional<IoError> open(const std::filesystem::path& path);

  /// The outputs of the run with these values; empty where it gave none. nullopt: it is to be made.
  std::optional<std::vector<double>> find(const std::vector<double>& values) const;

  /// From any thread.
  void add(const std::vector<double>& values, const std::vector<double>& outputs);

  std::size_t read_count() const { return read_; }  ///< runs of the file

  /// Why a run could not be written; none follows then.
  std::optional<IoError> error() const;

 private:
  std::string first_line() const;

  std::string model_;
  std::map<std::vector<double>, std::vector<double>> runs_;
  std::size_t read_ = 0;
  LineFile file_;
  std::optional<IoError> error_;
  mutable std::mutex mutex_;
};

}  // namespace cloth

// One function per command, in a file of its own. Each returns the program's exit code.
#pragma once

#include <limits>
#include <optional>
#include <string>
#include <vector>

namespace clothlab::cli {

struct RunArguments {
  std::string scene;
  std::vector<std::string> settings;
  std::string folder;
  std::string obj;  ///< a file for the cloth after the last step; empty: none
  int threads = 0;  ///< 0: as many as the machine has
  bool json = false;
};
int run(const RunArguments& arguments);

struct ReplayArguments {
  std::string session;
  std::string folder;
  double until = std::numeric_limits<double>::infinity();  ///< s
  bool json = false;
};
int replay(const ReplayArguments& arguments);

struct ScenesArguments {
  std::string name;
  bool json = false;
};
int scenes(const ScenesArguments& arguments);

struct MeshArguments {
  std::string name;
};
int mesh(const MeshArguments& arguments);

struct ExplainArguments {
  std::string scene;
  std::vector<std::string> settings;
  bool json = false;
};
int explain(const ExplainArguments& arguments);

struct CompareArguments {
  std::string file;   ///< or a built-in comparison
  std::string scene;  ///< without a file: this scene, a pane for each of `methods`
  std::vector<std::string> methods;
  std::vector<std::string> settings;
  std::optional<double> duration;  ///< s
  std::string reference;           ///< empty: the comparison's own
  std::string folder;
  int threads = 1;
  bool list = false, json = false;
};
int compare(const CompareArguments& arguments);

struct StabilityArguments {
  std::string scene;
  std::vector<std::string> settings;
  std::string x, y;                  ///< PATH=LOW:HIGH:COUNT[:log]; empty: time step over stiffness
  std::vector<std::string> methods;  ///< empty: those with a limit
  double periods = 200;
  int most_steps = 20000;
  bool full_size = false;
  std::string folder;
  bool overwrite = false;  ///< an unfinished study of other inputs
  bool json = false;
};
int stability(const StabilityArguments& arguments);

struct ExtremesArguments {
  std::string scene;  ///< to push; empty: the fixed list
  std::vector<std::string> settings;
  std::string methods, cases;  ///< names between commas; empty: all
  std::string folder;
  bool overwrite = false;  ///< an unfinished study of other inputs
  bool json = false, markdown = false;
};
int extremes(const ExtremesArguments& arguments);

struct StudyArguments {
  std::string folder;
  bool json = false, csv = false;
};
int study(const StudyArguments& arguments);

struct ReproduceArguments {
  std::string folder;
  std::vector<std::string> only;
  bool overwrite = false;  ///< an unfinished reproduction of other parts
  bool json = false;
};
int reproduce(const ReproduceArguments& arguments);

struct WorkPrecisionArguments {
  std::string scene;
  std::vector<std::string> settings;
  std::vector<std::string> methods;  ///< empty: all
  std::optional<double> horizon;     ///< s
  int repeats = 5;
  std::string folder;
  bool overwrite = false;  ///< an unfinished study of other inputs
  bool json = false;
};
int work_precision(const WorkPrecisionArguments& arguments);

int schema(bool of_comparison);
int parameters();

}  // namespace clothlab::cli

// clothlab-cli: the engine without Qt and without a display.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include "commands.h"
#include "console.h"
#include "parse.h"
#include "study/reproduce.h"

namespace {

namespace cli = clothlab::cli;

const char* const scene_help = "A scene file or the name of a built-in scene";
const char* const set_help =
    "Set a parameter, PATH=VALUE, e.g. springs.structural=500; null takes a block out, e.g. air=null; may be "
    "repeated";
const char* const overwrite_help =
    "Begin anew where the folder holds an unfinished study; without it that goes on if it has the same "
    "inputs, "
    "and is left alone if not";
const char* const json_help = "Give the result as one JSON object";

const char* const footer =
    "CLOTHLAB_INSTRUCTION_SET=portable, sse2, avx2 or avx512 in the environment makes the kernels use that "
    "instruction set instead of the processor's best.\n"
    "Exit codes: 0 done; 1 a defect of the program; 2 bad input or usage; 3 the run diverged (everything up "
    "to the last good state is "
    "on disk), or did not keep its deformation rate; "
    "4 a file could not be read or written, or there is not enough memory; 5 a replay did not end in its "
    "session's state; 130 interrupted.";

struct Arguments {
  cli::RunArguments run;
  cli::ReplayArguments replay;
  cli::ScenesArguments scenes;
  cli::MeshArguments mesh;
  cli::ExplainArguments explain;
  cli::CompareArguments compare;
  bool comparison_schema = false;
  cli::StabilityArguments stability;
  cli::ExtremesArguments extremes;
  cli::StudyArguments study;
  cli::ReproduceArguments reproduce;
  cli::WorkPrecisionArguments work_precision;
};

void add_work_precision(CLI::App& app, cli::WorkPrecisionArguments& arguments) {
  CLI::App* study = app.add_subcommand("work-precision", "Error against run time of every method on a scene");
  study->add_option("scene", arguments.scene, scene_help)->required();
  study->add_option("--set", arguments.settings, set_help)->allow_extra_args(false);
  study->add_option("--methods", arguments.methods, "Only these methods, e.g. verlet,rk4")->delimiter(',');
  study->add_option("--horizon", arguments.horizon, "Simulated time in s; chosen from the scene if not given")
      ->check(CLI::PositiveNumber);
  study->add_option("--repeats", arguments.repeats, "Timed repeats of each run")
      ->check(CLI::Range(5, 1000))
      ->capture_default_str();
  study->add_option("--out", arguments.folder,
                    "Folder for work_precision.csv, work_precision_samples.csv, work_precision.svg, "
                    "study.json and report.html; made if missing");
  study->add_flag("--overwrite", arguments.overwrite, overwrite_help);
  study->add_flag("--json", arguments.json, json_help);
}

void add_compare(CLI::App& app, cli::CompareArguments& arguments) {
  CLI::App* compare = app.add_subcommand(
      "compare",
      "Two to four methods, steps or values on one scene, in lock step: differences and a ranking");
  CLI::Option* file =
      compare->add_option("comparison", arguments.file, "A .compare.json file or a built-in comparison");
  CLI::Option* scene = compare->add_option("--scene", arguments.scene,
                                           "Without a file: this scene, a pane for each of --methods");
  CLI::Option* methods =
      compare->add_option("--methods", arguments.methods, "Two to four methods, e.g. verlet,rk4")
          ->delimiter(',')
          ->allow_extra_args(false);
  scene->needs(methods)->excludes(file);
  methods->needs(scene);
  compare->add_option("--set", arguments.settings, set_help)->allow_extra_args(false);
  compare->add_option("--duration", arguments.duration, "Simulated time in s, instead of the scene's")
      ->check(CLI::PositiveNumber);
  compare->add_option("--reference", arguments.reference,
                      "What differences are measured from: the name of a pane, controlled (the shared scene "
                      "under error control) or none");
  compare->add_option("--out", arguments.folder,
                      "Folder for A.csv, B.csv, ..., compare.csv, comparison.json, summary.json, compare.svg "
                      "and report.html; made if missing. A comparison is one run: after an interruption the "
                      "same command begins anew");
  compare
      ->add_option("--threads", arguments.threads,
                   "Panes that step at the same time; with more than one, costs contain what they take from "
                   "each other")
      ->check(CLI::Range(1, 64))
      ->capture_default_str();
  compare->add_flag("--list", arguments.list, "List the built-in comparisons");
  compare->add_flag("--json", arguments.json, json_help);
}

void add_stability(CLI::App& app, cli::StabilityArguments& arguments) {
  CLI::App* stability = app.add_subcommand(
      "stability", "Map where each method is stable over two parameters, with the predicted limits over it");
  stability->add_option("scene", arguments.scene, scene_help)->required();
  stability->add_option("--set", arguments.settings, set_help)->allow_extra_args(false);
  stability->add_option("--x", arguments.x,
                        "PATH=LOW:HIGH:COUNT or PATH=LOW:HIGH:COUNT:log; without it the time step around the "
                        "predicted limits");
  stability->add_option("--y", arguments.y,
                        "Likewise; without it springs.*, all stiffnesses together, a tenth to ten times the "
                        "scene's. springs.* is the structural stiffness, shear and flexion in proportion");
  stability
      ->add_option("--methods", arguments.methods,
                   "Methods, separated by commas; without it all that have a limit")
      ->delimiter(',')
      ->allow_extra_args(false);
  stability->add_option("--periods", arguments.periods, "Length of a run in periods of the fastest motion")
      ->check(CLI::Range(1.0, 1e6))
      ->capture_default_str();
  stability
      ->add_option("--most-steps", arguments.most_steps,
                   "After so many steps a run ends, however long it should last")
      ->check(CLI::Range(1, 100000000))
      ->capture_default_str();
  stability->add_flag(
      "--full-size", arguments.full_size,
      "Run the whole grid; without it larger ones are run with 16 x 16 of the same particles");
  stability
      ->add_option("--out", arguments.folder,
                   "Folder for stability.csv, stability.svg, study.json and report.html; made if missing")
      ->required();
  stability->add_flag("--overwrite", arguments.overwrite, overwrite_help);
  stability->add_flag("--json", arguments.json, json_help);
}

void add_extremes(CLI::App& app, cli::ExtremesArguments& arguments) {
  CLI::App* extremes = app.add_subcommand(
      "extremes", "Stiff and extreme cases, every method on each: a fixed list, or a scene pushed");
  CLI::Option* scene = extremes->add_option(
      "scene", arguments.scene, "A scene to push in one thing at a time; without it the fixed list of cases");
  extremes->add_option("--set", arguments.settings, set_help)->allow_extra_args(false)->needs(scene);
  extremes->add_option("--methods", arguments.methods, "Methods, between commas; all without");
  extremes->add_option("--cases", arguments.cases, "Cases, between commas; all without");
  extremes->add_option("--out", arguments.folder,
                       "Folder for extremes.csv, extremes.svg, study.json and report.html; made if missing");
  extremes->add_flag("--overwrite", arguments.overwrite, overwrite_help);
  CLI::Option* extremes_json = extremes->add_flag("--json", arguments.json, json_help);
  extremes->add_flag("--markdown", arguments.markdown, "Print the table as Markdown")
      ->excludes(extremes_json)
      ->excludes(scene);
}

void add_study(CLI::App& app, cli::StudyArguments& arguments) {
  CLI::App* study = app.add_subcommand(
      "study", "Print the table of a study's folder, whether the command line or the window wrote it");
  study->add_option("folder", arguments.folder, "A folder with a study.json")->required();
  CLI::Option* json = study->add_flag("--json", arguments.json, json_help);
  study->add_flag("--csv", arguments.csv, "Print every run as CSV")->excludes(json);
}

void add_reproduce(CLI::App& app, cli::ReproduceArguments& arguments) {
  CLI::App* reproduce = app.add_subcommand(
      "reproduce", "Measure the source report's figures, its Table 1 and its errata; one report.html");
  reproduce->add_option("--out", arguments.folder, "Folder for report.html and its pictures")->required();
  reproduce
      ->add_option("--only", arguments.only,
                   "Only these parts, separated by commas: " +
                       fmt::format("{}", fmt::join(cloth::reproduce_parts(), ", ")))
      ->delimiter(',')
      ->check(CLI::IsMember(cloth::reproduce_parts()));
  reproduce->add_flag("--overwrite", arguments.overwrite, overwrite_help);
  reproduce->add_flag("--json", arguments.json, json_help);
}

void add_replay(CLI::App& app, cli::ReplayArguments& arguments) {
  CLI::App* replay =
      app.add_subcommand("replay", "Carry out a saved session again and compare its end, to the bit");
  replay->add_option("session", arguments.session, "A session file")->required();
  replay->add_option("--out", arguments.folder,
                     "Folder for scene.json, record.csv, final_state.csv and summary.json; made if missing");
  replay->add_option("--until", arguments.until, "End at the step nearest to this time in s")
      ->check(CLI::NonNegativeNumber);
  replay->add_flag("--json", arguments.json, json_help);
}

void add_commands(CLI::App& app, Arguments& arguments) {
  CLI::App* run = app.add_subcommand("run", "Run a scene to its duration");
  run->add_option("scene", arguments.run.scene, scene_help)->required();
  run->add_option("--set", arguments.run.settings, set_help)->allow_extra_args(false);
  run->add_option("--out", arguments.run.folder,
                  "Folder for scene.json, record.csv, final_state.csv and summary.json; made if missing");
  run->add_option("--obj", arguments.run.obj,
                  "OBJ file for the cloth after the last step, with normals; of a grid also texture "
                  "coordinates");
  run->add_option("--threads", arguments.run.threads,
                  "Threads that a step may use; without it all cores. The results are the same to the bit. "
                  "They are used while they are seen to gain; summary.json says how many could be")
      ->check(CLI::Range(1, 1024));
  run->add_flag("--json", arguments.run.json, json_help);

  add_replay(app, arguments.replay);

  CLI::App* scenes = app.add_subcommand("scenes", "List the built-in scenes, or print one");
  scenes->add_option("name", arguments.scenes.name, "The scene to print");
  scenes->add_flag("--json", arguments.scenes.json, json_help);

  CLI::App* mesh = app.add_subcommand("mesh", "List the built-in meshes, or print one as an OBJ file");
  mesh->add_option("name", arguments.mesh.name, "The mesh to print");

  CLI::App* explain = app.add_subcommand(
      "explain",
      "The stages a scene is run with, what was left out and why, and each method's stable time step");
  explain->add_option("scene", arguments.explain.scene, scene_help)->required();
  explain->add_option("--set", arguments.explain.settings, set_help)->allow_extra_args(false);
  explain->add_flag("--json", arguments.explain.json, json_help);

  add_compare(app, arguments.compare);
  add_work_precision(app, arguments.work_precision);
  add_stability(app, arguments.stability);
  add_extremes(app, arguments.extremes);
  add_study(app, arguments.study);
  add_reproduce(app, arguments.reproduce);
  CLI::App* schema = app.add_subcommand("schema", "Print the JSON Schema of the scene file");
  schema->add_flag("--comparison", arguments.comparison_schema, "Of the comparison file instead");
  schema->add_flag("--json", json_help);
  app.add_subcommand("parameters", "Print the reference page of all parameters (Markdown)");
  for (CLI::App* command : app.get_subcommands({}))
    for (const char* name : {"--out", "--obj"})
      if (CLI::Option* option = command->get_option_no_throw(name)) option->check(cli::is_name());
}

int run_command(int argc, char** argv) {
  CLI::App app{
      "Clothlab on the command line: runs and explains cloth simulation scenes, and studies their methods.",
      "clothlab-cli"};
  app.require_subcommand(1);
  app.footer(footer);
  Arguments arguments;
  add_commands(app, arguments);
  if (const auto ended = cli::parse(app, argc, argv)) return *ended;
  if (app.got_subcommand("run")) return cli::run(arguments.run);
  if (app.got_subcommand("replay")) return cli::replay(arguments.replay);
  if (app.got_subcommand("scenes")) return cli::scenes(arguments.scenes);
  if (app.got_subcommand("mesh")) return cli::mesh(arguments.mesh);
  if (app.got_subcommand("explain")) return cli::explain(arguments.explain);
  if (app.got_subcommand("compare")) return cli::compare(arguments.compare);
  if (app.got_subcommand("stability")) return cli::stability(arguments.stability);
  if (app.got_subcommand("extremes")) return cli::extremes(arguments.extremes);
  if (app.got_subcommand("study")) return cli::study(arguments.study);
  if (app.got_subcommand("reproduce")) return cli::reproduce(arguments.reproduce);
  if (app.got_subcommand("work-precision")) return cli::work_precision(arguments.work_precision);
  if (app.got_subcommand("parameters")) return cli::parameters();
  return cli::schema(arguments.comparison_schema);
}

}  // namespace

const char* const clothlab::cli::program_name = "clothlab-cli";

int main(int argc, char** argv) {
  return cli::run_program([&] { return run_command(argc, argv); });
}

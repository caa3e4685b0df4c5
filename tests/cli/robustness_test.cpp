// No input, no closed stream and no lack of memory ends the program by a signal; and nothing that a file says
// reaches a terminal as a command.
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <nlohmann/json.hpp>

#include "cli/command_line.h"
#include "io/text_file.h"
#include "support/files.h"

namespace cloth::test::robustness_test {
namespace {

const std::string quick = "run pendulum --set duration=0.05 ";

bool has(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

std::string quoted(const std::filesystem::path& path) {
  return "'" + path.string() + "'";
}

void put(const std::filesystem::path& file, const std::string& text) {
  ASSERT_FALSE(write_text_file(file, text));
}

void expect_exit(const CommandResult& result, int code, const std::string& what) {
  EXPECT_EQ(result.exit_code, code) << what << "\n" << result.output << result.errors;
}

std::string nested(int levels) {
  return std::string(static_cast<std::size_t>(levels), '[') + std::string(static_cast<std::size_t>(levels), ']');
}

TEST(NoInputEndsTheProgramByASignal, HoweverDeepItIsNested) {
  const TemporaryFolder folder;
  const std::string deep = nested(100'000);
  put(folder / "x.json", "{\"cloth\": " + deep + "}");
  put(folder / "study.json",
      "{\"format\": \"clothlab/study/1\", \"kind\": \"extremes\", \"scene\": " + deep + "}");
  for (const std::string& command : {"run " + quoted(folder / "x.json"), "explain " + quoted(folder / "x.json"),
                                     "replay " + quoted(folder / "x.json"), "compare " + quoted(folder / "x.json"),
                                     "study " + quoted(folder.path())}) {
    const CommandResult result = cli(command);
    expect_exit(result, 2, command);
    EXPECT_TRUE(has(result.errors, ".json:1:")) << result.errors;
    EXPECT_TRUE(has(result.errors, "nested too deeply")) << result.errors;
  }
  expect_exit(cli("run pendulum --set duration=" + nested(30'000)), 2, "a setting");
  std::string path = "duration";
  for (int k = 0; k < 30'000; ++k) path += ".a";
  expect_exit(cli("run pendulum --set " + path + "=1"), 2, "a long path");
}

TEST(NoInputEndsTheProgramByASignal, AndNestingTooDeepIsNamedAtItsPlace) {
  const TemporaryFolder folder;
  const std::string text = "{\"title\": \"[[{\",\n \"cloth\": " + nested(100) + "}";
  for (const char* name : {"x.json", "study.json"}) put(folder / name, text);
  for (const std::string& command :
       {"run " + quoted(folder / "x.json"), "replay " + quoted(folder / "x.json"),
        "compare " + quoted(folder / "x.json"), "study " + quoted(folder.path())}) {
    const CommandResult result = cli(command);
    expect_exit(result, 2, command);
    // The object is the first level: the 64th bracket of the second line opens the 65th.
    EXPECT_TRUE(has(result.errors, ".json:2:" + std::to_string(10 + 64) + ": is nested too deeply"))
        << result.errors;
  }
}

TEST(NoInputEndsTheProgramByASignal, WhateverNumbersAStudyHas) {
  const TemporaryFolder folder;
  const std::string at = quoted(folder / "s");
  expect_exit(cli("work-precision pendulum --methods verlet,rk4 --horizon 0.5 --out " + at), 0, "a study");
  const auto index = nlohmann::ordered_json::parse(content_of(folder / "s/study.json"));
  for (const char* pointer : {"/options/repeats", "/options/runs_per_method", "/reference/evaluations",
                              "/files/work_precision.csv/rows", "/files/work_precision.csv/bytes"})
    for (const char* value : {"1e30", "-1", "9223372036854775808", "1.5", "\"many\"", "null"}) {
      auto changed = index;
      changed[nlohmann::ordered_json::json_pointer(pointer)] = nlohmann::ordered_json::parse(value);
      put(folder / "s/study.json", changed.dump(1));
      const CommandResult result = cli("study " + at);
      expect_exit(result, 2, std::string(pointer) + " = " + value);
      EXPECT_TRUE(has(result.errors, ": must be a whole number")) << result.errors;
      EXPECT_TRUE(has(result.errors, "study.json:")) << result.errors;
    }
  auto far = index;
  far["options"]["horizon_s"] = 1e300;
  put(folder / "s/study.json", far.dump(1));
  const CommandResult result = cli("study " + at);
  expect_exit(result, 2, "a horizon");
  EXPECT_TRUE(has(result.errors, "options.horizon_s = 1e+300: must be <= 1e+09")) << result.errors;
  expect_exit(cli("work-precision pendulum --horizon 1e300"), 2, "a horizon");
}

TEST(NoInputEndsTheProgramByASignal, WhateverBytesItHas) {
  const TemporaryFolder folder;
  for (const std::string& text :
       {std::string("\xff\xfe{\0}\0", 6), std::string("{\"title\": \"\xc3\x28\", \"cloth\": {}}"),
        std::string("{\"title\": \"\\ud800\", \"cloth\": {}}"), std::string("{\"cloth\": {\"rows\": 1e400}}"),
        std::string("{\"cloth\": {\"rows\": 99999999999999999999}}"), std::string("\0", 1), std::string("[]"),
        std::string("{\"\": {\"\": 1}}"), std::string("{\"cloth\": {\"mesh\": \"\\u0000\"}}")}) {
    put(folder / "x.json", text);
    for (const char* command : {"run ", "explain ", "replay ", "compare "})
      expect_exit(cli(command + quoted(folder / "x.json")), 2, command + text);
  }
  const CommandResult title = shell("\"$CLI\" run pendulum --set \"title=$(printf '\\377')\"");
  expect_exit(title, 2, "a title");
  EXPECT_TRUE(has(title.errors, "--set: title = ")) << title.errors;
  EXPECT_TRUE(has(title.errors, "must be UTF-8 text")) << title.errors;
}

TEST(NoInputEndsTheProgramByASignal, WhereverItsLinksLead) {
  const TemporaryFolder folder;
  std::filesystem::create_symlink("b", folder / "a");
  std::filesystem::create_symlink("a", folder / "b");
  const std::string circle = quoted(folder / "a");
  for (const std::string& command : {"run " + circle, "explain " + circle, "replay " + circle,
                                     "compare " + circle, "study " + circle, quick + "--out " + circle,
                                     quick + "--obj " + circle, quick + "--obj " + circle + "/x.obj",
                                     "stability pendulum --out " + circle})
    expect_exit(cli(command), 4, command);
}

TEST(NoInputEndsTheProgramByASignal, HoweverLongItIs) {
  const CommandResult zeros = cli("run /dev/zero");
  expect_exit(zeros, 4, "/dev/zero");
  EXPECT_TRUE(has(zeros.errors, "too large")) << zeros.errors;
}

TEST(NoTimeIsTooLongOrTooShort, ForAnAnswer) {
  const std::pair<const char*, const char*> refused[] = {
      {"duration=1e20", "duration = 1e+20 s: must be <= 1e+09"},
      {"integrator.time_step=1e-19", "integrator.time_step = 1e-19 s: must be >= 1e-15"},
      {"record.interval=1e308", "record.interval = 1e+308 s: must be <= 1e+09"},
      {"integrator.time_step=1e-14", "a run may have at most 1e+12"},
      {"cloth.mass=1e-300", "cloth.mass = 1e-300 kg: must be >= 1e-12"},
      {"gravity=[0,-1e300,0]", "must be >= -1e+09"},
      {"springs.structural=1e300", "must be <= 1e+15"},
  };
  for (const auto& [setting, rule] : refused) {
    const CommandResult result = cli(std::string("run pendulum --set ") + setting);
    expect_exit(result, 2, setting);
    EXPECT_TRUE(has(result.errors, rule)) << result.errors;
  }
  expect_exit(cli(quick + "--set record.interval=1e9"), 0, "two rows");
  // With a step of its own making, the number of steps is known only when the step is.
  const CommandResult automatic = cli("run pendulum --set duration=1e9 --set springs.structural=1e15");
  expect_exit(automatic, 2, "automatic");
  EXPECT_TRUE(has(automatic.errors, "a run may have at most 1e+12")) << automatic.errors;
}

TEST(ADurationThatIsNoWholeNumberOfSteps, IsSaidByTheRunAndInItsSummary) {
  const std::string steps = "run pendulum --set integrator.time_step=0.001 ";
  const CommandResult uneven = cli(steps + "--set duration=0.0105 --json");
  expect_exit(uneven, 0, "uneven");
  EXPECT_TRUE(has(uneven.errors, "duration = 0.0105 s is no whole number of steps")) << uneven.errors;
  const auto summary = nlohmann::json::parse(uneven.output);
  EXPECT_TRUE(has(summary["notice"], "no whole number of steps"));
  EXPECT_EQ(summary["steps"], 11);
  EXPECT_EQ(cli(steps + "--set duration=0.01").errors, "");
}

TEST(ControlCharactersOfAFile, NeverReachATerminal) {
  const TemporaryFolder folder;
  const std::string escape = "\\u001b[31m\\u009b1m\\u007f\\u202e\\n";
  put(folder / "x.json", "{\"title\": \"" + escape +
                             "\", \"cloth\": {\"rows\": 3, \"columns\": 3}, \"springs\": {\"structural\": 10},"
                             " \"integrator\": {\"time_step\": 0.01}, \"duration\": 0.02}");
  put(folder / "bad.json", "{\"" + escape + "\": 1, \"title\": [\"" + escape + "\"], \"cloth\": 3}");
  put(folder / "mesh.obj", "v 0 0 0\nv \x1b[31m 0 0\n");
  put(folder / "mesh.json", "{\"cloth\": {\"mesh\": \"mesh.obj\"}}");
  const std::string scene = quoted(folder / "x.json"), results = quoted(folder / "r");
  for (const std::string& command :
       {"run " + scene + " --out " + results, "run " + scene + " --json", "explain " + scene,
        "explain " + scene + " --json", "run " + quoted(folder / "bad.json"), "run " + quoted(folder / "mesh.json"),
        std::string("run \"$(printf 'no\\033[31m')\""), std::string("run \"$(printf -- '--\\033[31m')\""),
        "stability " + scene + " --methods verlet --most-steps 100 --out " + results + "-s",
        "study " + results + "-s", "study " + results + "-s --json", "study " + results + "-s --csv"}) {
    const CommandResult result = cli(command);
    for (const std::string& text : {result.output, result.errors})
      for (const char* control : {"\x1b", "\x7f", "\xc2\x9b", "\xe2\x80\xae"})
        EXPECT_FALSE(has(text, control)) << command << "\n" << text;
    EXPECT_LT(result.exit_code, 126) << command;
  }
  EXPECT_EQ(nlohmann::json::parse(cli("explain " + scene + " --json").output)["title"],
            nlohmann::json::parse("\"" + escape + "\""));
}

TEST(AClosedStream, IsAnErrorAndNoSignal) {
  const TemporaryFolder folder;
  expect_exit(shell("\"$CLI\" " + quick + ">&-"), 4, "standard output");
  expect_exit(shell("\"$CLI\" scenes no-such-scene 2>&-"), 2, "standard error");
  expect_exit(shell("\"$CLI\" " + quick + "--out " + quoted(folder / "r") + " <&- >&- 2>&-"), 4, "all");
  EXPECT_EQ(content_of(folder / "r/record.csv").substr(0, 7), "time_s,") << "messages stay out of results";
  // The reader of the pipe is gone before anything is written.
  const CommandResult pipe = shell("{ sleep 0.3; \"$CLI\" scenes; echo \"code $?\" >&2; } | true");
  EXPECT_TRUE(has(pipe.errors, "Broken pipe")) << pipe.errors;
  EXPECT_TRUE(has(pipe.errors, "code 4")) << pipe.errors;
}

TEST(TooLittleMemory, ExitsWithFourAndSaysWhatWasAskedFor) {
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
  GTEST_SKIP() << "sanitizers map terabytes";
#endif
  const CommandResult large = shell(
      "ulimit -v 400000; \"$CLI\" run corners-free --set cloth.rows=4096 --set cloth.columns=4096 --set "
      "integrator.time_step=0.001");
  expect_exit(large, 4, "a large cloth");
  EXPECT_TRUE(has(large.errors, "not enough memory: a run of 16777216 particles")) << large.errors;
  const TemporaryFolder folder;
  const std::string sizes = " --set cloth.rows=4096 --set cloth.columns=4096";
  const std::string out = " --out " + quoted(folder / "none");
  for (const std::string& command :
       {"explain corners-free" + sizes, "stability corners-free --full-size" + sizes + out,
        "compare --scene corners-free --methods verlet,rk4" + sizes + out,
        "work-precision corners-free" + sizes + out, "extremes corners-free" + sizes + out}) {
    const CommandResult other = shell("ulimit -v 200000; \"$CLI\" " + command);
    expect_exit(other, 4, command);
    EXPECT_TRUE(has(other.errors, "not enough memory")) << other.errors;
    EXPECT_TRUE(has(other.errors, " MB ")) << other.errors;
    EXPECT_FALSE(std::filesystem::exists(folder / "none")) << command;
  }
  auto session = nlohmann::json::parse(R"({"format": "clothlab/session/1", "steps": 2, "commands": []})");
  session["scene"] = nlohmann::json::parse(cli("scenes corners-free").output);
  session["scene"]["cloth"]["rows"] = session["scene"]["cloth"]["columns"] = 4096;
  put(folder / "s.json", session.dump());
  const CommandResult replayed = shell("ulimit -v 200000; \"$CLI\" replay " + quoted(folder / "s.json"));
  expect_exit(replayed, 4, "a replay");
  EXPECT_TRUE(has(replayed.errors, "a run of 16777216 particles")) << replayed.errors;
  // What is not asked for before it is begun: a long text.
  put(folder / "long.json", std::string(100'000'000, ' '));
  const CommandResult text = shell("ulimit -v 100000; \"$CLI\" run " + quoted(folder / "long.json"));
  expect_exit(text, 4, "a text");
  EXPECT_TRUE(has(text.errors, "MB were asked for at once")) << text.errors;
  for (const int kilobytes : {300'000, 1'000'000, 3'000'000})
    expect_exit(shell("ulimit -v " + std::to_string(kilobytes) + "; \"$CLI\" " + quick + "--threads 1024"), 0,
                "threads within " + std::to_string(kilobytes) + " kB");
}

TEST(AnObjFile, IsWrittenThroughLinksAndNeverOverADevice) {
  const TemporaryFolder folder;
  put(folder / "target.obj", "old");
  ::chmod((folder / "target.obj").c_str(), 0640);
  std::filesystem::create_symlink("target.obj", folder / "link.obj");
  expect_exit(cli(quick + "--obj " + quoted(folder / "link.obj")), 0, "a link");
  EXPECT_TRUE(std::filesystem::is_symlink(folder / "link.obj"));
  EXPECT_EQ(content_of(folder / "target.obj").substr(0, 2), "# ");
  EXPECT_EQ(std::filesystem::status(folder / "target.obj").permissions(), std::filesystem::perms(0640));
  ::mkfifo((folder / "pipe").c_str(), 0600);
  for (const std::string& name : {std::string("/dev/null"), (folder / "pipe").string(), folder.path().string()})
    expect_exit(cli(quick + "--obj '" + name + "'"), 4, name);
}

}  // namespace
}  // namespace cloth::test::robustness_test

#include "simulation/session_json.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "contact/start_check.h"
#include "io/json_reader.h"
#include "io/json_syntax.h"
#include "scene/scene_checks.h"

namespace cloth {
namespace {

using json = nlohmann::ordered_json;
constexpr double largest_step = max_steps_of_run;

json vector_json(const Vec3& v) {
  return {v.x(), v.y(), v.z()};
}

json hand_json(const std::optional<BrushGust>& brush) {
  if (!brush) return nullptr;
  json matrix = json::array();
  for (int row = 0; row < 4; ++row)
    for (int column = 0; column < 4; ++column) matrix.push_back(brush->world_to_screen(row, column));
  return {{"velocity_m_s", vector_json(brush->velocity)},
          {"cursor_px", {brush->cursor.x(), brush->cursor.y()}},
          {"radius_px", brush->radius},
          {"world_to_screen", matrix}};
}

json hand_json(const std::optional<Pull>& pull) {
  if (!pull) return nullptr;
  return {{"particle", pull->particle}, {"target_m", vector_json(pull->target)}};
}

json edits_json(const Edits& edits) {
  json values = json::object();
  for (const SceneEdit& edit : edits) values[edit.path] = json::parse(edit.value);
  return values;
}

json command_json(const SessionCommand& command) {
  json entry{{"step", command.step}, {"time_s", command.time}};
  if (const auto* edits = std::get_if<Edits>(&command.action))
    entry["set"] = edits_json(*edits);
  else if (const auto* brush = std::get_if<std::optional<BrushGust>>(&command.action))
    entry["brush"] = hand_json(*brush);
  else
    entry["pull"] = hand_json(std::get<std::optional<Pull>>(command.action));
  return entry;
}

/// Takes a session's document apart. Problems are collected, never thrown.
class SessionReader : public JsonReader<json> {
 public:
  explicit SessionReader(SceneFolder folder) : folder_(std::move(folder)) {}

  Session read(const json& root) {
    Session session;
    if (!object(root, "")) return session;
    known_keys(
        root, "",
        {"format", "version", "scene", "steps", "time_s", "commands", "step_changes", "final_state_hash"});
    format(root, session_format);
    read_scene_part(root, session);
    session.steps = step(root, "", "steps").value_or(std::numeric_limits<std::int64_t>::max());
    number(root, "", "time_s", session.time);
    text(root, "", "version", session.version);
    text(root, "", "final_state_hash", session.final_state_hash);
    if (const json* commands = required(root, "", "commands")) read_commands(*commands, session);
    if (const json* changes = member(root, "step_changes")) read_step_changes(*changes, session);
    return session;
  }

 private:
  void read_scene_part(const json& root, Session& session) {
    const json* value = required(root, "", "scene");
    if (!value) return;
    SceneReading reading =
        read_runnable_scene(value->dump(-1, ' ', false, json::error_handler_t::replace), "", {}, {folder_});
    if (reading.scene) session.scene = std::move(*reading.scene);
    add_problems("scene", std::move(reading.problems));
  }

  std::optional<std::int64_t> step(const json& from, const std::string& path, const std::string& key) {
    const json* value = required(from, path, key);
    if (!value) return std::nullopt;
    if (value->is_number_integer() && value->get<double>() >= 0 && value->get<double>() <= largest_step)
      return value->get<std::int64_t>();
    problem(joined_path(path, key), *value,
            fmt::format("must be a whole number, >= 0 and <= {:g}", largest_step));
    return std::nullopt;
  }

  /// `count` numbers of a list, or nothing and a problem.
  std::vector<double> numbers(const json& from, const std::string& path, const std::string& key,
                              std::size_t count) {
    const json* value = required(from, path, key);
    if (!value) return {};
    const auto is_number = [](const json& entry) { return entry.is_number(); };
    if (value->is_array() && value->size() == count && std::all_of(value->begin(), value->end(), is_number))
      return value->get<std::vector<double>>();
    problem(joined_path(path, key), *value, fmt::format("must be a list of {} numbers", count));
    return {};
  }

  void read_commands(const json& commands, Session& session) {
    if (!list(commands, "commands")) return;
    std::int64_t earliest = 0;
    for (std::size_t i = 0; i < commands.size(); ++i) {
      const std::string path = fmt::format("commands.{}", i);
      if (!object(commands[i], path)) continue;
      SessionCommand& command = session.commands.emplace_back();
      if (const auto at = step(commands[i], path, "step")) {
        if (*at > session.steps)
          problem(path + ".step", *at, fmt::format("must be <= steps, {}", session.steps));
        if (*at < earliest) problem(path + ".step", *at, "must not be before the command above it");
        command.step = earliest = std::max(*at, earliest);
      }
      number(commands[i], path, "time_s", command.time);
      known_keys(commands[i], path, {"step", "time_s", "set", "brush", "pull"});
      read_action(commands[i], path, command.action);
    }
  }

  void read_step_changes(const json& changes, Session& session) {
    if (!list(changes, "step_changes")) return;
    for (std::size_t i = 0; i < changes.size(); ++i) {
      const std::string path = fmt::format("step_changes.{}", i);
      if (!object(changes[i], path)) continue;
      known_keys(changes[i], path, {"step", "time_s", "time_step_s"});
      StepChange& change = session.step_changes.emplace_back();
      change.step = step(changes[i], path, "step").value_or(0);
      number(changes[i], path, "time_s", change.time);
      number(changes[i], path, "time_step_s", change.time_step);
    }
  }

  void read_action(const json& command, const std::string& path, SessionAction& action) {
    const auto set = command.find("set"), brush = command.find("brush"), pull = command.find("pull");
    const auto end = command.end();
    if ((set != end) + (brush != end) + (pull != end) != 1) {
      add_problem(path, "must have one of set, brush, pull");
    } else if (set != end) {
      if (!object(*set, path + ".set")) return;
      Edits edits;
      for (const auto& [key, value] : set->items()) edits.push_back({key, value.dump()});
      action = std::move(edits);
    } else if (brush != end) {
      action = read_brush(*brush, path + ".brush");
    } else {
      action = read_pull(*pull, path + ".pull");
    }
  }

  std::optional<BrushGust> read_brush(const json& value, const std::string& path) {
    if (value.is_null() || !object(value, path)) return std::nullopt;
    known_keys(value, path, {"velocity_m_s", "cursor_px", "radius_px", "world_to_screen"});
    BrushGust gust;
    if (const auto v = numbers(value, path, "velocity_m_s", 3); !v.empty())
      gust.velocity = {v[0], v[1], v[2]};
    if (const auto p = numbers(value, path, "cursor_px", 2); !p.empty()) gust.cursor = {p[0], p[1]};
    if (required(value, path, "radius_px")) number(value, path, "radius_px", gust.radius);
    const auto matrix = numbers(value, path, "world_to_screen", 16);
    for (std::size_t k = 0; k < matrix.size(); ++k)
      gust.world_to_screen(static_cast<int>(k / 4), static_cast<int>(k % 4)) = matrix[k];
    return gust;
  }

  std::optional<Pull> read_pull(const json& value, const std::string& path) {
    if (value.is_null() || !object(value, path)) return std::nullopt;
    known_keys(value, path, {"particle", "target_m"});
    Pull pull;
    if (const auto particle = step(value, path, "particle"))
      pull.particle = static_cast<int>(std::min<std::int64_t>(*particle, std::numeric_limits<int>::max()));
    if (const auto x = numbers(value, path, "target_m", 3); !x.empty()) pull.target = {x[0], x[1], x[2]};
    return pull;
  }

  SceneFolder folder_;  ///< of the scene's meshes
};

}  // namespace

SessionReading read_session(const std::string& text, const std::string& place,
                            const std::optional<SceneFolder>& folder) {
  if (auto problem = syntax_problem(text, place)) return {std::nullopt, {std::move(*problem)}};
  SessionReader reader(folder.value_or(SceneFolder{std::filesystem::path(place).parent_path().string()}));
  Session session = reader.read(json::parse(text));
  const JsonLocations locations = locate_json(text);
  for (Problem& problem : locations.repetitions()) reader.problems.push_back(std::move(problem));
  if (reader.problems.empty()) return {std::move(session), {}};
  for (Problem& problem : reader.problems) locations.put_in_place(problem, place);
  sort_by_place(reader.problems);
  return {std::nullopt, std::move(reader.problems)};
}

void place_in_session(const std::string& text, const std::string& place, std::size_t command,
                      std::vector<Problem>& problems) {
  const JsonLocations locations = locate_json(text);
  for (Problem& problem : problems) {
    problem.path = fmt::format("commands.{}.{}", command, problem.path);
    locations.put_in_place(problem, place);
  }
}

/// A command is a line: logs are long, and people look through them with line-based tools.
std::string write_session(const Session& session) {
  std::string out =
      fmt::format("{{\n  \"format\": \"{}\",\n  \"version\": {},\n  \"scene\": {},\n", session_format,
                  json(session.version).dump(), indented_json(write_scene(session.scene)));
  out += fmt::format("  \"steps\": {},\n  \"time_s\": {},\n  \"commands\": [", session.steps,
                     json(session.time).dump());
  for (std::size_t i = 0; i < session.commands.size(); ++i)
    out += fmt::format("{}\n    {}", i > 0 ? "," : "", command_json(session.commands[i]).dump());
  out += session.commands.empty() ? "]" : "\n  ]";
  if (!session.step_changes.empty()) out += ",\n  \"step_changes\": [";
  for (const StepChange& change : session.step_changes)
    out += fmt::format(
        "{}\n    {}", &change == session.step_changes.data() ? "" : ",",
        json{{"step", change.step}, {"time_s", change.time}, {"time_step_s", change.time_step}}.dump());
  if (!session.step_changes.empty()) out += "\n  ]";
  if (!session.final_state_hash.empty())
    out += fmt::format(",\n  \"final_state_hash\": \"{}\"", session.final_state_hash);
  return out + "\n}\n";
}

std::vector<SceneEdit> logged_values(const SessionAction& action) {
  if (const auto* edits = std::get_if<Edits>(&action)) return *edits;
  if (const auto* brush = std::get_if<std::optional<BrushGust>>(&action))
    return {{"brush", hand_json(*brush).dump()}};
  return {{"pull", hand_json(std::get<std::optional<Pull>>(action)).dump()}};
}

std::vector<std::string> edit_log_lines(const SessionCommand& command) {
  std::vector<std::string> lines;
  for (const auto& [path, value] : logged_values(command.action))
    lines.push_back(fmt::format("{{\"step\":{},\"time_s\":{},\"path\":{},\"value\":{}}}", command.step,
                                command.time, json(path).dump(), value));
  return lines;
}

}  // namespace cloth

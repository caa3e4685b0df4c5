#include "compare/comparison_log.h"

#include <nlohmann/json.hpp>

#include "simulation/session_json.h"

namespace cloth {
namespace {

using json = nlohmann::ordered_json;

json json_of(const ParameterValue& value) {
  if (const auto* vector = std::get_if<Vec3>(&value)) return {vector->x(), vector->y(), vector->z()};
  json number;
  std::visit(
      [&](const auto& v) {
        if constexpr (!std::is_same_v<std::decay_t<decltype(v)>, Vec3>) number = v;
      },
      value);
  return number;
}

class Log {
 public:
  explicit Log(double time) : time_(time) {}

  void add(const std::string& pane, const json& entries) {
    json line{{"time_s", time_}};
    if (!pane.empty()) line["pane"] = pane;
    line.update(entries);
    lines.push_back(line.dump());
  }

  std::vector<std::string> lines;

 private:
  double time_;
};

void log_own_values(const Pane& before, const Pane& after, Log& log) {
  for (const OwnValue& own : after.own) {
    const ParameterValue* was = own_value(before, own.path);
    if (!was || *was != own.value)
      log.add(after.name, {{"path", own.path}, {"value", json_of(own.value)}});
  }
  for (const OwnValue& own : before.own)
    if (!own_value(after, own.path)) log.add(after.name, {{"path", own.path}, {"value", nullptr}});
}

}  // namespace

std::vector<std::string> comparison_log_lines(const Comparison& before, const Comparison& after,
                                              double time) {
  Log log(time);
  for (const Pane& pane : before.panes)
    if (!find_pane(after, pane.name)) log.add(pane.name, {{"removed", true}});
  for (const SceneEdit& edit : edits_between(before.scene, after.scene))
    log.add("", {{"path", edit.path}, {"value", json::parse(edit.value)}});
  for (std::size_t i = 0; i < after.panes.size(); ++i) {
    const Pane& pane = after.panes[i];
    if (const auto was = find_pane(before, pane.name))
      log_own_values(before.panes[*was], pane, log);
    else
      log.add(pane.name, {{"copy_of", after.panes[i - 1].name}});
  }
  if (before.reference != after.reference) log.add("", {{"reference", after.reference}});
  return log.lines;
}

std::vector<std::string> comparison_log_lines(const SessionAction& hand, double time) {
  Log log(time);
  for (const SceneEdit& edit : logged_values(hand))
    log.add("", {{"path", edit.path}, {"value", json::parse(edit.value)}});
  return log.lines;
}

}  // namespace cloth

#include "bridge/history_marks.h"

#include <algorithm>

#include "scene/scene_parameters.h"

namespace clothlab {
namespace {

using Kind = HistoryMark::Kind;

constexpr double closely = 0.5;  // s

/// "Structural stiffness" for a parameter, the title of a block that was added or removed, else the path.
std::string name_of(const std::string& path, const cloth::Scene& scene) {
  if (const auto parameter = find_parameter(scene, path)) return parameter->info.label;
  for (const cloth::Block& block : blocks_of(scene))
    if (block.path == path) return block.title;
  if (path == "probes") return "Probes";
  return path;
}

Kind kind_of(const cloth::SessionAction& action) {
  if (std::holds_alternative<std::optional<cloth::Pull>>(action)) return Kind::pull;
  if (std::holds_alternative<std::optional<cloth::BrushGust>>(action)) return Kind::gust;
  const auto& edits = std::get<cloth::Edits>(action);
  const bool pins = std::any_of(edits.begin(), edits.end(),
                                [](const cloth::SceneEdit& edit) { return edit.path == "cloth.pins"; });
  return pins ? Kind::pins : Kind::edit;
}

bool lets_go(const cloth::SessionAction& action) {
  const auto* pull = std::get_if<std::optional<cloth::Pull>>(&action);
  const auto* gust = std::get_if<std::optional<cloth::BrushGust>>(&action);
  return (pull && !*pull) || (gust && !*gust);
}

std::string first_path(const cloth::SessionAction& action) {
  const auto* edits = std::get_if<cloth::Edits>(&action);
  return edits && !edits->empty() ? edits->front().path : "";
}

}  // namespace

std::vector<HistoryMark> marks_of(const std::vector<cloth::SessionCommand>& commands,
                                  const cloth::Scene& scene) {
  constexpr std::size_t none = -1;
  std::vector<HistoryMark> marks;
  std::size_t pull = none, gust = none;  // the mark of what is held, which edits may follow
  std::string last_path;
  for (const cloth::SessionCommand& command : commands) {
    const Kind kind = kind_of(command.action);
    if (kind == Kind::pull || kind == Kind::gust) {
      std::size_t& held = kind == Kind::pull ? pull : gust;
      if (held != none) marks[held].to = command.time;
      if (lets_go(command.action)) {
        held = none;
      } else if (held == none) {
        held = marks.size();
        marks.push_back({kind, command.time, command.time, {}});
      }
      continue;
    }
    const std::string path = first_path(command.action);
    if (!marks.empty() && marks.back().kind == kind && path == last_path &&
        command.time - marks.back().to <= closely) {
      marks.back().to = command.time;
      continue;
    }
    marks.push_back({kind, command.time, command.time, kind == Kind::edit ? name_of(path, scene) : ""});
    last_path = path;
  }
  return marks;
}

std::shared_ptr<const std::vector<HistoryMark>> HistoryMarks::of(const cloth::History& history,
                                                                 const cloth::Scene& scene) {
  if (changes_ != history.command_changes()) {
    changes_ = history.command_changes();
    marks_ = std::make_shared<const std::vector<HistoryMark>>(marks_of(history.commands(), scene));
  }
  return marks_;
}

}  // namespace clothlab

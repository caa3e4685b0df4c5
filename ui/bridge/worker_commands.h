// The commands that a window sends to its worker, which carries them out in order, between steps.
#pragma once

#include <filesystem>
#include <optional>
#include <variant>

#include "bridge/frame.h"
#include "compare/comparison.h"
#include "forces/hand.h"
#include "simulation/history.h"

namespace clothlab {

/// The quantity that the frames' colours show.
enum class Colouring { strain, difference };

namespace command {
/// Starts a comparison, or a scene as a comparison of one, at t = 0, paused.
struct Load {
  cloth::Comparison content;
  explicit Load(cloth::Comparison comparison) : content(std::move(comparison)) {}
  explicit Load(cloth::Scene scene) : content(cloth::comparison_of_one(std::move(scene))) {}
};

/// Replaces the scene by one with other live parameters or pins, or replaces the comparison. A comparison
/// that cannot be applied during a run (see cloth::acts_at_once) starts again at t = 0. A playing run
/// continues to play. Where a scene becomes a comparison, or a comparison a scene, the run goes on at its
/// present state and with its history, paused and without its recording; it starts again where none fits.
struct Edit {
  cloth::Comparison content;
  explicit Edit(cloth::Comparison comparison) : content(std::move(comparison)) {}
  explicit Edit(cloth::Scene scene) : content(cloth::comparison_of_one(std::move(scene))) {}
};

struct Restart {};  ///< starts the present scene or comparison again at t = 0, paused
struct Play {};
struct Pause {};       ///< a comparison pauses at its next common time
struct SingleStep {};  ///< a comparison goes to its next common time
struct Speed {
  double factor;
};  ///< simulated seconds per second; infinity: as fast as possible
struct Brush {
  std::optional<cloth::BrushGust> gust;
};
struct Pull {
  std::optional<cloth::Pull> pull;
};
struct StartRecording {
  std::filesystem::path folder;
};  ///< ends with StopRecording or a new start; a comparison's also at the end of its duration
struct StopRecording {};

struct GoTo {
  cloth::HistoryTarget target;
};                    ///< pauses at the target; a later GoTo replaces one that has not arrived yet
struct PlayAgain {};  ///< replays the history from the present time to its end, then pauses
struct SaveSession {
  std::filesystem::path file;
};  ///< saves the whole history
struct OpenSession {
  std::variant<std::filesystem::path, cloth::Session> session;
};  ///< starts paused, with the session as history, through which GoTo and PlayAgain move
struct ShowContact {
  ContactChoice choice;
};  ///< which contact data all later frames contain
struct Colour {
  Colouring by;
};

/// Whether the variant holds one of these kinds of command.
template <class... Kinds, class Variant>
bool is_one_of(const Variant& command) {
  return (std::holds_alternative<Kinds>(command) || ...);
}
}  // namespace command

using Command =
    std::variant<command::Load, command::Edit, command::Restart, command::Play, command::Pause,
                 command::SingleStep, command::Speed, command::Brush, command::Pull, command::StartRecording,
                 command::StopRecording, command::GoTo, command::PlayAgain, command::SaveSession,
                 command::OpenSession, command::ShowContact, command::Colour>;

}  // namespace clothlab

// What the windows ask of their workers.
#pragma once

#include <filesystem>
#include <optional>
#include <variant>

#include "bridge/frame.h"
#include "compare/comparison.h"
#include "forces/hand.h"
#include "simulation/history.h"

namespace clothlab {

/// What the frames' colours stand for.
enum class Colouring { strain, difference };

namespace command {
/// A scene or a comparison as a new start, paused.
template <class Content>
struct Load {
  Content content;
};
template <class Content>
Load(Content) -> Load<Content>;

/// A scene with other live parameters or pins, or a comparison, which is in force at once where it can be
/// (see cloth::acts_at_once), else from t = 0, and goes on playing.
template <class Content>
struct Edit {
  Content content;
};
template <class Content>
Edit(Content) -> Edit<Content>;

struct Restart {};  ///< what is in force, from t = 0, paused
struct Play {};
struct Pause {};       ///< a comparison at the common time that is next
struct SingleStep {};  ///< a comparison to the next common time
struct Speed {
  double factor;
};  ///< infinity: as fast as it goes
struct Brush {
  std::optional<cloth::BrushGust> gust;
};
struct Pull {
  std::optional<cloth::Pull> pull;
};
struct StartRecording {
  std::filesystem::path folder;
};  ///< ends with StopRecording or a new start, of a comparison also with its duration
struct StopRecording {};

struct GoTo {
  cloth::HistoryTarget target;
};                    ///< pauses there; one that comes later takes the place of one that is not there yet
struct PlayAgain {};  ///< what the history has, from here to its end, and pauses there
struct SaveSession {
  std::filesystem::path file;
};  ///< the whole history
struct OpenSession {
  std::variant<std::filesystem::path, cloth::Session> session;
};  ///< a new start, paused, with the session as its history: GoTo and PlayAgain go through it
struct ShowContact {
  ContactChoice choice;
};  ///< what frames tell of contact from now on
struct Colour {
  Colouring by;
};

/// Whether a command is of one of these kinds.
template <class... Kinds, class Variant>
bool is_one_of(const Variant& command) {
  return (std::holds_alternative<Kinds>(command) || ...);
}
}  // namespace command

using SceneCommand =
    std::variant<command::Load<cloth::Scene>, command::Edit<cloth::Scene>, command::Restart, command::Play,
                 command::Pause, command::SingleStep, command::Speed, command::Brush, command::Pull,
                 command::StartRecording, command::StopRecording, command::GoTo, command::PlayAgain,
                 command::SaveSession, command::OpenSession, command::ShowContact>;
using CompareCommand =
    std::variant<command::Load<cloth::Comparison>, command::Edit<cloth::Comparison>, command::Restart,
                 command::Play, command::Pause, command::SingleStep, command::Speed, command::Brush,
                 command::Pull, command::StartRecording, command::StopRecording, command::Colour>;

}  // namespace clothlab

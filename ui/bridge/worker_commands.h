// The commands that windows send to their workers. Workers carry them out in order, between steps.
#pragma once

#include <filesystem>
#include <future>
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
/// Starts a scene or a comparison at t = 0, paused.
template <class Content>
struct Load {
  Content content;
};
template <class Content>
Load(Content) -> Load<Content>;

/// Replaces the scene by one with other live parameters or pins, or replaces the comparison. A comparison
/// that cannot be applied during a run (see cloth::acts_at_once) starts again at t = 0. A playing run
/// continues to play.
template <class Content>
struct Edit {
  Content content;
};
template <class Content>
Edit(Content) -> Edit<Content>;

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

/// Gives the run away, at its present state and with its history, to what takes it: an empty one if it runs
/// nothing that goes on as `scene`. A comparison gives the run of the first pane that does.
struct GiveRun {
  cloth::Scene scene;
  std::shared_ptr<std::promise<cloth::RunWithHistory>> to;
};
/// Goes on with a run that another worker gives away; loads the content if it gives none.
template <class Content>
struct TakeRun {
  Content content;
  std::shared_ptr<std::future<cloth::RunWithHistory>> from;
};

/// Whether the variant holds one of these kinds of command.
template <class... Kinds, class Variant>
bool is_one_of(const Variant& command) {
  return (std::holds_alternative<Kinds>(command) || ...);
}
}  // namespace command

/// Every worker accepts all of them and ignores those of the other kind of content.
using Command =
    std::variant<command::Load<cloth::Scene>, command::Edit<cloth::Scene>, command::Load<cloth::Comparison>,
                 command::Edit<cloth::Comparison>, command::Restart, command::Play, command::Pause,
                 command::SingleStep, command::Speed, command::Brush, command::Pull, command::StartRecording,
                 command::StopRecording, command::GoTo, command::PlayAgain, command::SaveSession,
                 command::OpenSession, command::ShowContact, command::Colour, command::GiveRun,
                 command::TakeRun<cloth::Scene>, command::TakeRun<cloth::Comparison>>;

}  // namespace clothlab

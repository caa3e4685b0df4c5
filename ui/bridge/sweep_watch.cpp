#include "bridge/sweep_watch.h"

#include <algorithm>
#include <utility>
#include <vector>

#include "bridge/worker_pace.h"

namespace clothlab {
namespace {

namespace fs = std::filesystem;
using std::chrono::milliseconds;

/// Some file systems of many machines tell late that a file has grown; to open it tells at once. So it is
/// read every so often, whatever it seems to be.
constexpr std::chrono::seconds longest_trust{5};
/// Reading takes at most so great a part of the time.
constexpr int part_of_time = 10;

}  // namespace

/// Of each file its name and its size.
using FileMarks = std::vector<std::pair<std::string, std::uintmax_t>>;

namespace {

FileMarks marks_of(const fs::path& folder) {
  FileMarks marks;
  std::error_code error;
  for (fs::directory_iterator at(folder, error), end; !error && at != end; at.increment(error)) {
    std::error_code ignored;
    marks.emplace_back(at->path().filename().string(), at->file_size(ignored));
  }
  std::sort(marks.begin(), marks.end());
  return marks;
}

std::string why_unread(const cloth::SweepFolderReading& reading) {
  if (reading.error) return reading.error->text();
  return reading.problems.empty() ? "" : reading.problems.front().text();
}

}  // namespace

/// What was read last.
struct SweepWatch::Reader {
  fs::path path;
  std::optional<cloth::SweepFolder> folder{};
  FileMarks marks{};
  Clock::time_point read{};
  milliseconds took{0};
  bool complete = false;

  bool is_due() const {
    const auto age = Clock::now() - read;
    if (!folder) return true;
    if (age < part_of_time * took) return false;
    return marks_of(folder->shards()) != marks || (!complete && age > longest_trust);
  }

  /// A view, or the problem because of which there is none.
  std::shared_ptr<const SweepView> view(std::string& problem) {
    const auto start = Clock::now();
    if (!folder) {
      cloth::SweepFolderReading reading = cloth::read_sweep_folder(path);
      if (!reading.folder) problem = why_unread(reading);
      folder = std::move(reading.folder);
      if (!folder) return nullptr;
    }
    marks = marks_of(folder->shards());
    const cloth::ShardFiles files = cloth::read_shard_files(*folder);
    if (files.error) problem = files.error->text();
    auto view = std::make_shared<SweepView>(SweepView{*folder, sweep_results(*folder, files.files)});
    complete = view->results.missing() == 0;
    read = Clock::now();
    took = std::chrono::duration_cast<milliseconds>(read - start);
    return view;
  }
};

void SweepWatch::follow(const fs::path& folder, milliseconds interval) {
  present_ = std::make_shared<Following>();
  thread_.start([following = present_, folder, interval](const std::stop_token& stop) {
    run(*following, folder, interval, stop);
  });
}

void SweepWatch::stop() {
  thread_.stop();
  present_.reset();
}

void SweepWatch::look() {
  if (!present_) return;
  const std::lock_guard lock(present_->mutex);
  present_->is_due = true;
  present_->changed.notify_all();
}

std::shared_ptr<const SweepView> SweepWatch::take() {
  if (!present_) return nullptr;
  const std::lock_guard lock(present_->mutex);
  return std::move(present_->newest);
}

std::string SweepWatch::problem() const {
  if (!present_) return {};
  const std::lock_guard lock(present_->mutex);
  return present_->problem;
}

void SweepWatch::run(Following& following, const fs::path& folder, milliseconds interval,
                     const std::stop_token& stop) {
  Reader reader{.path = folder};
  while (!stop.stop_requested()) {
    if (reader.is_due()) {
      std::string problem;
      auto view = reader.view(problem);
      const std::lock_guard lock(following.mutex);
      if (view) following.newest = std::move(view);
      following.problem = std::move(problem);
    }
    std::unique_lock lock(following.mutex);
    following.changed.wait_for(lock, stop, interval, [&following] { return following.is_due; });
    following.is_due = false;
  }
}

}  // namespace clothlab

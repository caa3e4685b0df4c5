#include "sweep/run_sweep.h"

#include <unistd.h>

#include <atomic>
#include <condition_variable>
#include <mutex>
#include <thread>

#include "io/line_file.h"
#include "io/machine.h"
#include "io/process.h"
#include "kernels/instruction_set.h"
#include "sweep/run_point.h"

namespace cloth {
namespace {

constexpr auto progress_interval = std::chrono::milliseconds(100);

/// The file of this attempt. A thread of its own waits for the disk, so that runs need not: rows that come
/// while it waits go to the disk together.
class ShardWriter {
 public:
  ~ShardWriter() { close(); }

  std::optional<IoError> open(const SweepFolder& folder, const Shard& shard) {
    const Attempt attempt{.plan = folder.hash,
                          .version = version(),
                          .instruction_set = name_of(active_instruction_set()),
                          .processor = processor_name(),
                          .host = host_name(),
                          .shard = shard};
    std::optional<IoError> error;
    std::error_code ignored;
    // Another machine may have the same name, and another container the same process number.
    for (int k = 1; k <= 10'000; ++k) {
      const auto path = folder.shards() / shard_file_name(shard, attempt.host, ::getpid(), k);
      if (std::filesystem::exists(path, ignored)) continue;
      error = file_.open_new(path);
      if (!error || !std::filesystem::exists(path, ignored)) break;
    }
    if (error) return error;
    sync_folder(folder.shards());
    if ((error = file_.add(line_of(attempt))) || (error = file_.flush())) return error;
    syncer_ = std::thread([this] { sync_rows(); });
    return std::nullopt;
  }

  void add(const PointRow& row) {
    const std::string line = line_of(row);
    const std::lock_guard lock(mutex_);
    if (error_) return;
    if (!(error_ = file_.add(line))) error_ = file_.flush();
    unsynced_ = true;
    changed_.notify_one();
  }

  bool has_failed() {
    const std::lock_guard lock(mutex_);
    return error_.has_value();
  }

  /// Once all rows are on the disk: the first thing that went wrong.
  std::optional<IoError> close() {
    if (!syncer_.joinable()) return error_;
    {
      const std::lock_guard lock(mutex_);
      closing_ = true;
      changed_.notify_one();
    }
    syncer_.join();
    auto error = file_.close();
    if (!error_) error_ = std::move(error);
    return error_;
  }

 private:
  void sync_rows() {
    std::unique_lock lock(mutex_);
    while (true) {
      changed_.wait(lock, [this] { return unsynced_ || closing_; });
      if (!unsynced_) return;
      unsynced_ = false;
      lock.unlock();
      auto error = file_.sync();
      lock.lock();
      if (!error_) error_ = std::move(error);
    }
  }

  LineFile file_;
  std::mutex mutex_;
  std::condition_variable changed_;
  std::thread syncer_;
  bool unsynced_ = false, closing_ = false;
  std::optional<IoError> error_;
};

/// The points of a shard that no attempt has made.
std::vector<std::int64_t> missing_points(const ShardFiles& earlier, const Shard& shard, std::int64_t count) {
  std::vector<bool> there(static_cast<std::size_t>(count), false);
  for (const ShardFile& file : earlier.files)
    for (const PointRow& row : file.rows)
      if (row.point < count) there[static_cast<std::size_t>(row.point)] = true;
  std::vector<std::int64_t> missing;
  for (std::int64_t point = shard.index - 1; point < count; point += shard.count)
    if (!there[static_cast<std::size_t>(point)]) missing.push_back(point);
  return missing;
}

/// Points over threads.
class Runner {
 public:
  Runner(const SweepFolder& folder, const SweepPoints& points, const SweepRunOptions& options,
         const std::vector<std::int64_t>& missing)
      : folder_(folder), points_(points), options_(options), missing_(missing) {}

  void run(SweepRun& result) {
    if ((result.error = writer_.open(folder_, options_.shard))) return;
    const auto jobs = std::min<std::size_t>(static_cast<std::size_t>(options_.jobs), missing_.size());
    std::vector<std::thread> threads;
    working_ = jobs;
    for (std::size_t k = 0; k < jobs; ++k) threads.emplace_back([this] { work(); });
    {
      std::unique_lock lock(mutex_);
      while (!ended_.wait_for(lock, progress_interval, [this] { return working_ == 0; }))
        if (options_.progress) options_.progress(result.earlier + made_, result.points);
    }
    for (std::thread& thread : threads) thread.join();
    result.made = made_;
    result.error = writer_.close();
    result.stopped = stopped_;
  }

 private:
  void work() {
    const StopTest stop = [this] { return is_to_stop(options_.stop) || failed_; };
    while (!failed_) {
      const std::size_t k = next_++;
      if (k >= missing_.size()) break;
      const auto row =
          is_to_stop(options_.stop) ? std::nullopt : run_point(folder_.plan, points_, missing_[k], stop);
      if (!row) {
        stopped_ = !failed_;
        break;
      }
      keep(*row);
    }
    const std::lock_guard lock(mutex_);
    if (--working_ == 0) ended_.notify_one();
  }

  void keep(const PointRow& row) {
    writer_.add(row);
    if (writer_.has_failed()) {
      failed_ = true;
      return;
    }
    const std::lock_guard lock(mutex_);
    ++made_;
    if (options_.row) options_.row(row);
  }

  const SweepFolder& folder_;
  const SweepPoints& points_;
  const SweepRunOptions& options_;
  const std::vector<std::int64_t>& missing_;
  ShardWriter writer_;
  std::atomic<std::size_t> next_{0};
  std::atomic<bool> failed_{false}, stopped_{false};
  std::mutex mutex_;
  std::condition_variable ended_;
  std::size_t working_ = 0;
  std::int64_t made_ = 0;
};

}  // namespace

SweepRun run_sweep(const SweepFolder& folder, const SweepRunOptions& options) {
  SweepRun result;
  const SweepPoints points(folder.plan);
  const ShardFiles earlier = read_shard_files(folder, options.shard);
  if ((result.error = earlier.error)) return result;
  const std::vector<std::int64_t> missing = missing_points(earlier, options.shard, points.count());
  if (options.shard.index <= points.count())
    result.points = (points.count() - options.shard.index) / options.shard.count + 1;
  result.earlier = result.points - std::ssize(missing);
  if (!missing.empty()) Runner(folder, points, options, missing).run(result);
  return result;
}

}  // namespace cloth

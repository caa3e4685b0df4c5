#include "support/slow_disk.h"

#include <sys/syscall.h>
#include <unistd.h>

#include <condition_variable>
#include <mutex>

namespace clothlab::test {
namespace {

std::mutex mutex;
std::condition_variable changed;
std::string slow_part;  // empty: the disk is as it is
int waiting = 0;

std::string path_of(int descriptor) {
  char path[4096];
  const std::string link = "/proc/self/fd/" + std::to_string(descriptor);
  const ssize_t length = ::readlink(link.c_str(), path, sizeof path);
  return length > 0 ? std::string(path, static_cast<std::size_t>(length)) : std::string();
}

void wait_for_disk(const std::string& path) {
  std::unique_lock lock(mutex);
  if (slow_part.empty() || path.find(slow_part) == std::string::npos) return;
  ++waiting;
  changed.wait(lock, [] { return slow_part.empty(); });
  --waiting;
}

}  // namespace

SlowDisk::SlowDisk(const std::string& part) {
  const std::lock_guard lock(mutex);
  slow_part = part;
}

void SlowDisk::let_go() {
  const std::lock_guard lock(mutex);
  slow_part.clear();
  changed.notify_all();
}

bool SlowDisk::is_waited_for() const {
  const std::lock_guard lock(mutex);
  return waiting > 0;
}

}  // namespace clothlab::test

extern "C" int fsync(int descriptor) {
  clothlab::test::wait_for_disk(clothlab::test::path_of(descriptor));
  return static_cast<int>(::syscall(SYS_fsync, descriptor));
}

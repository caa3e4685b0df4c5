// A disk that takes its time: fsync of certain files waits until it is let go. The program must link
// slow_disk.cpp, which takes the place of the C library's fsync.
#pragma once

#include <string>

namespace clothlab::test {

class SlowDisk {
 public:
  /// Holds the writing of every file whose path contains `part`. One at a time.
  explicit SlowDisk(const std::string& part);
  ~SlowDisk() { let_go(); }
  SlowDisk(const SlowDisk&) = delete;
  SlowDisk& operator=(const SlowDisk&) = delete;

  void let_go();
  /// Whether a thread waits for the disk.
  bool is_waited_for() const;
};

}  // namespace clothlab::test

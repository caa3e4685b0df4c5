// The springs of a cloth: runs of springs that join particles a constant offset apart. A grid keeps its six
// directions as six blocks of equal runs, so that its kernels need no index pairs; a general mesh is runs of
// length one.
#pragma once

#include <array>
#include <initializer_list>
#include <iterator>
#include <vector>

namespace cloth {

enum class SpringFamily { structural, shear, flexion };
inline constexpr std::array<SpringFamily, 3> spring_families{SpringFamily::structural, SpringFamily::shear,
                                                             SpringFamily::flexion};
const char* name_of(SpringFamily family);

/// `count` springs of one kind: spring s joins particle first + s to particle first + s + offset.
struct SpringRun {
  SpringFamily family = SpringFamily::structural;
  int first = 0;
  int count = 0;
  int offset = 1;
  double rest_length = 0;  ///< m
  double stiffness = 0;    ///< N/m
  bool operator==(const SpringRun&) const = default;
};

/// `rows` runs alike, each `stride` particles after the one before.
struct SpringBlock {
  SpringRun run;
  int rows = 1;
  int stride = 0;
  bool operator==(const SpringBlock&) const = default;
};

/// Blocks of runs, iterated run by run.
class SpringRuns {
 public:
  class Iterator {
   public:
    using iterator_category = std::input_iterator_tag;
    using value_type = SpringRun;
    using difference_type = std::ptrdiff_t;
    using pointer = void;
    using reference = SpringRun;

    Iterator(const SpringBlock* block, int row) : block_(block), row_(row) {}
    SpringRun operator*() const {
      SpringRun run = block_->run;
      run.first += row_ * block_->stride;
      return run;
    }
    Iterator& operator++() {
      if (++row_ == block_->rows) ++block_, row_ = 0;
      return *this;
    }
    bool operator==(const Iterator&) const = default;

   private:
    const SpringBlock* block_;
    int row_;
  };

  SpringRuns() = default;
  SpringRuns(std::initializer_list<SpringRun> runs) : SpringRuns(std::vector<SpringRun>(runs)) {}
  SpringRuns(const std::vector<SpringRun>& runs) {
    for (const SpringRun& run : runs) push_back(run);
  }
  std::vector<SpringRun> list() const { return {begin(), end()}; }

  Iterator begin() const { return {blocks_.data(), 0}; }
  Iterator end() const { return {blocks_.data() + blocks_.size(), 0}; }
  bool empty() const { return blocks_.empty(); }
  std::size_t size() const { return static_cast<std::size_t>(std::distance(begin(), end())); }  ///< of runs
  std::size_t spring_count() const {
    std::size_t count = 0;
    for (const SpringBlock& block : blocks_) count += static_cast<std::size_t>(block.rows * block.run.count);
    return count;
  }

  void push_back(const SpringRun& run) { blocks_.push_back({run}); }
  std::vector<SpringBlock>& blocks() { return blocks_; }
  const std::vector<SpringBlock>& blocks() const { return blocks_; }

  bool operator==(const SpringRuns&) const = default;

 private:
  std::vector<SpringBlock> blocks_;
};

/// visit(run, spring, i, j) for every spring in order: its run, its number from 0, and the particles i and j
/// that it joins.
template <class Visit>
void for_each_spring(const SpringRuns& springs, Visit visit) {
  std::size_t spring = 0;
  for (const SpringRun& run : springs)
    for (int i = run.first; i < run.first + run.count; ++i, ++spring)
      visit(run, spring, static_cast<std::size_t>(i), static_cast<std::size_t>(i + run.offset));
}

}  // namespace cloth

// Tensions of springs in N, none negative, with a list of those above 0 as long as these are few.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

namespace cloth {

class SpringTensions {
 public:
  SpringTensions() = default;
  explicit SpringTensions(std::size_t springs) : values_(springs, 0.0) {}
  explicit SpringTensions(std::vector<double> values) : values_(std::move(values)) { list_held(); }

  std::size_t size() const { return values_.size(); }
  const std::vector<double>& values() const { return values_; }
  double operator[](std::size_t spring) const { return values_[spring]; }

  bool any() const { return !few_ || !held_.empty(); }
  /// Whether held() lists them: at most one spring in 32, for which work spring by spring takes less than
  /// work with all springs.
  bool is_few() const { return few_; }
  static std::size_t most(std::size_t springs) { return springs / 32; }
  /// The springs with a tension above 0, ascending.
  std::span<const std::uint32_t> held() const { return held_; }

  void clear();
  void copy(const SpringTensions& other);
  /// Values to write; list_held() or list_held(springs) has to follow.
  std::vector<double>& write() { return values_; }
  void list_held();
  /// `springs`: in any order, those that may have a tension; all others have none.
  void list_held(std::vector<std::uint32_t>& springs);
  /// Lowers each tension to at most limit(spring).
  template <class Limit>
  void lower(const Limit& limit) {
    if (!few_) {
      for (std::size_t s = 0; s < values_.size(); ++s) values_[s] = std::min(values_[s], limit(s));
      return list_held();
    }
    for (const std::uint32_t s : held_) values_[s] = std::min(values_[s], limit(s));
    std::erase_if(held_, [this](std::uint32_t s) { return !(values_[s] > 0); });
  }

  bool operator==(const SpringTensions& other) const { return values_ == other.values_; }

 private:
  std::vector<double> values_;
  std::vector<std::uint32_t> held_;
  bool few_ = true;
};

}  // namespace cloth

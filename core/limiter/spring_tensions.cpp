#include "limiter/spring_tensions.h"

#include <algorithm>

namespace cloth {

void SpringTensions::clear() {
  if (few_)
    for (const std::uint32_t s : held_) values_[s] = 0;
  else
    std::fill(values_.begin(), values_.end(), 0.0);
  held_.clear();
  few_ = true;
}

void SpringTensions::copy(const SpringTensions& other) {
  if (!few_ || !other.few_ || size() != other.size()) {
    *this = other;
    return;
  }
  clear();
  held_ = other.held_;
  for (const std::uint32_t s : held_) values_[s] = other.values_[s];
}

void SpringTensions::list_held() {
  held_.clear();
  const auto count =
      static_cast<std::size_t>(std::count_if(values_.begin(), values_.end(), [](double t) { return t > 0; }));
  few_ = count <= most(size());
  if (!few_) return;
  for (std::size_t s = 0; held_.size() < count; ++s)
    if (values_[s] > 0) held_.push_back(static_cast<std::uint32_t>(s));
}

void SpringTensions::list_held(std::vector<std::uint32_t>& springs) {
  std::erase_if(springs, [this](std::uint32_t s) {
    if (values_[s] > 0) return false;
    values_[s] = 0;  // whatever it was
    return true;
  });
  few_ = springs.size() <= most(size());
  held_.clear();
  if (!few_) return;
  std::sort(springs.begin(), springs.end());
  held_.assign(springs.begin(), springs.end());
}

}  // namespace cloth

// A field of vectors that is zero but at some of the particles, of which it keeps a list: work with it takes
// as long as there are of these.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "geometry/vec3_field.h"

namespace cloth {

class SparseField {
 public:
  /// Zero at all of `size` particles.
  void clear(std::size_t size) {
    if (size != values_.size())
      values_ = Vec3Field(size), listed_.assign(size, 0), particles_.clear();
    else if (everywhere_)
      values_.fill(0);
    else
      for (const std::uint32_t i : particles_) values_.set(i, Vec3::Zero());
    clear_list();
    everywhere_ = false;
  }

  std::size_t size() const { return values_.size(); }
  bool has(std::size_t particle) const { return everywhere_ || listed_[particle] != 0; }
  void add(std::size_t particle, const Vec3& v) {
    if (!has(particle)) list(particle);
    values_.add(particle, v);
  }
  void set(std::size_t particle, const Vec3& v) {
    if (!has(particle)) list(particle);
    values_.set(particle, v);
  }

  /// All values to write, after which every particle counts and particles() is empty.
  Vec3Field& everywhere() {
    clear_list();
    everywhere_ = true;
    return values_;
  }
  bool is_everywhere() const { return everywhere_; }
  /// In the order in which they were first written.
  std::span<const std::uint32_t> particles() const { return particles_; }
  const Vec3Field& values() const { return values_; }
  Vec3 operator[](std::size_t particle) const { return values_[particle]; }

 private:
  void clear_list() {
    for (const std::uint32_t i : particles_) listed_[i] = 0;
    particles_.clear();
  }
  void list(std::size_t particle) {
    listed_[particle] = 1;
    particles_.push_back(static_cast<std::uint32_t>(particle));
  }

  Vec3Field values_;
  std::vector<std::uint8_t> listed_;
  std::vector<std::uint32_t> particles_;
  bool everywhere_ = false;
};

/// field += factor * change
inline void add_scaled(double factor, const SparseField& change, Vec3Field& field) {
  if (!change.is_everywhere()) {
    for (const std::uint32_t i : change.particles()) field.add(i, factor * change[i]);
    return;
  }
  const std::span<const double> from = change.values().flat();
  const std::span<double> to = field.flat();
  for (std::size_t k = 0; k < to.size(); ++k) to[k] += factor * from[k];
}

}  // namespace cloth

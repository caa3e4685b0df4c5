#include "kernels/projected_elements.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <span>

#include "geometry/at.h"
#include "kernels/instruction_set.h"

namespace cloth {
namespace {

using kernels::widest_vector;

/// L of K = L L^T, or none where K is not positive semidefinite.
std::optional<std::array<double, 6>> factor_of(const MembraneTriangle& t) {
  constexpr double negligible = 1e-12;  // of the largest entry: rounding of what is 0
  double largest = 0;
  for (const auto& row : t.k)
    for (const double k : row) largest = std::max(largest, std::abs(k));
  std::array<std::array<double, 3>, 3> l{};
  for (std::size_t j = 0; j < 3; ++j) {
    double pivot = t.k[j][j];
    for (std::size_t m = 0; m < j; ++m) pivot -= l[j][m] * l[j][m];
    if (!(pivot >= -negligible * largest)) return std::nullopt;
    l[j][j] = pivot > negligible * largest ? std::sqrt(pivot) : 0;
    for (std::size_t i = j + 1; i < 3; ++i) {
      double entry = t.k[i][j];
      for (std::size_t m = 0; m < j; ++m) entry -= l[i][m] * l[j][m];
      if (l[j][j] > 0)
        l[i][j] = entry / l[j][j];
      else if (std::abs(entry) > std::sqrt(negligible) * largest)
        return std::nullopt;
    }
  }
  return std::array{l[0][0], l[1][0], l[2][0], l[1][1], l[2][1], l[2][2]};
}

/// The colours of elements that are given one after the other.
class Colouring {
 public:
  explicit Colouring(std::size_t particles) : colours_at_(particles) {}

  int next(std::span<const int> particles) {
    ++number_;
    for (const int i : particles)
      for (const int colour : colours_at_[at(i)]) {
        if (at(colour) >= taken_for_.size()) taken_for_.resize(at(colour) + 1, 0);
        taken_for_[at(colour)] = number_;
      }
    const auto free =
        std::find_if(taken_for_.begin(), taken_for_.end(), [&](int taken) { return taken != number_; });
    const auto colour = static_cast<int>(free - taken_for_.begin());
    for (const int i : particles) colours_at_[at(i)].push_back(colour);
    return colour;
  }
  void forget(std::span<const int> particles) {
    for (const int i : particles) colours_at_[at(i)].clear();
  }

 private:
  std::vector<std::vector<int>> colours_at_;
  std::vector<int> taken_for_;
  int number_ = 0;
};

/// The numbers of `count` elements in the order of visits; points(e) are the particles of one.
template <class PointsOf>
std::vector<int> by_colours_in_parts(std::size_t count, std::size_t particles, const PointsOf& points) {
  constexpr std::size_t part = 256;
  Colouring colouring(particles);
  std::vector<int> order(count);
  for (std::size_t first = 0; first < count; first += part) {
    const std::size_t end = std::min(first + part, count);
    std::vector<int> colour;
    for (std::size_t e = first; e < end; ++e) colour.push_back(colouring.next(points(e)));
    for (std::size_t e = first; e < end; ++e) colouring.forget(points(e)), order[e] = static_cast<int>(e);
    std::stable_sort(order.begin() + static_cast<std::ptrdiff_t>(first),
                     order.begin() + static_cast<std::ptrdiff_t>(end),
                     [&](int a, int b) { return colour[at(a) - first] < colour[at(b) - first]; });
  }
  return order;
}

/// One bending element.
struct Bend {
  const BendingRun* run;
  std::vector<int> particles;
};
std::vector<Bend> bends_of(const BendingRuns& runs) {
  std::vector<Bend> bends;
  for (const BendingRun& run : runs)
    for (int e = run.first; e < run.first + run.count; ++e) {
      Bend bend{&run, {}};
      for (int p = 0; p < run.points; ++p) bend.particles.push_back(e + run.offset[at(p)]);
      bends.push_back(std::move(bend));
    }
  return bends;
}

}  // namespace

void ProjectedElements::Sums::set_give(const std::vector<double>& mobility) {
  give.assign(element.size(), 0.0);
  for (std::size_t e = 0; e < element.size(); ++e)
    for (int p = begin[e]; p < begin[e + 1]; ++p)
      give[e] += coefficient[at(p)] * coefficient[at(p)] * mobility[at(particle[at(p)] / 4)];
}

void ProjectedElements::Sums::hand_to(kernels::SumElements& elements) {
  elements.count = static_cast<int>(element.size());
  elements.begin = begin.data(), elements.particle = particle.data();
  elements.coefficient = coefficient.data();
  elements.stiffness = stiffness.data(), elements.give = give.data();
  elements.impulse = impulse.data();
}

ProjectedElements::ProjectedElements(const ClothSystem& system)
    : bending_(system.bending),
      sliders_(system.sliders),
      membrane_(system.membrane),
      kernels_(&active_kernels<kernels::LocalKernels>()) {
  make_bending(system);
  make_sliders(system);
  make_triangles(system);
}

void ProjectedElements::make_bending(const ClothSystem& system) {
  const std::vector<Bend> bends = bends_of(bending_);
  bends_.element = by_colours_in_parts(bends.size(), system.mass.size(), [&](std::size_t e) {
    return std::span<const int>(bends[e].particles);
  });
  bends_.begin.push_back(0);
  for (const int e : bends_.element) {
    const Bend& bend = bends[at(e)];
    bends_.stiffness.push_back(bend.run->stiffness);
    for (std::size_t p = 0; p < bend.particles.size(); ++p) {
      bends_.particle.push_back(4 * bend.particles[p]);
      bends_.coefficient.push_back(bend.run->coefficient[p]);
    }
    bends_.begin.push_back(static_cast<int>(bends_.particle.size()));
  }
}

void ProjectedElements::make_sliders(const ClothSystem& system) {
  slides_.element = by_colours_in_parts(sliders_.size(), system.mass.size(), [&](std::size_t e) {
    return std::span<const int>(sliders_[e].particle).first(at(sliders_[e].points));
  });
  slides_.begin.push_back(0);
  for (const int e : slides_.element) {
    const BendingSlider& s = sliders_[at(e)];
    slides_.stiffness.push_back(s.area * s.stiffness);
    most_.push_back(s.area * s.yield);
    for (std::size_t p = 0; p < at(s.points); ++p) {
      slides_.particle.push_back(4 * s.particle[p]);
      slides_.coefficient.push_back(s.coefficient[p]);
    }
    slides_.begin.push_back(static_cast<int>(slides_.particle.size()));
  }
  slip_.resize(sliders_.size());
  normal_.assign(4 * sliders_.size(), 0.0);
}

/// What changes with the mobility is left to begin().
void ProjectedElements::make_triangles(const ClothSystem& system) {
  Colouring colouring(system.mass.size());
  std::vector<std::vector<int>> of_colour;
  for (std::size_t t = 0; t < membrane_.size(); ++t) {
    const std::size_t colour = at(colouring.next(membrane_[t].corner));
    if (colour >= of_colour.size()) of_colour.resize(colour + 1);
    of_colour[colour].push_back(static_cast<int>(t));
  }
  for (const std::vector<int>& triangles : of_colour) {
    triangle_.insert(triangle_.end(), triangles.begin(), triangles.end());
    while (triangle_.size() % widest_vector != 0) triangle_.push_back(-1);
  }
  corner_.assign(3 * triangle_.size(), 4 * static_cast<int>(system.mass.size()));
  numbers_.assign(kernels::projected_triangle_numbers * triangle_.size(), 0.0);
  for (std::size_t k = 0; k < triangle_.size(); ++k) {
    if (triangle_[k] < 0) continue;
    const std::size_t block = k / widest_vector, lane = k % widest_vector;
    const MembraneTriangle& t = membrane_[at(triangle_[k])];
    const auto factor = factor_of(t);
    if (!factor) suits_ = false;
    double* numbers = numbers_.data() + block * kernels::projected_triangle_numbers * widest_vector + lane;
    for (std::size_t c = 0; c < 3; ++c) {
      corner_[(block * 3 + c) * widest_vector + lane] = 4 * t.corner[c];
      numbers[c * widest_vector] = t.rest_square[c];
    }
    for (std::size_t n = 0; factor && n < 6; ++n) numbers[(6 + n) * widest_vector] = (*factor)[n];
  }
}

void ProjectedElements::begin(const Times& times, const std::vector<double>& mobility) {
  bends_.set_give(mobility), slides_.set_give(mobility);
  pass_.bending.time = times.bending, pass_.triangles.time = times.membrane;
  for (std::size_t k = 0; k < triangle_.size(); ++k) {
    if (triangle_[k] < 0) continue;
    const std::size_t block = k / widest_vector, lane = k % widest_vector;
    for (std::size_t c = 0; c < 3; ++c)
      numbers_[(block * kernels::projected_triangle_numbers + 3 + c) * widest_vector + lane] =
          mobility[at(membrane_[at(triangle_[k])].corner[c])];
  }
}

void ProjectedElements::begin_step(const SliderState* sliders) {
  for (Sums* sums : {&bends_, &slides_}) sums->clear_impulses();
  bends_.hand_to(pass_.bending), slides_.hand_to(pass_.sliders);
  if (!sliders) pass_.sliders.count = 0;
  for (std::size_t k = 0; sliders && k < slides_.element.size(); ++k) {
    const std::size_t e = at(slides_.element[k]);
    slip_[k] = sliders->slip[e];
    const Vec3 n = sliders->normal[e];
    for (int axis = 0; axis < 3; ++axis) normal_[4 * k + at(axis)] = n[axis];
  }
  pass_.sliders.normal = normal_.data(), pass_.sliders.slip = slip_.data(), pass_.sliders.most = most_.data();
  impulse_.assign(9 * triangle_.size(), 0.0);
  pass_.triangles.blocks = static_cast<int>(triangle_.size()) / widest_vector;
  pass_.triangles.corner = corner_.data(), pass_.triangles.numbers = numbers_.data();
  pass_.triangles.impulse = impulse_.data();
}

void ProjectedElements::visit(kernels::ProjectedParticles& particles) {
  kernels_->project_elements(pass_, particles);
}

}  // namespace cloth

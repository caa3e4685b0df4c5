// XPBD's visits of bending elements, sliders and triangles (integrators/xpbd.h). With W = w I - b b^T, P the
// impulse of earlier visits and P' that after this one, s and u the sums c x and c v of the start's positions
// and the present velocities, K = L L^T and q_e = |d_e|^2 - L_e^2 of a triangle's edges:
//
//     bending    (I + k h (h + t) G) P' = -k h (s + (h + t) (u - G P)),   G = sum c^2 W,   v += c W (P' - P)
//     sliders    p' = clamp(-k h (n . (s + h u) - slip - h g p)/(1 + k h^2 g)),   g = n . G n,   v += c (p' -
//     p) W n triangles  (I + h (h + t) L^T G L) mu = -h L^T a,   lambda = L mu,   P' = J^T lambda,   G = J W
//     J^T
//                a = q' + t dq'/dt without P,   J = dq/dx
//
// Bending and sliders go element by element, a particle in one register; triangles eight at a time. After
// coloured_visits.h; included once for every instruction set, everything here has internal linkage.
#pragma once

#include "kernels/coloured_visits.h"
#include "kernels/projected_pass.h"

namespace cloth::kernels {
namespace {

/// A symmetric matrix of 3 x 3.
template <class Number>
struct Symmetric3 {
  Number xx, yy, zz, xy, xz, yz;
};

template <bool dragged, bool measured>
class SumVisits {
 public:
  explicit SumVisits(ProjectedParticles& particles) : particles_(particles) {}

  void all(const BendingProjection& bending) {
    for (int e = 0; e < bending.count; ++e) visit(bending, e);
  }
  void all(const SliderProjection& sliders) {
    for (int e = 0; e < sliders.count; ++e) visit(sliders, e);
  }
  double largest() const { return largest_; }

 private:
  struct Sums {
    Four position, velocity;
  };
  CLOTHLAB_INLINE Sums sums_of(const SumElements& elements, int e) const {
    Sums sums{};
    for (int p = elements.begin[e]; p < elements.begin[e + 1]; ++p) {
      const double c = elements.coefficient[p];
      const int at = elements.particle[p];
      sums.position += c * load_four(particles_.position + at);
      sums.velocity += c * load_four(particles_.velocity + at);
    }
    return sums;
  }

  /// v += c W change
  CLOTHLAB_INLINE void give(const SumElements& elements, int e, const Four& change) {
    for (int p = elements.begin[e]; p < elements.begin[e + 1]; ++p) {
      const double c = elements.coefficient[p];
      const int at = elements.particle[p];
      Four faster = c * particles_.mobility[at >> 2] * change;
      if constexpr (dragged) {
        const Four b = load_four(particles_.drag + at);
        faster -= c * product(b, change) * b;
      }
      double* velocity = particles_.velocity + at;
      store_four(velocity, load_four(velocity) + faster);
      if constexpr (measured) {
        const double square = product(faster, faster);
        largest_ = square > largest_ ? square : largest_;
      }
    }
  }

  CLOTHLAB_INLINE void visit(const BendingProjection& bending, int e) {
    const double h = particles_.step, k = bending.stiffness[e], weight = k * h * (h + bending.time);
    const double give_alike = bending.give[e], diagonal = 1 + weight * give_alike;
    const Sums sums = sums_of(bending, e);
    const Four given = load_four(bending.impulse + 4 * e);
    Four next;
    if constexpr (dragged) {
      const Symmetric3<double> less = drag_of(bending, e);
      const Four speed = sums.velocity - give_alike * given + times(less, given);
      next = solved({diagonal - weight * less.xx, diagonal - weight * less.yy, diagonal - weight * less.zz,
                     -weight * less.xy, -weight * less.xz, -weight * less.yz},
                    -(k * h * sums.position + weight * speed));
    } else {
      const Four speed = sums.velocity - give_alike * given;
      next = -(k * h / diagonal * sums.position + weight / diagonal * speed);
    }
    store_four(bending.impulse + 4 * e, next);
    give(bending, e, next - given);
  }

  CLOTHLAB_INLINE void visit(const SliderProjection& sliders, int e) {
    const double h = particles_.step;
    const Sums sums = sums_of(sliders, e);
    const Four n = load_four(sliders.normal + 4 * e);
    double give_along = sliders.give[e] * product(n, n);
    if constexpr (dragged)
      for (int p = sliders.begin[e]; p < sliders.begin[e + 1]; ++p) {
        const double along =
            sliders.coefficient[p] * product(load_four(particles_.drag + sliders.particle[p]), n);
        give_along -= along * along;
      }
    double& given = sliders.impulse[4 * e];
    const double stretch =
        product(n, sums.position + h * sums.velocity) - sliders.slip[e] - h * give_along * given;
    const double weight = h * sliders.stiffness[e], most = h * sliders.most[e];
    const double elastic = -weight * stretch / (1 + h * weight * give_along);
    const double next = elastic > most ? most : elastic < -most ? -most : elastic;
    const double change = next - given;
    given = next;
    give(sliders, e, change * n);
  }

  /// sum c^2 b b^T
  CLOTHLAB_INLINE Symmetric3<double> drag_of(const SumElements& elements, int e) const {
    Four x{}, y{}, z{};
    for (int p = elements.begin[e]; p < elements.begin[e + 1]; ++p) {
      const Four b = elements.coefficient[p] * load_four(particles_.drag + elements.particle[p]);
      x += b[0] * b, y += b[1] * b, z += b[2] * b;
    }
    return {x[0], y[1], z[2], x[1], x[2], y[2]};
  }
  CLOTHLAB_INLINE static Four times(const Symmetric3<double>& m, const Four& v) {
    return Four{m.xx * v[0] + m.xy * v[1] + m.xz * v[2], m.xy * v[0] + m.yy * v[1] + m.yz * v[2],
                m.xz * v[0] + m.yz * v[1] + m.zz * v[2], 0};
  }
  /// By Cholesky's factors L D L^T.
  CLOTHLAB_INLINE static Four solved(const Symmetric3<double>& m, const Four& right) {
    const double b = m.xy / m.xx, c = m.xz / m.xx;
    const double d = m.yy - b * m.xy, e = (m.yz - b * m.xz) / d;
    const double f = m.zz - c * m.xz - e * e * d;
    const double y = right[1] - b * right[0], z = (right[2] - c * right[0] - e * y) / f;
    const double of_y = y / d - e * z;
    return Four{right[0] / m.xx - b * of_y - c * z, of_y, z, 0};
  }

  ProjectedParticles& particles_;
  double largest_ = 0;
};

template <bool dragged, bool measured>
class TriangleVisits {
 public:
  TriangleVisits(TriangleProjection& triangles, ProjectedParticles& particles)
      : triangles_(triangles), particles_(particles), largest_(Lanes::zero()) {}

  void all() {
    for (int block = 0; block < triangles_.blocks; ++block)
      for (int part = 0; part < widest_vector; part += Lanes::width) visit(block, part);
  }
  double largest() const {
    const LaneNumbers lanes(largest_);
    double most = 0;
    for (const double lane : lanes.of) most = lane > most ? lane : most;
    return most;
  }

 private:
  static constexpr int next[] = {1, 2, 0}, before[] = {2, 0, 1};

  /// Of one register of triangles, corner by corner or edge by edge. Edge e leads from corner e to the next.
  struct Corners {
    const int* at[3];
    V mobility[3];
    Vector drag[3], given[3], edge[3];
    V a[3];           ///< q' + t dq'/dt without the impulses
    V out[3], in[3];  ///< b of a corner along what its edges out and in push it by
  };

  CLOTHLAB_INLINE const double* numbers_of(int block, int part) const {
    return triangles_.numbers + block * projected_triangle_numbers * widest_vector + part;
  }
  CLOTHLAB_INLINE double* impulse_of(int block, int corner, int part) const {
    return triangles_.impulse + (block * 3 + corner) * 3 * widest_vector + part;
  }
  CLOTHLAB_INLINE Vector answer(const Corners& c, int corner, const Vector& impulse) const {
    const Vector alike = scaled(c.mobility[corner], impulse);
    if constexpr (!dragged) return alike;
    return minus(alike, product(c.drag[corner], impulse), c.drag[corner]);
  }

  CLOTHLAB_INLINE void read(int block, int part, Corners& c) const {
    const double* numbers = numbers_of(block, part);
    Vector x[3], v[3];
    for (int corner = 0; corner < 3; ++corner) {
      c.at[corner] = triangles_.corner + (block * 3 + corner) * widest_vector + part;
      x[corner] = Turned::lanes_at(particles_.position, c.at[corner]);
      v[corner] = Turned::lanes_at(particles_.velocity, c.at[corner]);
      c.mobility[corner] = Lanes::load(numbers + (3 + corner) * widest_vector);
      if constexpr (dragged) c.drag[corner] = Turned::lanes_at(particles_.drag, c.at[corner]);
      const double* given = impulse_of(block, corner, part);
      c.given[corner] = {Lanes::load(given), Lanes::load(given + widest_vector),
                         Lanes::load(given + 2 * widest_vector)};
    }
    const V h = Lanes::set(particles_.step), twice_time = Lanes::set(2 * triangles_.time),
            twice_both = Lanes::set(2 * (particles_.step + triangles_.time));
    Vector by_impulse[3];
    for (int corner = 0; corner < 3; ++corner) by_impulse[corner] = answer(c, corner, c.given[corner]);
    for (int e = 0; e < 3; ++e) {
      const Vector opening = v[next[e]] - v[e];
      c.edge[e] = plus(x[next[e]] - x[e], h, opening);
      const V change = Lanes::sub(squared(c.edge[e]), Lanes::load(numbers + e * widest_vector));
      const V less = product(c.edge[e], by_impulse[next[e]] - by_impulse[e]);
      c.a[e] = Lanes::fnma(twice_both, less, Lanes::fma(twice_time, product(c.edge[e], opening), change));
    }
    if constexpr (dragged)
      for (int corner = 0; corner < 3; ++corner) {
        c.out[corner] = product(c.drag[corner], c.edge[corner]);
        c.in[corner] = product(c.drag[corner], c.edge[before[corner]]);
      }
  }

  /// G/4: of edges e and e, and of the edges that meet in a corner.
  CLOTHLAB_INLINE V give_of_edge(const Corners& c, int e) const {
    const V alike = Lanes::mul(squared(c.edge[e]), Lanes::add(c.mobility[e], c.mobility[next[e]]));
    if constexpr (!dragged) return alike;
    return Lanes::fnma(c.out[e], c.out[e], Lanes::fnma(c.in[next[e]], c.in[next[e]], alike));
  }
  CLOTHLAB_INLINE V give_at_corner(const Corners& c, int corner) const {
    const V alike = Lanes::mul(c.mobility[corner], product(c.edge[before[corner]], c.edge[corner]));
    const V none = Lanes::zero();
    if constexpr (!dragged) return Lanes::sub(none, alike);
    return Lanes::fma(c.out[corner], c.in[corner], Lanes::sub(none, alike));
  }

  /// lambda, an edge's each.
  CLOTHLAB_INLINE Vector solved(const Corners& c, const double* numbers) const {
    const auto factor = [numbers](int n) { return Lanes::load(numbers + (6 + n) * widest_vector); };
    const V l00 = factor(0), l10 = factor(1), l20 = factor(2), l11 = factor(3), l21 = factor(4),
            l22 = factor(5);
    const Vector of_0{give_of_edge(c, 0), give_at_corner(c, 1), give_at_corner(c, 0)},
        of_1{of_0.y, give_of_edge(c, 1), give_at_corner(c, 2)}, of_2{of_0.z, of_1.z, give_of_edge(c, 2)};
    const Vector first{l00, l10, l20}, second{Lanes::zero(), l11, l21};
    const Vector by_first{product(of_0, first), product(of_1, first), product(of_2, first)};
    const V by_second_1 = product(of_1, second), by_second_2 = product(of_2, second);
    const double h = particles_.step;
    const V weight = Lanes::set(4 * h * (h + triangles_.time)), one = Lanes::set(1);
    const V xx = Lanes::fma(weight, product(first, by_first), one),
            xy = Lanes::mul(weight, product(second, by_first)),
            xz = Lanes::mul(weight, Lanes::mul(l22, by_first.z)),
            yy = Lanes::fma(weight, Lanes::fma(l11, by_second_1, Lanes::mul(l21, by_second_2)), one),
            yz = Lanes::mul(weight, Lanes::mul(l22, by_second_2)),
            zz = Lanes::fma(weight, Lanes::mul(Lanes::mul(l22, l22), of_2.z), one);
    const Vector a{c.a[0], c.a[1], c.a[2]};
    const V right_x = product(first, a), right_y = product(second, a), right_z = Lanes::mul(l22, a.z);
    // By Cholesky's factors L D L^T.
    const V b = Lanes::div(xy, xx), f = Lanes::div(xz, xx);
    const V d = Lanes::fnma(b, xy, yy), e = Lanes::div(Lanes::fnma(b, xz, yz), d);
    const V last = Lanes::fnma(f, xz, Lanes::fnma(Lanes::mul(e, e), d, zz));
    const V y = Lanes::fnma(b, right_x, right_y);
    const V of_z = Lanes::div(Lanes::fnma(e, y, Lanes::fnma(f, right_x, right_z)), last);
    const V of_y = Lanes::fnma(e, of_z, Lanes::div(y, d));
    const V of_x = Lanes::fnma(f, of_z, Lanes::fnma(b, of_y, Lanes::div(right_x, xx)));
    const V minus_h = Lanes::set(-h);
    return {Lanes::mul(minus_h, Lanes::mul(l00, of_x)),
            Lanes::mul(minus_h, Lanes::fma(l10, of_x, Lanes::mul(l11, of_y))),
            Lanes::mul(minus_h, Lanes::fma(l20, of_x, Lanes::fma(l21, of_y, Lanes::mul(l22, of_z))))};
  }

  CLOTHLAB_INLINE void visit(int block, int part) {
    Corners c;
    read(block, part, c);
    const Vector solution = solved(c, numbers_of(block, part));
    const V lambda[] = {solution.x, solution.y, solution.z};
    const V two = Lanes::set(2);
    for (int corner = 0; corner < 3; ++corner) {
      const int in = before[corner];
      const Vector impulse = minus(scaled(Lanes::mul(two, lambda[in]), c.edge[in]),
                                   Lanes::mul(two, lambda[corner]), c.edge[corner]);
      double* to = impulse_of(block, corner, part);
      Lanes::store(to, impulse.x), Lanes::store(to + widest_vector, impulse.y);
      Lanes::store(to + 2 * widest_vector, impulse.z);
      give(c, corner, answer(c, corner, impulse - c.given[corner]));
    }
  }

  CLOTHLAB_INLINE void give(const Corners& c, int corner, const Vector& faster) {
    Turned changes;
    Lanes::put(changes.of, faster.x, faster.y, faster.z);
    for (int k = 0; k < Lanes::width; ++k) {
      double* velocity = particles_.velocity + c.at[corner][k];
      store_four(velocity, load_four(velocity) + load_four(changes.lane(k)));
    }
    if constexpr (measured) largest_ = Lanes::max(squared(faster), largest_);
  }

  TriangleProjection& triangles_;
  ProjectedParticles& particles_;
  V largest_;
};

template <bool dragged, bool measured>
void project_elements_with(ElementProjection& elements, ProjectedParticles& particles) {
  SumVisits<dragged, measured> sums(particles);
  sums.all(elements.bending);
  sums.all(elements.sliders);
  TriangleVisits<dragged, measured> triangles(elements.triangles, particles);
  triangles.all();
  if (measured)
    particles.largest_change = sums.largest() > triangles.largest() ? sums.largest() : triangles.largest();
}

void project_elements(ElementProjection& elements, ProjectedParticles& particles) {
  if (particles.drag)
    particles.measures ? project_elements_with<true, true>(elements, particles)
                       : project_elements_with<true, false>(elements, particles);
  else
    particles.measures ? project_elements_with<false, true>(elements, particles)
                       : project_elements_with<false, false>(elements, particles);
}

}  // namespace
}  // namespace cloth::kernels

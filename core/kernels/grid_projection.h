// XPBD's visits of the springs of a grid (integrators/xpbd.h), many at a time. A visit of the spring from i
// to j, whose impulse is 0 before it, with d = x_j - x_i + h (v_j - v_i) and l = |d|:
//
//     P = -h (k (1 - L/l) + k_d (v_j - v_i) . d/l^2) / (1 + h (h k + k_d) (w_i + w_j)) d
//     v_i -= w_i P,  v_j += w_j P
//
// Macklin et al. 2016, Eq. (18) and (26), with velocities for positions. Springs that are visited at the same
// time share no particle. They are visited in this order, each direction over all rows before the next:
//
//     along the rows, in each row from columns 0, 2, ... then 1, 3, ... to the next column, and from 0, 1,
//     4, 5, ... then 2, 3, 6, 7, ... to the one after it
//     down one row, diagonally, antidiagonally: from rows 0, 2, ... and then from rows 1, 3, ...
//     down two rows: from rows 0, 1, 4, 5, ... and then from rows 2, 3, 6, 7, ...
//
// (Row by row, all directions of a row before the next row, would read memory once too, but is unstable.) A
// row is visited by a pass as soon as the passes before have done with it, so that memory is read once: the
// bits are those of one pass after the other.
#pragma once

#include "kernels/grid_pass.h"

namespace cloth::kernels {
namespace {

/// A pass over the rows.
struct RowPass {
  unsigned springs;  ///< a SpringBit; 0: both directions along the rows
  int number;        ///< of the SpringBit
  int reach;         ///< rows down
  int turn;          ///< 0 or 1: which rows it begins at; -1: all
};
constexpr RowPass row_passes[] = {{0, 0, 0, -1},           {down_one, 2, 1, 0}, {down_one, 2, 1, 1},
                                  {diagonal, 4, 1, 0},     {diagonal, 4, 1, 1}, {antidiagonal, 5, 1, 0},
                                  {antidiagonal, 5, 1, 1}, {down_two, 3, 2, 0}, {down_two, 3, 2, 1}};
constexpr int row_pass_count = 9;

/// One end of springs: from where its particles are read.
struct EndPointers {
  const double *x, *y, *z, *mobility;
  double *vx, *vy, *vz;
};

struct Lanes3 {
  Lanes::V x, y, z;
};

/// What a direction's visits need. With one mobility w the factor w h / (1 + h (h k + k_d) 2 w) belongs to k,
/// k L and k_d already.
struct VisitFactors {
  Lanes::Spring spring;
  Lanes::V damping, give, step;  ///< `give`: h (h k + k_d)
};

template <bool alike, bool damped>
class SpringVisits {
 public:
  explicit SpringVisits(const Projection& pass) : pass_(pass), largest_(Lanes::zero()) {}

  void row(const RowPass& rows, int row) {
    if (rows.springs == 0) {
      if (pass_.grid.springs & right_one) along_row<right_one, 0>(row);
      if (pass_.grid.springs & right_two) along_row<right_two, 1>(row);
      return;
    }
    const int columns = pass_.grid.columns;
    const VisitFactors f = factors(rows.number);
    switch (rows.springs) {
      case down_one:
        return across_rows<down_one>(end(row, 0), end(row + 1, 0), columns, f);
      case diagonal:
        return across_rows<diagonal>(end(row, 0), end(row + 1, 1), columns - 1, f);
      case antidiagonal:
        return across_rows<antidiagonal>(end(row, 1), end(row + 1, 0), columns - 1, f);
      default:
        return across_rows<down_two>(end(row, 0), end(row + 2, 0), columns, f);
    }
  }

  double largest() const {
    double lanes[Lanes::width], most = 0;
    Lanes::store(lanes, largest_);
    for (const double lane : lanes) most = lane > most ? lane : most;
    return most;
  }

 private:
  EndPointers end(int row, int column) const {
    const long at = static_cast<long>(row) * pass_.grid.columns + column;
    const RowBlock &x = pass_.position, &v = pass_.velocity;
    return {x.x + at, x.y + at, x.z + at, pass_.mobility + at, v.x + at, v.y + at, v.z + at};
  }

  VisitFactors factors(int number) const {
    const SpringKind& kind = pass_.grid.kind[number];
    const double h = pass_.step, give = h * (h * kind.stiffness + pass_.spring_damping);
    const double w = pass_.common_mobility, part = alike ? w * h / (1 + give * 2 * w) : h;
    return {Lanes::spring(part * kind.stiffness, part * kind.rest_tension),
            Lanes::set(part * pass_.spring_damping), Lanes::set(give), Lanes::set(h)};
  }

  /// The visits of a vector of springs: from x_j - x_i and the velocities of both ends, which it changes.
  /// `counts`: 0 in lanes that are no spring.
  template <bool Divide>
  CLOTHLAB_INLINE void visit(const Lanes3& first, Lanes3& vi, Lanes3& vj, Lanes::V wi, Lanes::V wj,
                             const VisitFactors& f, const Lanes::V* counts) {
    const Lanes3 speed{Lanes::sub(vj.x, vi.x), Lanes::sub(vj.y, vi.y), Lanes::sub(vj.z, vi.z)};
    const Lanes3 d{Lanes::fma(f.step, speed.x, first.x), Lanes::fma(f.step, speed.y, first.y),
                   Lanes::fma(f.step, speed.z, first.z)};
    const Lanes::V s = Lanes::fma(d.z, d.z, Lanes::fma(d.y, d.y, Lanes::mul(d.x, d.x)));
    Lanes::V scale;
    if constexpr (damped) {
      const Lanes::V inverse = Lanes::inverse_root<Divide>(s);
      const Lanes::V rate = Lanes::fma(speed.z, d.z, Lanes::fma(speed.y, d.y, Lanes::mul(speed.x, d.x)));
      scale = Lanes::fma(f.damping, Lanes::mul(rate, Lanes::mul(inverse, inverse)),
                         Lanes::scale_at(inverse, f.spring));
    } else {
      scale = Lanes::spring_scale<Divide>(s, f.spring);
    }
    if (counts) scale = Lanes::mul(scale, *counts);
    if constexpr (alike) {
      move(scale, d, vi, vj);
      largest_ = Lanes::max(Lanes::mul(Lanes::mul(scale, scale), s), largest_);
    } else {
      scale = Lanes::div(scale, Lanes::fma(f.give, Lanes::add(wi, wj), Lanes::set(1)));
      const Lanes::V by_i = Lanes::mul(wi, scale), by_j = Lanes::mul(wj, scale);
      vi = {Lanes::fma(by_i, d.x, vi.x), Lanes::fma(by_i, d.y, vi.y), Lanes::fma(by_i, d.z, vi.z)};
      vj = {Lanes::fnma(by_j, d.x, vj.x), Lanes::fnma(by_j, d.y, vj.y), Lanes::fnma(by_j, d.z, vj.z)};
      const Lanes::V most = Lanes::max(Lanes::mul(by_i, by_i), Lanes::mul(by_j, by_j));
      largest_ = Lanes::max(Lanes::mul(most, s), largest_);
    }
  }

  CLOTHLAB_INLINE static void move(Lanes::V scale, const Lanes3& d, Lanes3& vi, Lanes3& vj) {
    vi = {Lanes::fma(scale, d.x, vi.x), Lanes::fma(scale, d.y, vi.y), Lanes::fma(scale, d.z, vi.z)};
    vj = {Lanes::fnma(scale, d.x, vj.x), Lanes::fnma(scale, d.y, vj.y), Lanes::fnma(scale, d.z, vj.z)};
  }

  // Lanes beyond `count` are at one place and at rest: nothing moves them.

  CLOTHLAB_INLINE static Lanes::V read(const double* p, int count) {
    return count >= Lanes::width ? Lanes::load(p) : Lanes::load(p, count, Lanes::zero());
  }
  CLOTHLAB_INLINE static Lanes3 place(const EndPointers& e, int at, int count) {
    return {read(e.x + at, count), read(e.y + at, count), read(e.z + at, count)};
  }
  CLOTHLAB_INLINE static Lanes3 speed(const EndPointers& e, int at, int count) {
    return {read(e.vx + at, count), read(e.vy + at, count), read(e.vz + at, count)};
  }
  CLOTHLAB_INLINE static void write(const EndPointers& e, int at, int count, const Lanes3& v) {
    if (count >= Lanes::width) {
      Lanes::store(e.vx + at, v.x), Lanes::store(e.vy + at, v.y), Lanes::store(e.vz + at, v.z);
    } else {
      Lanes::store(e.vx + at, v.x, count), Lanes::store(e.vy + at, v.y, count);
      Lanes::store(e.vz + at, v.z, count);
    }
  }
  CLOTHLAB_INLINE static Lanes3 between(const Lanes3& a, const Lanes3& b) {
    return {Lanes::sub(b.x, a.x), Lanes::sub(b.y, a.y), Lanes::sub(b.z, a.z)};
  }

  /// `count` springs from i, i + 1, ... to j, j + 1, ... of another row.
  template <unsigned bit>
  void across_rows(const EndPointers& i, const EndPointers& j, int count, const VisitFactors& f) {
    int at = 0;
    for (; at + Lanes::width <= count; at += Lanes::width) across_vector<bit>(i, j, at, Lanes::width, f);
    if (at < count) across_vector<bit>(i, j, at, count - at, f);
  }
  template <unsigned bit>
  CLOTHLAB_INLINE void across_vector(const EndPointers& i, const EndPointers& j, int at, int count,
                                     const VisitFactors& f) {
    const Lanes3 first = between(place(i, at, count), place(j, at, count));
    Lanes3 vi = speed(i, at, count), vj = speed(j, at, count);
    Lanes::V wi = Lanes::zero(), wj = Lanes::zero();
    if constexpr (!alike) wi = read(i.mobility + at, count), wj = read(j.mobility + at, count);
    visit<(Lanes::divided & bit) != 0>(first, vi, vj, wi, wj, f, nullptr);
    write(i, at, count, vi);
    write(j, at, count, vj);
  }

  template <unsigned bit, int number>
  void along_row(int row) {
    constexpr int reach = bit == right_one ? 1 : 2;
    const VisitFactors f = factors(number);
    const EndPointers begin = end(row, 0);
    for (int start = 0; start <= reach; start += reach) {
      int at = start;
      for (; at + 2 * Lanes::width <= pass_.grid.columns; at += 2 * Lanes::width)
        along_vectors<bit>(begin, at, 2 * Lanes::width, f, nullptr);
      if (at + reach >= pass_.grid.columns) continue;
      const int count = pass_.grid.columns - at;
      const Lanes::V one = Lanes::set(1), none = Lanes::zero();
      double ones[Lanes::width];
      Lanes::store(ones, one);
      Lanes::V first, counts;  // a spring is there where its second end is
      split<bit>(Lanes::load(ones, count, none), Lanes::load(ones, count - Lanes::width, none), first,
                 counts);
      along_vectors<bit>(begin, at, count, f, &counts);
    }
  }

  template <unsigned bit>
  CLOTHLAB_INLINE static void split(Lanes::V a, Lanes::V b, Lanes::V& first, Lanes::V& second) {
    if constexpr (bit == right_one)
      Lanes::pairs_one(a, b, first, second);
    else
      Lanes::pairs_two(a, b, first, second);
  }
  template <unsigned bit>
  CLOTHLAB_INLINE static void split(const Lanes3& a, const Lanes3& b, Lanes3& first, Lanes3& second) {
    split<bit>(a.x, b.x, first.x, second.x), split<bit>(a.y, b.y, first.y, second.y);
    split<bit>(a.z, b.z, first.z, second.z);
  }
  template <unsigned bit>
  CLOTHLAB_INLINE static void join(Lanes::V first, Lanes::V second, Lanes::V& a, Lanes::V& b) {
    if constexpr (bit == right_one)
      Lanes::unpair_one(first, second, a, b);
    else
      Lanes::unpair_two(first, second, a, b);
  }

  /// The springs among two vectors of columns from `at` on, of which `count` are there.
  template <unsigned bit>
  CLOTHLAB_INLINE void along_vectors(const EndPointers& e, int at, int count, const VisitFactors& f,
                                     const Lanes::V* counts) {
    constexpr int width = Lanes::width;
    Lanes3 xi, xj, vi, vj;
    split<bit>(place(e, at, count), place(e, at + width, count - width), xi, xj);
    split<bit>(speed(e, at, count), speed(e, at + width, count - width), vi, vj);
    Lanes::V wi = Lanes::zero(), wj = Lanes::zero();
    if constexpr (!alike)
      split<bit>(read(e.mobility + at, count), read(e.mobility + at + width, count - width), wi, wj);
    visit<(Lanes::divided & bit) != 0>(between(xi, xj), vi, vj, wi, wj, f, counts);
    Lanes3 a, b;
    join<bit>(vi.x, vj.x, a.x, b.x), join<bit>(vi.y, vj.y, a.y, b.y), join<bit>(vi.z, vj.z, a.z, b.z);
    write(e, at, count, a);
    write(e, at + width, count - width, b);
  }

  const Projection& pass_;
  Lanes::V largest_;
};

bool takes_row(const RowPass& pass, int row, int rows) {
  if (row < 0 || row + pass.reach >= rows) return false;
  return pass.turn < 0 || ((pass.reach == 2 ? row >> 1 : row) & 1) == pass.turn;
}

template <bool damped>
void project_all(Projection& pass) {
  SpringVisits<true, damped> alike(pass);
  SpringVisits<false, damped> others(pass);
  int delay[row_pass_count], last = 0;  // rows that a pass is behind the first one
  for (int p = 0; p < row_pass_count; ++p) delay[p] = last += row_passes[p].reach;
  for (int front = 0; front < pass.grid.rows + last; ++front)
    for (int p = 0; p < row_pass_count; ++p) {
      const RowPass& rows = row_passes[p];
      const int row = front - delay[p];
      if (rows.springs && !(pass.grid.springs & rows.springs)) continue;
      if (!takes_row(rows, row, pass.grid.rows)) continue;
      if (pass.is_alike[row] && pass.is_alike[row + rows.reach])
        alike.row(rows, row);
      else
        others.row(rows, row);
    }
  const double of_alike = alike.largest(), of_others = others.largest();
  pass.largest_change = of_alike > of_others ? of_alike : of_others;
}

void project_springs(Projection& pass) {
  pass.spring_damping > 0 ? project_all<true>(pass) : project_all<false>(pass);
}

}  // namespace
}  // namespace cloth::kernels

#include "sparse/block_multigrid.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "geometry/at.h"
#include "geometry/dense_decompositions.h"
#include "kernels/instruction_set.h"
#include "sparse/block_coarsen_kernels.h"
#include "sparse/without_denormals.h"

namespace cloth {
namespace {

std::size_t in_registers(std::size_t count) {
  constexpr std::size_t lanes = BlockLevel::lanes;
  return (count + lanes - 1) / lanes * lanes;
}

std::size_t size_of(const NaturalBlocks& blocks) {
  return static_cast<std::size_t>(blocks.particles());
}

/// The inverse of a block, six numbers each `stride` apart; zero of a fixed particle's. A small part of its
/// trace is added, so that rounding to single precision leaves it positive.
void invert_block(const float* block, std::size_t stride, float* inverse, std::size_t inverse_stride) {
  double xx = block[0], yy = block[3 * stride], zz = block[5 * stride];
  const double xy = block[stride], xz = block[2 * stride], yz = block[4 * stride];
  const double trace = xx + yy + zz;
  double numbers[6] = {};
  if (trace > 0) {
    const double more = 1e-7 * trace;
    xx += more, yy += more, zz += more;
    const double a = yy * zz - yz * yz, b = xz * yz - xy * zz, c = xy * yz - xz * yy;
    const double scale = 1 / (xx * a + xy * b + xz * c);
    numbers[0] = a * scale, numbers[1] = b * scale, numbers[2] = c * scale;
    numbers[3] = (xx * zz - xz * xz) * scale, numbers[4] = (xy * xz - xx * yz) * scale;
    numbers[5] = (xx * yy - xy * xy) * scale;
  }
  for (std::size_t n = 0; n < 6; ++n) inverse[n * inverse_stride] = static_cast<float>(numbers[n]);
}

}  // namespace

void BlockMultigrid::begin(int rows, int columns, Interpolation interpolation) {
  kernels_ = &active_kernels<BlockCycleKernels>();
  fixed_.clear();
  if (rows != rows_ || columns != columns_ || interpolation != interpolation_) {
    rows_ = rows, columns_ = columns, interpolation_ = interpolation;
    is_turned_ = rows > columns;
    add_levels();
  }
  NaturalBlocks& finest = levels_.front().natural;
  for (int k = 0; k <= finest.couplings(); ++k)
    if (finest.used[k]) std::fill_n(finest.blocks_of(k), 6 * finest.particles(), 0.0f);
  std::fill(std::begin(finest.used), std::end(finest.used), false);
  finest.used[0] = true;  // also of a matrix without anything
}

/// visit(k, place) for the particles first + k, k < count, with their places in the finest level.
template <class Visit>
void BlockMultigrid::for_each_place(std::size_t first, std::size_t count, Visit visit) const {
  if (!is_turned_) {
    for (std::size_t k = 0; k < count; ++k) visit(k, first + k);
    return;
  }
  std::size_t row = first / at(columns_), column = first % at(columns_);
  for (std::size_t k = 0; k < count; ++k) {
    visit(k, column * at(rows_) + row);
    if (++column == at(columns_)) column = 0, ++row;
  }
}

std::size_t BlockMultigrid::place_of(std::size_t particle) const {
  const std::size_t columns = at(columns_);
  return is_turned_ ? particle % columns * at(rows_) + particle / columns : particle;
}

void BlockMultigrid::add_levels() {
  levels_.clear();
  int rows = is_turned_ ? columns_ : rows_, columns = is_turned_ ? rows_ : columns_;
  for (;;) {
    const bool is_finest = levels_.empty();
    add_level(rows, columns, is_finest || interpolation_ == Interpolation::linear ? 2 : 3);
    if (rows <= fewest && columns <= fewest) return;
    rows = levels_.back().row_interpolation.coarse_points();
    columns = levels_.back().column_interpolation.coarse_points();
  }
}

void BlockMultigrid::add_level(int rows, int columns, int reach) {
  Level& level = levels_.emplace_back();
  level.row_interpolation = {rows, rows > fewest, interpolation_};
  level.column_interpolation = {columns, columns > fewest, interpolation_};
  level.natural.rows = level.loops.rows = rows;
  level.natural.columns = level.loops.columns = columns;
  level.natural.reach = reach;
  level.natural_numbers.assign(6 * at(1 + level.natural.couplings()) * size_of(level.natural), 0.0f);
  level.natural.numbers = level.natural_numbers.data();

  // Behind each segment lies a zero for a neighbour beyond the border, before the first and behind the last
  // a whole register. An odd number of cache lines, so that rows do not meet in the same set of the cache.
  constexpr std::size_t lanes = BlockLevel::lanes;
  const std::size_t colours = at(reach) + 1;
  const std::size_t segment = in_registers((at(columns) + colours - 1) / colours + 1);
  std::size_t width = colours * segment + 2 * lanes;
  if (width / lanes % 2 == 0) width += lanes;
  if (row_.size() < 2 * width) row_.resize(2 * width);
  level.loops.colours = reach + 1;
  level.loops.segment = static_cast<std::ptrdiff_t>(segment);
  level.loops.width = static_cast<std::ptrdiff_t>(width);
  for (std::size_t c = 0; c < at(columns); ++c)
    level.place.push_back(static_cast<int>(c % colours * segment + c / colours));

  const std::size_t field = at(rows + 2 * reach) * 3 * width;
  level.origin = at(reach) * 3 * width + lanes;
  level.vectors.assign(3 * field + lanes, 0.0f);
  level.loops.x = level.vectors.data() + level.origin;
  level.loops.b = level.loops.x + field;
  level.loops.r = level.loops.b + field;
  level.inverse.assign(static_cast<std::size_t>(rows) * 6 * width + lanes, 0.0f);
  level.loops.inverse = level.inverse.data() + lanes;
}

void BlockMultigrid::add_blocks(int coupling, std::size_t first, std::size_t count, double scale,
                                const std::array<const double*, 6>& blocks) {
  NaturalBlocks& natural = levels_.front().natural;
  natural.used[coupling] = true;
  for (std::size_t n = 0; n < 6; ++n) {
    float* to = natural.blocks_of(coupling) + n * size_of(natural);
    const double* from = blocks[n];
    for_each_place(first, count, [&](std::size_t k, std::size_t place) {
      to[place] += static_cast<float>(scale * from[k]);
    });
  }
}

void BlockMultigrid::add_identity(int coupling, std::size_t first, std::size_t count, double value) {
  NaturalBlocks& natural = levels_.front().natural;
  natural.used[coupling] = true;
  for (const std::size_t n : {0u, 3u, 5u}) {
    float* to = natural.blocks_of(coupling) + n * size_of(natural);
    for_each_place(first, count,
                   [&](std::size_t, std::size_t place) { to[place] += static_cast<float>(value); });
  }
}

/// The number of the coupling between the particles `first` and first + offset; `first` becomes the one that
/// it is kept with. None where they lie too far apart.
std::optional<int> BlockMultigrid::find_coupling(std::size_t& first, int offset) const {
  const NaturalBlocks& natural = levels_.front().natural;
  const int row = static_cast<int>(first) / columns_, column = static_cast<int>(first) % columns_;
  const int end = static_cast<int>(first) + offset;
  BlockCoupling coupling{end / columns_ - row, end % columns_ - column};
  if (coupling.down > natural.reach || std::abs(coupling.right) > natural.reach) return std::nullopt;
  if (is_turned_) {
    std::swap(coupling.down, coupling.right);
    if (coupling.down < 0) {  // the other particle is the earlier one here
      coupling = {-coupling.down, -coupling.right};
      first += at(offset);
    }
  }
  return natural.number_of(coupling);
}

bool BlockMultigrid::add_couplings(std::size_t first, std::size_t count, int offset, double scale,
                                   const std::array<const double*, 6>& blocks) {
  const std::optional<int> coupling = find_coupling(first, offset);
  if (coupling) add_blocks(*coupling, first, count, scale, blocks);
  return coupling.has_value();
}

bool BlockMultigrid::add_couplings(std::size_t first, std::size_t count, int offset, double value) {
  const std::optional<int> coupling = find_coupling(first, offset);
  if (coupling) add_identity(*coupling, first, count, value);
  return coupling.has_value();
}

void BlockMultigrid::fix(std::size_t particle) {
  const NaturalBlocks& natural = levels_.front().natural;
  const std::size_t place = place_of(particle), size = size_of(natural);
  const int row = static_cast<int>(place) / natural.columns,
            column = static_cast<int>(place) % natural.columns;
  const auto clear = [&](int coupling, std::size_t of) {
    for (std::size_t n = 0; n < 6; ++n) natural.blocks_of(coupling)[n * size + of] = 0;
  };
  clear(0, place);
  for (int k = 1; k <= natural.couplings(); ++k) {
    clear(k, place);
    const BlockCoupling coupling = natural.coupling(k);
    const int r = row - coupling.down, c = column - coupling.right;
    if (r >= 0 && c >= 0 && c < natural.columns) clear(k, at(r * natural.columns + c));
  }
  fixed_.push_back(place);
}

/// Where the neighbours of a colour lie, and where the blocks of their couplings: those to later particles
/// with the particle itself, the others with the neighbour.
void BlockMultigrid::set_neighbours(Level& level) {
  BlockLevel& l = level.loops;
  std::vector<int> kept;
  for (int k = 1; k <= level.natural.couplings(); ++k)
    if (level.natural.used[k]) kept.push_back(k);
  l.couplings = static_cast<int>(kept.size());
  const std::ptrdiff_t row_of_blocks = 6 * l.couplings * l.width;
  for (int c = 0; c < l.colours; ++c) {
    std::vector<BlockNeighbour> earlier, later;
    for (std::size_t n = 0; n < kept.size(); ++n)
      for (const int sign : {1, -1}) {
        const BlockCoupling coupling = level.natural.coupling(kept[n]);
        const int down = sign * coupling.down, column = c + sign * coupling.right;
        const int beside = column < 0 ? -1 : column / l.colours, colour = column - l.colours * beside;
        const std::ptrdiff_t along = (colour - c) * l.segment + beside;
        const std::ptrdiff_t own = static_cast<std::ptrdiff_t>(6 * n) * l.width;
        const BlockNeighbour neighbour{down * 3 * l.width + along,
                                       sign > 0 ? own : own + down * row_of_blocks + along};
        const bool is_later = down > 0 || (down == 0 && colour > c);
        (is_later ? later : earlier).push_back(neighbour);
      }
    BlockLevel::Colour& to = l.colour[c];
    to.earlier = static_cast<int>(earlier.size()), to.all = static_cast<int>(earlier.size() + later.size());
    std::copy(later.begin(), later.end(), std::copy(earlier.begin(), earlier.end(), to.neighbour));
  }
}

/// From the order of particles into segments.
void BlockMultigrid::arrange(Level& level) {
  set_neighbours(level);
  BlockLevel& l = level.loops;
  const std::size_t rows = at(l.rows), columns = at(l.columns), size = rows * columns;
  const std::size_t width = static_cast<std::size_t>(l.width), reach = at(level.natural.reach);
  const std::size_t row_of_blocks = 6 * at(l.couplings) * width;
  const std::size_t before = reach * row_of_blocks + BlockLevel::lanes;
  const std::size_t wanted = before + (rows + reach) * row_of_blocks + BlockLevel::lanes;
  if (level.blocks.size() != wanted) level.blocks.assign(wanted, 0.0f);
  float* blocks = level.blocks.data() + before;
  l.blocks = blocks;
  float* inverse = level.inverse.data() + BlockLevel::lanes;
  std::size_t kept = 0;
  for (int k = 1; k <= level.natural.couplings(); ++k) {
    if (!level.natural.used[k]) continue;
    for (std::size_t n = 0; n < 6; ++n)
      for (std::size_t r = 0; r < rows; ++r) {
        const float* from = level.natural.blocks_of(k) + n * size + r * columns;
        float* to = blocks + r * row_of_blocks + (6 * kept + n) * width;
        for (std::size_t c = 0; c < columns; ++c) to[level.place[c]] = from[c];
      }
    ++kept;
  }
  for (std::size_t r = 0; r < rows; ++r)
    for (std::size_t c = 0; c < columns; ++c)
      invert_block(level.natural.numbers + r * columns + c, size,
                   inverse + r * 6 * width + at(level.place[c]), width);
}

bool BlockMultigrid::prepare() {
  const BlockCoarsenKernels& kernels = active_kernels<BlockCoarsenKernels>();
  for (std::size_t n = 0; n + 1 < levels_.size(); ++n) {
    Level &fine = levels_[n], &coarse = levels_[n + 1];
    const std::size_t scratch = BlockCoarsenKernels::scratch(fine.natural, coarse.natural);
    if (scratch_.size() < scratch) scratch_.resize(scratch);
    kernels.coarsen(fine.natural, fine.row_interpolation.line(), fine.column_interpolation.line(),
                    coarse.natural, scratch_.data());
    arrange(fine);
  }
  return invert_coarsest();
}

bool BlockMultigrid::invert_coarsest() {
  const Level& level = levels_.back();
  const int rows = level.natural.rows, columns = level.natural.columns;
  const std::size_t size = size_of(level.natural);
  const Eigen::Index numbers = 3 * static_cast<Eigen::Index>(size);
  constexpr int symmetric[3][3] = {{0, 1, 2}, {1, 3, 4}, {2, 4, 5}};
  Eigen::MatrixXd dense = Eigen::MatrixXd::Zero(numbers, numbers);
  for (int k = 0; k <= level.natural.couplings(); ++k) {
    if (!level.natural.used[k]) continue;
    const BlockCoupling coupling = level.natural.coupling(k);
    for (int r = 0; r + coupling.down < rows; ++r)
      for (int c = std::max(0, -coupling.right); c < columns - std::max(0, coupling.right); ++c) {
        const int i = r * columns + c, j = (r + coupling.down) * columns + c + coupling.right;
        for (int a = 0; a < 3; ++a)
          for (int b = 0; b < 3; ++b) {
            const double value = level.natural.numbers[at(6 * k + symmetric[a][b]) * size + at(i)];
            dense(3 * i + a, 3 * j + b) = dense(3 * j + b, 3 * i + a) = value;
          }
      }
  }
  const double largest = dense.diagonal().maxCoeff();
  if (!(largest > 0) || !std::isfinite(largest)) return false;
  for (Eigen::Index i = 0; i < numbers; ++i)  // fixed ones, and what single precision may have left out
    dense(i, i) = dense(i, i) == 0 ? largest : dense(i, i) + 1e-7 * largest;
  const std::optional<Eigen::MatrixXd> inverse = positive_inverse(dense);
  if (!inverse) return false;
  coarsest_.assign(inverse->data(), inverse->data() + inverse->size());
  return true;
}

void BlockMultigrid::solve_coarsest() {
  const Level& level = levels_.back();
  const std::size_t size = size_of(level.natural), columns = at(level.natural.columns);
  const auto width = static_cast<std::size_t>(level.loops.width);
  std::vector<double> b(3 * size);
  const auto number = [&](std::size_t k) {
    const std::size_t i = k / 3;
    return (3 * (i / columns) + k % 3) * width + at(level.place[i % columns]);
  };
  for (std::size_t k = 0; k < b.size(); ++k) b[k] = level.loops.b[number(k)];
  for (std::size_t k = 0; k < b.size(); ++k) {
    double sum = 0;
    for (std::size_t j = 0; j < b.size(); ++j) sum += coarsest_[k * b.size() + j] * b[j];
    level.loops.x[number(k)] = static_cast<float>(sum);
  }
}

/// coarse.b = P^T fine.r: rows as they lie, which all have one order, then columns by their places.
void BlockMultigrid::restrict_residual(const Level& fine, Level& coarse) {
  const BlockLevel &f = fine.loops, &c = coarse.loops;
  const CoarseLine rows = fine.row_interpolation.line(), columns = fine.column_interpolation.line();
  float *sums = row_.data(), *in_order = sums + row_.size() / 2;
  for (std::ptrdiff_t n = 0; n < 3; ++n)
    for (int to = 0; to < c.rows; ++to) {
      const LineWeights& of_rows = rows.children[to];
      set_weighted(of_rows, f.r + n * f.width, 3 * f.width, f.colours * f.segment, sums);
      for (int column = 0; column < f.columns; ++column) in_order[column] = sums[fine.place[at(column)]];
      float* wanted = c.b + (3 * to + n) * c.width;
      for (int column = 0; column < c.columns; ++column)
        wanted[coarse.place[at(column)]] = weighted(columns.children[column], in_order);
    }
}

/// fine.x += P coarse.x; fixed particles of the finest stay zero.
void BlockMultigrid::add_correction(Level& fine, const Level& coarse) {
  const BlockLevel &f = fine.loops, &c = coarse.loops;
  const CoarseLine rows = fine.row_interpolation.line(), columns = fine.column_interpolation.line();
  float *sums = row_.data(), *in_order = sums + row_.size() / 2;
  for (std::ptrdiff_t n = 0; n < 3; ++n)
    for (int to = 0; to < f.rows; ++to) {
      set_weighted(rows.parents[to], c.x + n * c.width, 3 * c.width, c.colours * c.segment, sums);
      for (int column = 0; column < c.columns; ++column) in_order[column] = sums[coarse.place[at(column)]];
      float* corrected = f.x + (3 * to + n) * f.width;
      for (int column = 0; column < f.columns; ++column)
        corrected[fine.place[at(column)]] += weighted(columns.parents[column], in_order);
    }
  if (&fine != &levels_.front()) return;
  for (const std::size_t fixed : fixed_) {
    const std::size_t r = fixed / at(f.columns), place = at(fine.place[fixed % at(f.columns)]);
    for (std::size_t n = 0; n < 3; ++n) f.x[(3 * r + n) * static_cast<std::size_t>(f.width) + place] = 0;
  }
}

void BlockMultigrid::cycle(std::size_t number) {
  if (number + 1 == levels_.size()) return solve_coarsest();
  Level &level = levels_[number], &coarse = levels_[number + 1];
  kernels_->descend(level.loops);
  restrict_residual(level, coarse);
  cycle(number + 1);
  add_correction(level, coarse);
  kernels_->ascend(level.loops);
}

void BlockMultigrid::solve(const Vec3Field& residual, Vec3Field& correction) {
  const WithoutDenormals scope;
  Level& finest = levels_.front();
  const BlockLevel& l = finest.loops;
  const double* given[3] = {residual.x(), residual.y(), residual.z()};
  double* wanted[3] = {correction.x(), correction.y(), correction.z()};
  const std::ptrdiff_t next_row = is_turned_ ? 1 : columns_, next_column = is_turned_ ? columns_ : 1;
  for (std::ptrdiff_t n = 0; n < 3; ++n)
    for (int r = 0; r < l.rows; ++r) {
      const double* from = given[n] + r * next_row;
      float* to = l.b + (3 * r + n) * l.width;
      for (int c = 0; c < l.columns; ++c) to[finest.place[at(c)]] = static_cast<float>(from[c * next_column]);
    }
  cycle(0);
  for (std::ptrdiff_t n = 0; n < 3; ++n)
    for (int r = 0; r < l.rows; ++r) {
      const float* from = l.x + (3 * r + n) * l.width;
      double* to = wanted[n] + r * next_row;
      for (int c = 0; c < l.columns; ++c) to[c * next_column] = from[finest.place[at(c)]];
    }
}

std::size_t BlockMultigrid::memory() const {
  std::size_t floats = scratch_.size();
  for (const Level& level : levels_)
    floats +=
        level.natural_numbers.size() + level.blocks.size() + level.inverse.size() + level.vectors.size();
  return floats * sizeof(float) + coarsest_.size() * sizeof(double);
}

}  // namespace cloth

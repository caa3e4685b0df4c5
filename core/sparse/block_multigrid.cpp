#include "sparse/block_multigrid.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include "geometry/at.h"
#include "kernels/instruction_set.h"
#include "sparse/without_denormals.h"

namespace cloth {
namespace {

constexpr int most_right = 2;

std::size_t in_registers(std::size_t count) {
  constexpr std::size_t lanes = BlockLevel::lanes;
  return (count + lanes - 1) / lanes * lanes;
}

std::size_t size_of(const NaturalBlocks& blocks) {
  return static_cast<std::size_t>(blocks.rows) * static_cast<std::size_t>(blocks.columns);
}

int coupling_of(int down, int right) {
  for (int k = 0; k < block_couplings; ++k)
    if (block_coupling[k].down == down && block_coupling[k].right == right) return 1 + k;
  return 0;
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

void BlockMultigrid::begin(int rows, int columns) {
  kernels_ = &active_kernels<BlockCycleKernels>();
  fixed_.clear();
  if (rows != rows_ || columns != columns_) {
    rows_ = rows, columns_ = columns;
    levels_.clear();
    for (;;) {
      add_level(rows, columns);
      if (rows <= fewest && columns <= fewest) break;
      if (rows > fewest) rows = (rows + 1) / 2;
      if (columns > fewest) columns = (columns + 1) / 2;
    }
  }
  Level& finest = levels_.front();
  std::fill(finest.natural_numbers.begin(), finest.natural_numbers.end(), 0.0f);
  std::fill(std::begin(finest.natural.used), std::end(finest.natural.used), false);
  finest.natural.used[0] = true;
}

void BlockMultigrid::add_level(int rows, int columns) {
  Level& level = levels_.emplace_back();
  level.natural.rows = level.loops.rows = rows;
  level.natural.columns = level.loops.columns = columns;
  level.natural_numbers.assign(6 * (1 + block_couplings) * size_of(level.natural), 0.0f);
  level.natural.numbers = level.natural_numbers.data();
  std::fill(std::begin(level.natural.used), std::end(level.natural.used), true);

  // Behind each segment lies a zero for a neighbour beyond the border, before the first and behind the last
  // a whole register. An odd number of cache lines, so that rows do not meet in the same set of the cache.
  constexpr std::size_t lanes = BlockLevel::lanes;
  const std::size_t segment = in_registers((static_cast<std::size_t>(columns) + 2) / 3 + 1);
  std::size_t width = 3 * segment + 2 * lanes;
  if (width / lanes % 2 == 0) width += lanes;
  level.loops.segment = static_cast<std::ptrdiff_t>(segment);
  level.loops.width = static_cast<std::ptrdiff_t>(width);
  for (std::size_t c = 0; c < static_cast<std::size_t>(columns); ++c)
    level.place.push_back(static_cast<int>(c % 3 * segment + c / 3));

  const std::size_t field = (static_cast<std::size_t>(rows) + 2 * most_right) * 3 * width;
  level.origin = most_right * 3 * width + lanes;
  level.vectors.assign(3 * field + lanes, 0.0f);
  level.loops.x = level.vectors.data() + level.origin;
  level.loops.b = level.loops.x + field;
  level.loops.r = level.loops.b + field;
  level.inverse.assign(static_cast<std::size_t>(rows) * 6 * width + lanes, 0.0f);
  level.loops.inverse = level.inverse.data() + lanes;
}

void BlockMultigrid::add_to_diagonal(std::size_t first, std::size_t count,
                                     const std::array<const double*, 6>& blocks) {
  const NaturalBlocks& natural = levels_.front().natural;
  for (std::size_t n = 0; n < 6; ++n) {
    float* to = natural.numbers + n * size_of(natural) + first;
    for (std::size_t k = 0; k < count; ++k) to[k] += static_cast<float>(blocks[n][k]);
  }
}

bool BlockMultigrid::add_couplings(std::size_t first, std::size_t count, int offset, double scale,
                                   const std::array<const double*, 6>& blocks) {
  NaturalBlocks& natural = levels_.front().natural;
  const int column = static_cast<int>(first) % columns_, end = static_cast<int>(first) + offset;
  const int down = end / columns_ - static_cast<int>(first) / columns_, right = end % columns_ - column;
  const int coupling = coupling_of(down, right);
  if (coupling == 0) return false;
  natural.used[coupling] = true;
  for (std::size_t n = 0; n < 6; ++n) {
    float* to = natural.numbers + (6 * at(coupling) + n) * size_of(natural) + first;
    for (std::size_t k = 0; k < count; ++k) to[k] += static_cast<float>(scale * blocks[n][k]);
  }
  return true;
}

void BlockMultigrid::fix(std::size_t particle) {
  const NaturalBlocks& natural = levels_.front().natural;
  const int row = static_cast<int>(particle) / columns_, column = static_cast<int>(particle) % columns_;
  const std::size_t size = size_of(natural);
  const auto clear = [&](int coupling, std::size_t of) {
    for (std::size_t n = 0; n < 6; ++n) natural.numbers[(6 * at(coupling) + n) * size + of] = 0;
  };
  clear(0, particle);
  for (int k = 0; k < block_couplings; ++k) {
    clear(1 + k, particle);
    const int r = row - block_coupling[k].down, c = column - block_coupling[k].right;
    if (r >= 0 && c >= 0 && c < columns_) clear(1 + k, at(r * columns_ + c));
  }
  fixed_.push_back(particle);
}

/// Where the neighbours of a colour lie, and where the blocks of their couplings: those to later particles
/// with the particle itself, the others with the neighbour.
void BlockMultigrid::set_neighbours(Level& level) {
  BlockLevel& l = level.loops;
  std::vector<int> kept;
  for (int k = 0; k < block_couplings; ++k)
    if (level.natural.used[1 + k]) kept.push_back(k);
  l.couplings = static_cast<int>(kept.size());
  const std::ptrdiff_t row_of_blocks = 6 * l.couplings * l.width;
  for (int c = 0; c < 3; ++c) {
    std::vector<BlockNeighbour> earlier, later;
    for (std::size_t n = 0; n < kept.size(); ++n)
      for (const int sign : {1, -1}) {
        const BlockCoupling& coupling = block_coupling[kept[n]];
        const int down = sign * coupling.down, column = c + sign * coupling.right;
        const int beside = column < 0 ? -1 : column / 3, colour = column - 3 * beside;
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
  const auto width = static_cast<std::size_t>(l.width);
  const std::size_t row_of_blocks = 6 * at(l.couplings) * width;
  const std::size_t before = most_right * row_of_blocks + BlockLevel::lanes;
  const std::size_t wanted = before + (rows + most_right) * row_of_blocks + BlockLevel::lanes;
  if (level.blocks.size() != wanted) level.blocks.assign(wanted, 0.0f);
  float* blocks = level.blocks.data() + before;
  l.blocks = blocks;
  float* inverse = level.inverse.data() + BlockLevel::lanes;
  std::size_t kept = 0;
  for (std::size_t k = 0; k < block_couplings; ++k) {
    if (!level.natural.used[1 + k]) continue;
    for (std::size_t n = 0; n < 6; ++n)
      for (std::size_t r = 0; r < rows; ++r) {
        const float* from = level.natural.numbers + (6 * (1 + k) + n) * size + r * columns;
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
  for (std::size_t n = 0; n + 1 < levels_.size(); ++n) {
    Level &fine = levels_[n], &coarse = levels_[n + 1];
    const std::size_t room = 6 * 15 * at(fine.natural.rows) * at(coarse.natural.columns);
    if (between_.size() < room) between_.resize(room);
    kernels_->coarsen(fine.natural, coarse.natural, between_.data());
    arrange(fine);
  }
  row_.resize(static_cast<std::size_t>(levels_.front().loops.width));
  return invert_coarsest();
}

bool BlockMultigrid::invert_coarsest() {
  const Level& level = levels_.back();
  const int rows = level.natural.rows, columns = level.natural.columns;
  const std::size_t size = size_of(level.natural);
  const Eigen::Index numbers = 3 * static_cast<Eigen::Index>(size);
  constexpr int symmetric[3][3] = {{0, 1, 2}, {1, 3, 4}, {2, 4, 5}};
  Eigen::MatrixXd dense = Eigen::MatrixXd::Zero(numbers, numbers);
  for (int k = 0; k <= block_couplings; ++k) {
    const BlockCoupling coupling = k == 0 ? BlockCoupling{} : block_coupling[k - 1];
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
  const Eigen::LLT<Eigen::MatrixXd> factors(dense);
  if (factors.info() != Eigen::Success) return false;
  const Eigen::MatrixXd inverse = factors.solve(Eigen::MatrixXd::Identity(numbers, numbers));
  if (!inverse.allFinite()) return false;
  coarsest_.assign(inverse.data(), inverse.data() + inverse.size());
  return true;
}

void BlockMultigrid::solve_coarsest() {
  const Level& level = levels_.back();
  const std::size_t size = size_of(level.natural), columns = at(level.natural.columns);
  const auto width = static_cast<std::size_t>(level.loops.width);
  std::vector<double> b(3 * size);
  const auto number = [&](std::size_t k) {
    const std::size_t i = k / 3;
    return i / columns * 3 * width + k % 3 * width + at(level.place[i % columns]);
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
  const std::ptrdiff_t w = f.width;
  const bool halves_rows = c.rows != f.rows, halves_columns = c.columns != f.columns;
  const float last_row = f.rows % 2 == 0 ? 1.0f : 0.5f, last_column = f.columns % 2 == 0 ? 1.0f : 0.5f;
  float* row = row_.data();
  const int* place = fine.place.data();
  for (int n = 0; n < 3; ++n)
    for (int to = 0; to < c.rows; ++to) {
      const float* middle = f.r + (halves_rows ? 2 * to : to) * 3 * w + n * w;
      for (std::ptrdiff_t k = 0; k < 3 * f.segment; ++k) row[k] = middle[k];
      if (halves_rows) {
        const float weight = to + 1 == c.rows ? last_row : 0.5f;
        const float *above = middle - 3 * w, *below = middle + 3 * w;  // zero outside of the grid
        for (std::ptrdiff_t k = 0; k < 3 * f.segment; ++k) row[k] += 0.5f * above[k] + weight * below[k];
      }
      float* sums = c.b + to * 3 * c.width + n * c.width;
      for (int column = 0; column < c.columns; ++column) {
        float sum = row[place[halves_columns ? 2 * column : column]];
        if (halves_columns && column > 0) sum += 0.5f * row[place[2 * column - 1]];
        if (halves_columns && 2 * column + 1 < f.columns)
          sum += (column + 1 == c.columns ? last_column : 0.5f) * row[place[2 * column + 1]];
        sums[coarse.place[at(column)]] = sum;
      }
    }
}

/// fine.x += P coarse.x; fixed particles of the finest stay zero.
void BlockMultigrid::add_correction(Level& fine, const Level& coarse) {
  const BlockLevel &f = fine.loops, &c = coarse.loops;
  const bool halves_rows = c.rows != f.rows, halves_columns = c.columns != f.columns;
  float* row = row_.data();
  for (int n = 0; n < 3; ++n)
    for (int to = 0; to < f.rows; ++to) {
      const float* from = c.x + (halves_rows ? to / 2 : to) * 3 * c.width + n * c.width;
      const bool between = halves_rows && to % 2 == 1 && to / 2 + 1 < c.rows;
      const float* next = from + (between ? 3 * c.width : 0);
      for (int column = 0; column < c.columns; ++column) {
        const int place = coarse.place[at(column)];
        row[column] = 0.5f * (from[place] + next[place]);
      }
      float* sums = f.x + to * 3 * f.width + n * f.width;
      for (int column = 0; column < f.columns; ++column) {
        const int own = halves_columns ? column / 2 : column;
        const bool is_between = halves_columns && column % 2 == 1 && own + 1 < c.columns;
        sums[fine.place[at(column)]] += is_between ? 0.5f * (row[own] + row[own + 1]) : row[own];
      }
    }
  if (&fine != &levels_.front()) return;
  for (const std::size_t particle : fixed_) {
    const std::size_t r = particle / at(columns_), place = at(fine.place[particle % at(columns_)]);
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
  const int* place = finest.place.data();
  const auto row_at = [&](int n, int r) { return (3 * r + n) * l.width; };
  for (int n = 0; n < 3; ++n)
    for (int r = 0; r < rows_; ++r) {
      const double* from = given[n] + r * columns_;
      float* to = l.b + row_at(n, r);
      for (int c = 0; c < columns_; ++c) to[place[c]] = static_cast<float>(from[c]);
    }
  cycle(0);
  for (int n = 0; n < 3; ++n)
    for (int r = 0; r < rows_; ++r) {
      const float* from = l.x + row_at(n, r);
      double* to = wanted[n] + r * columns_;
      for (int c = 0; c < columns_; ++c) to[c] = from[place[c]];
    }
}

std::size_t BlockMultigrid::memory() const {
  std::size_t floats = between_.size();
  for (const Level& level : levels_)
    floats +=
        level.natural_numbers.size() + level.blocks.size() + level.inverse.size() + level.vectors.size();
  return floats * sizeof(float) + coarsest_.size() * sizeof(double);
}

}  // namespace cloth

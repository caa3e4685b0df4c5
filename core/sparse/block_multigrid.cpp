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

constexpr std::size_t lanes = BlockLevel::lanes;

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

void enlarge(AlignedFloats& scratch, std::size_t size) {
  if (scratch.size() < size) scratch.resize(size);
}

std::size_t place_in_row(const BlockLevel& l, std::size_t column) {
  return column % at(l.groups) * at(BlockLevel::vector_group) + column / at(l.groups);
}

/// The inverses of a group's diagonal, zero where a lane has no particle.
void write_inverses(const BlockLevel& l, const NaturalBlocks& natural, int row, int group, float* to) {
  const float* from = natural.blocks_of(0) + row * l.columns;
  std::fill_n(to, BlockLevel::block, 0.0f);
  int column = group;
  for (int lane = 0; lane < BlockLevel::lanes && column < l.columns; ++lane, column += l.groups)
    invert_block(from + column, size_of(natural), to + lane, lanes);
}

/// A group's couplings with what lies `coupling` away; zero where the grid ends.
void write_couplings(const BlockLevel& l, const NaturalBlocks& natural, int row, int group,
                     BlockCoupling coupling, float* to) {
  const bool is_kept_there = coupling.down < 0 || coupling.right < 0;
  const int row_kept = is_kept_there ? row + coupling.down : row;
  if (row_kept < 0) {
    std::fill_n(to, BlockLevel::block, 0.0f);
    return;
  }
  const BlockCoupling kept = is_kept_there ? BlockCoupling{-coupling.down, -coupling.right} : coupling;
  const std::ptrdiff_t size = natural.particles(), shift = is_kept_there ? coupling.right : 0;
  const float* from = natural.blocks_of(natural.number_of(kept)) + row_kept * l.columns;
  for (int n = 0; n < 6; ++n, from += size, to += BlockLevel::lanes)
    for (int lane = 0; lane < BlockLevel::lanes; ++lane) {
      const int column = group + lane * l.groups, end = column + coupling.right;
      const bool is_there = column < l.columns && end >= 0 && end < l.columns;
      to[lane] = is_there ? from[column + shift] : 0.0f;
    }
}

}  // namespace

void BlockMultigrid::begin(int rows, int columns, Interpolation interpolation) {
  kernels_ = &active_kernels<BlockCycleKernels>();
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

  BlockLevel& l = level.loops;
  l.reach = reach;
  l.groups = std::max((columns + BlockLevel::lanes - 1) / BlockLevel::lanes, reach + 1);
  l.vector_row = (l.groups + 2 * reach) * BlockLevel::vector_group;
  const std::size_t row = at(l.vector_row), field = at(rows + reach) * row;
  level.vectors.assign(3 * field, 0.0f);
  l.x = level.vectors.data() + at(reach) * (row + at(BlockLevel::vector_group));
  l.b = l.x + field;
  l.r = l.b + field;
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
}

/// The couplings of each kind of group: with what is solved before, in the rows above or in the same row.
/// What lies before a row's first group, in the lane before, is solved later, and has the coupling.
void BlockMultigrid::set_couplings(Level& level) {
  BlockLevel& l = level.loops;
  const NaturalBlocks& natural = level.natural;
  std::ptrdiff_t place = 0;
  for (int group = 0; group < l.groups; ++group) {
    std::vector<BlockCoupling>& couplings = level.couplings[l.kind_of(group)];
    couplings.clear();
    for (int k = 1; k <= natural.couplings(); ++k) {
      if (!natural.used[k]) continue;
      const BlockCoupling coupling = natural.coupling(k);
      if (coupling.down > 0 || group >= coupling.right)
        couplings.push_back({-coupling.down, -coupling.right});
      if (coupling.down == 0 && group + coupling.right >= l.groups) couplings.push_back(coupling);
    }
    BlockLevel::Kind& kind = l.kind[l.kind_of(group)];
    if (group <= l.reach || group >= l.groups - l.reach) kind.first = place;
    kind.couplings = static_cast<int>(couplings.size());
    std::ranges::transform(couplings, kind.neighbour, [&](const BlockCoupling& c) {
      return c.down * l.vector_row + c.right * BlockLevel::vector_group;
    });
    place += (1 + kind.couplings) * BlockLevel::block;
  }
  l.block_row = place;
}

/// From the order of particles into groups.
void BlockMultigrid::arrange(Level& level) {
  set_couplings(level);
  BlockLevel& l = level.loops;
  const NaturalBlocks& natural = level.natural;
  const std::size_t wanted = at(l.rows) * at(l.block_row);
  if (level.blocks.size() != wanted) level.blocks.assign(wanted, 0.0f);
  l.blocks = level.blocks.data();
  float* to = level.blocks.data();
  for (int row = 0; row < l.rows; ++row)
    for (int group = 0; group < l.groups; ++group) {
      write_inverses(l, natural, row, group, to);
      to += BlockLevel::block;
      for (const BlockCoupling& coupling : level.couplings[l.kind_of(group)]) {
        write_couplings(l, natural, row, group, coupling, to);
        to += BlockLevel::block;
      }
    }
}

bool BlockMultigrid::prepare() {
  const BlockCoarsenKernels& kernels = active_kernels<BlockCoarsenKernels>();
  for (std::size_t n = 0; n + 1 < levels_.size(); ++n) {
    Level &fine = levels_[n], &coarse = levels_[n + 1];
    enlarge(coarsening_scratch_, BlockCoarsenKernels::scratch(fine.natural, coarse.natural));
    enlarge(transfer_scratch_, BlockTransfer::scratch_size(fine.loops, coarse.loops));
    kernels.coarsen(fine.natural, fine.row_interpolation.line(), fine.column_interpolation.line(),
                    coarse.natural, coarsening_scratch_.data());
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
  const BlockLevel& l = level.loops;
  const std::size_t size = size_of(level.natural), columns = at(l.columns);
  std::vector<double> b(3 * size), x(b.size());
  const auto number = [&](std::size_t k) {
    const std::size_t i = k / 3;
    return i / columns * at(l.vector_row) + place_in_row(l, i % columns) + k % 3 * lanes;
  };
  for (std::size_t k = 0; k < b.size(); ++k) b[k] = l.b[number(k)];
  for (std::size_t j = 0; j < b.size(); ++j)
    for (std::size_t k = 0; k < b.size(); ++k) x[k] += coarsest_[j * b.size() + k] * b[j];
  for (std::size_t k = 0; k < b.size(); ++k) l.x[number(k)] = static_cast<float>(x[k]);
}

void BlockMultigrid::cycle(std::size_t number) {
  if (number + 1 == levels_.size()) return solve_coarsest();
  Level &level = levels_[number], &coarse = levels_[number + 1];
  const BlockTransfer transfer{level.row_interpolation.line(), level.column_interpolation.line(),
                               transfer_scratch_.data()};
  kernels_->descend(level.loops);
  kernels_->restrict_residual(level.loops, coarse.loops, transfer);
  cycle(number + 1);
  kernels_->add_correction(level.loops, coarse.loops, transfer);
  kernels_->ascend(level.loops);
}

void BlockMultigrid::solve(const Vec3Field& residual, Vec3Field& correction) {
  const WithoutDenormals scope;
  Level& finest = levels_.front();
  const BlockLevel& l = finest.loops;
  const double* given[3] = {residual.x(), residual.y(), residual.z()};
  double* wanted[3] = {correction.x(), correction.y(), correction.z()};
  const BlockField field{is_turned_ ? 1 : columns_, is_turned_ ? columns_ : 1};
  kernels_->set_right_side(l, field, given);
  cycle(0);
  kernels_->get_solution(l, field, wanted);
}

std::size_t BlockMultigrid::memory() const {
  std::size_t floats = coarsening_scratch_.size();
  for (const Level& level : levels_)
    floats += level.natural_numbers.size() + level.blocks.size() + level.vectors.size();
  return floats * sizeof(float) + coarsest_.size() * sizeof(double);
}

}  // namespace cloth

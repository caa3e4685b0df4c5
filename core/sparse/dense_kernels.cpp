#include "sparse/dense_kernels.h"

#include "kernels/kernel_loops.h"

namespace cloth {
namespace {

/// `lanes` neighbouring rows of a column.
template <int lanes>
struct Pack {
  typedef double Vector
      __attribute__((vector_size(lanes * sizeof(double)), aligned(sizeof(double)), may_alias));
};

constexpr int tile_columns = 6;  // 12 sums, 2 packs of rows and a factor: the 16 registers of SSE2 and AVX2

/// c(0..rows, 0..columns) -= a(0..rows, :) b(0..columns, :)^T with rows = packs * lanes: the sums stay in
/// registers.
template <int lanes, int packs, int columns>
CLOTHLAB_INLINE void subtract_tile(double* c, std::size_t c_stride, const double* a, const double* b,
                                   std::size_t stride, int depth) {
  using Vector = typename Pack<lanes>::Vector;
  Vector sum[columns][packs] = {};
  for (int p = 0; p < depth; ++p, a += stride, b += stride) {
    Vector of_a[packs];
    for (int k = 0; k < packs; ++k) of_a[k] = *reinterpret_cast<const Vector*>(a + k * lanes);
    for (int j = 0; j < columns; ++j)
      for (int k = 0; k < packs; ++k) sum[j][k] += of_a[k] * b[j];
  }
  for (int j = 0; j < columns; ++j)
    for (int k = 0; k < packs; ++k) *reinterpret_cast<Vector*>(c + j * c_stride + k * lanes) -= sum[j][k];
}

template <int lanes, int columns>
CLOTHLAB_INLINE void subtract_strip(double* c, std::size_t c_stride, const double* a, const double* b,
                                    std::size_t stride, int rows, int depth) {
  int i = 0;
  for (; i + 2 * lanes <= rows; i += 2 * lanes)
    subtract_tile<lanes, 2, columns>(c + i, c_stride, a + i, b, stride, depth);
  if (i + lanes <= rows) {
    subtract_tile<lanes, 1, columns>(c + i, c_stride, a + i, b, stride, depth);
    i += lanes;
  }
  if constexpr (lanes > 2)
    for (; i + 2 <= rows; i += 2) subtract_tile<2, 1, columns>(c + i, c_stride, a + i, b, stride, depth);
  for (; i < rows; ++i) subtract_tile<1, 1, columns>(c + i, c_stride, a + i, b, stride, depth);
}

template <int lanes>
CLOTHLAB_INLINE void subtract_product(double* c, std::size_t c_stride, const double* a, const double* b,
                                      std::size_t stride, int rows, int columns, int depth) {
  if (columns == tile_columns)
    subtract_strip<lanes, tile_columns>(c, c_stride, a, b, stride, rows, depth);
  else if (columns == 3)
    subtract_strip<lanes, 3>(c, c_stride, a, b, stride, rows, depth);
  else
    for (int j = 0; j < columns; ++j)
      subtract_strip<lanes, 1>(c + j * c_stride, c_stride, a, b + j, stride, rows, depth);
}

bool factorise_columns(DenseBlock block, int height, int width) {
  double* front = block.data;
  const std::size_t stride = block.stride;
  for (int begin = 0; begin < width; begin += tile_columns) {
    const int end = kernels::smaller(begin + tile_columns, width);
    double* strip = front + begin + begin * stride;
    subtract_product<kernels::register_width>(strip, stride, front + begin, front + begin, stride,
                                              height - begin, end - begin, begin);
    for (int j = begin; j < end; ++j) {
      double* column = front + j * stride;
      const double pivot = column[j];
      if (!(pivot > 0)) return false;
      const double root = __builtin_sqrt(pivot);
      const double inverse = 1 / root;
      column[j] = root;
      for (int i = j + 1; i < height; ++i) column[i] *= inverse;
      for (int next = j + 1; next < end; ++next) {
        double* other = front + next * stride;
        const double factor = column[next];
        for (int i = next; i < height; ++i) other[i] -= factor * column[i];
      }
    }
  }
  return true;
}

/// Rows in stretches that stay in the second cache while the columns pass.
void subtract_square(DenseBlock update, DenseBlock a, int size, int width) {
  constexpr int stretch = 96;
  for (int top = 0; top < size; top += stretch) {
    const int bottom = kernels::smaller(top + stretch, size);
    for (int j = 0; j < bottom; j += tile_columns) {
      const int first = kernels::larger(top, j);
      subtract_product<kernels::register_width>(update.data + first + j * update.stride, update.stride,
                                                a.data + first, a.data + j, a.stride, bottom - first,
                                                kernels::smaller(tile_columns, size - j), width);
    }
  }
}

CLOTHLAB_INLINE void add_product(double& to, double factor, double from) {
  to += factor * from;
}
CLOTHLAB_INLINE void add_product(Quad& to, double factor, const Quad& from) {
  for (int n = 0; n < 4; ++n) to.of[n] += factor * from.of[n];
}
CLOTHLAB_INLINE void divide(double& value, double by) {
  value /= by;
}
CLOTHLAB_INLINE void divide(Quad& value, double by) {
  for (int n = 0; n < 4; ++n) value.of[n] /= by;
}

template <class Number>
void eliminate(DenseBlock front, int height, int width, Number* own, Number* below) {
  const int rest = height - width;
  for (int j = 0; j < width; ++j) {
    const double* __restrict column = front.data + static_cast<std::size_t>(j) * front.stride;
    divide(own[j], column[j]);
    const Number value = own[j];
    Number* __restrict later = own;
    for (int i = j + 1; i < width; ++i) add_product(later[i], -column[i], value);
    Number* __restrict to = below;
    for (int i = 0; i < rest; ++i) add_product(to[i], -column[width + i], value);
  }
}

void substitute(DenseBlock front, int height, int width, double* own, const double* below) {
  for (int j = width; j-- > 0;) {
    const double* column = front.data + static_cast<std::size_t>(j) * front.stride;
    const auto later = static_cast<std::size_t>(width - j - 1),
               rest = static_cast<std::size_t>(height - width);
    own[j] -= kernels::dot_product(column + width, below, rest) +
              kernels::dot_product(column + j + 1, own + j + 1, later);
    own[j] /= column[j];
  }
}
void substitute(DenseBlock front, int height, int width, Quad* own, const Quad* below) {
  for (int j = width; j-- > 0;) {
    const double* column = front.data + static_cast<std::size_t>(j) * front.stride;
    Quad sum[4] = {};  // side by side, since a sum waits for the one before
    const auto add = [&](const double* factors, const Quad* from, int count) {
      int i = 0;
      for (; i + 4 <= count; i += 4)
        for (int k = 0; k < 4; ++k) add_product(sum[k], factors[i + k], from[i + k]);
      for (; i < count; ++i) add_product(sum[0], factors[i], from[i]);
    };
    add(column + width, below, height - width);
    add(column + j + 1, own + j + 1, width - j - 1);
    for (int k = 0; k < 4; ++k) add_product(own[j], -1, sum[k]);
    divide(own[j], column[j]);
  }
}

constexpr DenseKernels table{factorise_columns, subtract_square, eliminate<double>,
                             eliminate<Quad>,   substitute,      substitute};

}  // namespace

const DenseKernels& DenseKernels::CLOTHLAB_SET() {
  return table;
}

}  // namespace cloth

#include "limiter/sweep_plan.h"

#include <algorithm>
#include <cassert>
#include <optional>

namespace cloth {
namespace {

/// Which ends may move; none: not a spring of the limiter.
std::optional<FreeEnds> free_ends(const ClothSystem& system, int i, int j) {
  const bool pinned_i = system.pinned[static_cast<std::size_t>(i)] != 0;
  const bool pinned_j = system.pinned[static_cast<std::size_t>(j)] != 0;
  if (pinned_i && pinned_j) return std::nullopt;
  return pinned_i ? FreeEnds::second : pinned_j ? FreeEnds::first : FreeEnds::both;
}

SpringBatch with_rows(SpringBatch batch, int columns) {
  const SpringRow& row = batch.row;
  const int last = row.first + (row.count - 1) * row.stride;
  batch.low = row.first / columns;
  batch.high = (last + row.offset) / columns;
  return batch;
}

void append_pieces(const ClothSystem& system, const SpringRun& run, double rate,
                   std::vector<SpringBatch>& pieces) {
  assert(run.offset != 0);
  const int begin = run.offset > 0 ? run.first : run.first + run.offset;  // the lower particle comes first
  const int offset = run.offset > 0 ? run.offset : -run.offset;
  bool goes_on = false;
  for (int i = begin; i < begin + run.count; ++i) {
    const auto ends = free_ends(system, i, i + offset);
    goes_on = goes_on && ends && i % system.columns != 0 && pieces.back().ends == *ends;
    if (goes_on)
      ++pieces.back().row.count;
    else if (ends)
      pieces.push_back({.row = {.first = i, .count = 1, .stride = 1, .offset = offset},
                        .ends = *ends,
                        .limit = (1 + rate) * run.rest_length,
                        .rest_length = run.rest_length});
    goes_on = ends.has_value();
  }
}

}  // namespace

std::vector<SpringBatch> pieces_of(const ClothSystem& system, const std::vector<SpringRun>& runs,
                                   double rate) {
  std::vector<SpringBatch> pieces;
  for (const SpringRun& run : runs) append_pieces(system, run, rate, pieces);
  for (SpringBatch& piece : pieces) piece = with_rows(piece, system.columns);
  return pieces;
}

std::vector<SpringBatch> batches_of(const std::vector<SpringBatch>& pieces, int columns) {
  std::vector<SpringBatch> batches;
  const auto add = [&](SpringBatch part, int first, int count, int stride) {
    part.row.first = first, part.row.count = count, part.row.stride = stride;
    if (count > 0) batches.push_back(with_rows(part, columns));
  };
  for (const SpringBatch& piece : pieces) {
    const auto [first, count, stride, offset] = piece.row;
    if (offset == 1) {
      add(piece, first, (count + 1) / 2, 2);
      add(piece, first + 1, count / 2, 2);
      continue;
    }
    for (int done = 0; done < count; done += offset)
      add(piece, first + done, std::min(offset, count - done), 1);
  }
  return batches;
}

std::vector<SpringBatch> row_by_row(std::vector<SpringBatch> pieces) {
  std::stable_sort(pieces.begin(), pieces.end(),
                   [](const SpringBatch& a, const SpringBatch& b) { return a.low < b.low; });
  return pieces;
}

}  // namespace cloth

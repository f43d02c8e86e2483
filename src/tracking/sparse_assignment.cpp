#include "lidar_panoptic_clustering/tracking/sparse_assignment.h"

#include "core/make_room.h"

#include <algorithm>

namespace lidar_panoptic_clustering
{
void SparseAssignment::reset(std::size_t columns)
{
  pairs_.clear(), begin_.clear(), alone_.clear();
  makeRoom(potential_, columns), makeRoom(row_of_, columns), makeRoom(reached_in_, columns);
  makeRoom(settled_in_, columns), makeRoom(reached_from_, columns), makeRoom(distance_, columns);
  potential_.assign(columns, 0.0);
  row_of_.assign(columns, kNone);
  reached_in_.assign(columns, 0), settled_in_.assign(columns, 0);
  reached_from_.resize(columns), distance_.resize(columns);
  round_ = 0;
}

void SparseAssignment::addRow(float alone)
{
  begin_.push_back(static_cast<std::uint32_t>(pairs_.size()));
  alone_.push_back(alone);
}

void SparseAssignment::addPair(std::uint32_t column, float cost)
{
  pairs_.push_back({column, cost});
}

const std::vector<std::uint32_t>& SparseAssignment::solve()
{
  const auto rows = static_cast<std::uint32_t>(alone_.size());
  begin_.push_back(static_cast<std::uint32_t>(pairs_.size()));
  makeRoom(column_of_, rows);
  column_of_.assign(rows, kNone);
  for (std::uint32_t row = 0; row < rows; ++row) augment(row, search(row));
  return column_of_;
}

/// Reaches for the row's columns from `offset` on, and for the end at which the row stays alone.
void SparseAssignment::relax(std::uint32_t row, double offset, Path& best)
{
  if (offset + alone_[row] < best.length) best = {offset + alone_[row], kNone, row};
  for (std::uint32_t i = begin_[row]; i < begin_[row + 1]; ++i)
  {
    const std::uint32_t column = pairs_[i].column;
    const double distance = offset + pairs_[i].cost - potential_[column];
    if (settled_in_[column] == round_ || distance >= best.length) continue;
    if (reached_in_[column] == round_ && distance >= distance_[column]) continue;
    reached_in_[column] = round_;
    distance_[column] = distance;
    reached_from_[column] = row;
    open_.push_back({distance, column});
    std::push_heap(open_.begin(), open_.end());
  }
}

/// The cheapest way to take in `row`: to a column that is free, or to a row that gives its column away.
SparseAssignment::Path SparseAssignment::search(std::uint32_t row)
{
  ++round_;
  open_.clear(), settled_.clear();
  Path best{alone_[row], kNone, row};
  relax(row, 0.0, best);
  while (!open_.empty() && open_.front().distance < best.length)
  {
    const Open next = open_.front();
    std::pop_heap(open_.begin(), open_.end());
    open_.pop_back();
    if (settled_in_[next.column] == round_) continue;
    settled_in_[next.column] = round_;
    if (row_of_[next.column] == kNone) return {next.distance, next.column, kNone};
    settled_.push_back(next.column);
    // pairs that are taken have no reduced cost: the distance to the row is the one to its column
    const std::uint32_t owner = row_of_[next.column];
    double taken = 0.0;
    for (std::uint32_t i = begin_[owner]; i < begin_[owner + 1]; ++i)
      if (pairs_[i].column == next.column) taken = pairs_[i].cost;
    relax(owner, next.distance - (taken - potential_[next.column]), best);
  }
  return best;
}

void SparseAssignment::augment(std::uint32_t row, const Path& path)
{
  for (const std::uint32_t column : settled_) potential_[column] += distance_[column] - path.length;
  std::uint32_t column = path.column;
  if (column == kNone)
  {
    if (path.row == row) return;
    column = column_of_[path.row];
    column_of_[path.row] = kNone;
  }
  while (true)
  {
    const std::uint32_t from = reached_from_[column];
    row_of_[column] = from;
    std::swap(column_of_[from], column);
    if (from == row) return;
  }
}
}  // namespace lidar_panoptic_clustering

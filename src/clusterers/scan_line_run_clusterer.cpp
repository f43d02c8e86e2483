#include "lidar_panoptic_clustering/clusterers/scan_line_run_clusterer.h"

#include "clusterers/scan_line_distance.h"
#include "lidar_panoptic_clustering/core/parameters.h"

#include <algorithm>
#include <cmath>

namespace lidar_panoptic_clustering
{
namespace
{
/// Squared distance of two intervals' nearest ends, 0 where they overlap.
float squaredGap(float a_min, float a_max, float b_min, float b_max)
{
  const float gap = std::max({0.0F, b_min - a_max, a_min - b_max});
  return gap * gap;
}

/// asin(x) for x in [0, 1], within 1e-7.
float arcSine(float x)
{
  if (x > 0.25F) return std::asin(x);
  const float s = x * x;
  return x * (1.0F + s * (1.0F / 6.0F + s * (3.0F / 40.0F + s * (15.0F / 336.0F + s * (105.0F / 3456.0F)))));
}

/// Columns either side of a point within which another one closer than `distance` can lie.
int windowOf(const ThingPoint& p, float distance, float column_angle, int max_window)
{
  const float range = std::sqrt(p.x * p.x + p.y * p.y);
  const float columns = arcSine(std::min(1.0F, distance / range)) / column_angle;
  return columns < static_cast<float>(max_window) ? static_cast<int>(columns) + 1 : max_window;
}

constexpr std::uint32_t kManyPoints = 256;  // of a line; where their runs are short too, runs save nothing
constexpr std::size_t kBudget = 8;          // comparisons a point of two lines before they are compared point by point
}  // namespace

ScanLineRunClusterer::ScanLineRunClusterer(const ScanLineRunConfig& config) : config_(config)
{
  validateParameters(config);
  run_distance_ = static_cast<float>(config.run_distance_m);
  line_distance_ = static_cast<float>(config.line_distance_m);
}

void ScanLineRunClusterer::cluster(const ThingScan& scan, std::vector<std::uint32_t>& component)
{
  looked_at_ = 0;
  lower_.slot = 0xFFFFFFFF;
  columns_ = scan.columns;
  sortByLink(scan);
  findRuns(scan);
  const auto gap = static_cast<std::uint32_t>(config_.max_line_gap);
  const int turn = scan.full_turn ? static_cast<int>(scan.columns) : 0;
  for (std::uint32_t row = 1; row < scan.rows; ++row)
    for (std::uint32_t upper = row - std::min(row, gap); upper < row; ++upper)
      for (std::uint32_t link = 0; link < scan.link_count; ++link)
        linkLines(upper * scan.link_count + link, row * scan.link_count + link, turn);

  sets_.flatten(representative_);
  component.resize(scan.size());
  for (std::size_t i = 0; i < scan.size(); ++i) component[i] = representative_[run_of_thing_[i]];
}

void ScanLineRunClusterer::sortByLink(const ThingScan& scan)
{
  const std::size_t slots = static_cast<std::size_t>(scan.rows) * scan.link_count;
  slot_begin_.assign(slots + 1, 0);
  for (std::uint32_t row = 0; row < scan.rows; ++row)
    for (std::uint32_t i = scan.line_begin[row]; i < scan.line_begin[row + 1]; ++i)
      ++slot_begin_[row * scan.link_count + scan.link[i] + 1];
  for (std::size_t slot = 0; slot < slots; ++slot) slot_begin_[slot + 1] += slot_begin_[slot];

  points_.resize(scan.size());
  for (std::uint32_t row = 0; row < scan.rows; ++row)
    for (std::uint32_t i = scan.line_begin[row]; i < scan.line_begin[row + 1]; ++i)
    {
      const ThingPoint& p = scan.points[i];
      points_[slot_begin_[row * scan.link_count + scan.link[i]]++] = {
          p.x,
          p.y,
          p.z,
          static_cast<int>(p.column),
          windowOf(p, line_distance_, scan.column_angle, config_.max_window_px),
          i,
          scan.class_link_distance[scan.class_index[i]]};
    }
  // filling moved every beginning to the next slot's
  for (std::size_t slot = slots; slot > 0; --slot) slot_begin_[slot] = slot_begin_[slot - 1];
  slot_begin_[0] = 0;
}

void ScanLineRunClusterer::findRuns(const ThingScan& scan)
{
  const std::size_t slots = slot_begin_.size() - 1;
  runs_.clear();
  slot_run_.resize(slots + 1);
  run_of_thing_.resize(scan.size());
  for (std::size_t slot = 0; slot < slots; ++slot)
  {
    slot_run_[slot] = static_cast<std::uint32_t>(runs_.size());
    for (std::uint32_t i = slot_begin_[slot]; i < slot_begin_[slot + 1]; ++i)
    {
      const Point& p = points_[i];
      if (i == slot_begin_[slot] || !areClose(p, points_[i - 1], run_distance_))
        runs_.push_back({i, i, p.column, p.column, 0, {p.x, p.y, p.z}, {p.x, p.y, p.z}});
      Run& run = runs_.back();
      run.end = i + 1;
      run.last_column = p.column;
      run.window = std::max(run.window, p.window);
      run.min[0] = std::min(run.min[0], p.x), run.max[0] = std::max(run.max[0], p.x);
      run.min[1] = std::min(run.min[1], p.y), run.max[1] = std::max(run.max[1], p.y);
      run.min[2] = std::min(run.min[2], p.z), run.max[2] = std::max(run.max[2], p.z);
      run_of_thing_[p.thing] = static_cast<std::uint32_t>(runs_.size() - 1);
    }
  }
  slot_run_[slots] = static_cast<std::uint32_t>(runs_.size());

  sets_.reset(runs_.size());
  if (scan.full_turn) joinOverTheWrap();
}

void ScanLineRunClusterer::joinOverTheWrap()
{
  for (std::size_t slot = 0; slot + 1 < slot_run_.size(); ++slot)
  {
    if (slot_run_[slot] == slot_run_[slot + 1]) continue;
    const std::uint32_t first = slot_run_[slot], last = slot_run_[slot + 1] - 1;
    const Point &next = points_[runs_[first].begin], &previous = points_[runs_[last].end - 1];
    if (areClose(previous, next, run_distance_)) sets_.unite(first, last);
  }
}

void ScanLineRunClusterer::linkLines(std::uint32_t upper_slot, std::uint32_t lower_slot, int turn)
{
  if (slot_run_[upper_slot] == slot_run_[upper_slot + 1] || slot_run_[lower_slot] == slot_run_[lower_slot + 1]) return;
  const auto areShort = [this](std::uint32_t slot)
  { return 2 * (slot_run_[slot + 1] - slot_run_[slot]) > slot_begin_[slot + 1] - slot_begin_[slot]; };
  const bool is_dense = slot_begin_[lower_slot + 1] - slot_begin_[lower_slot] > kManyPoints;
  if ((is_dense && areShort(upper_slot) && areShort(lower_slot)) || !linkRuns(upper_slot, lower_slot, turn))
    linkPoints(upper_slot, lower_slot, turn);
}

/// Run by run; false when that took more comparisons than is usual and was not ended.
bool ScanLineRunClusterer::linkRuns(std::uint32_t upper_slot, std::uint32_t lower_slot, int turn)
{
  const auto pointsOf = [this](std::uint32_t slot) { return slot_begin_[slot + 1] - slot_begin_[slot]; };
  const std::size_t budget = looked_at_ + kBudget * (pointsOf(upper_slot) + pointsOf(lower_slot));
  const auto begin = runs_.begin() + slot_run_[lower_slot], end = runs_.begin() + slot_run_[lower_slot + 1];
  for (std::uint32_t upper = slot_run_[upper_slot]; upper < slot_run_[upper_slot + 1]; ++upper)
  {
    const Run& run = runs_[upper];
    // the lower line as it is, and where the window crosses the wrap, a turn to the left or to the right
    for (int shift = run.first_column < run.window ? -turn : 0; shift <= turn; shift += std::max(1, turn))
    {
      const int from = run.first_column - run.window - shift, to = run.last_column + run.window - shift;
      if (to < 0) break;
      auto lower = std::lower_bound(begin, end, from, [](const Run& r, int column) { return r.last_column < column; });
      for (; lower != end && lower->first_column <= to; ++lower)
      {
        const auto other = static_cast<std::uint32_t>(lower - runs_.begin());
        if (++looked_at_ > budget) return false;
        if (sets_.find(upper) != sets_.find(other) && anyPairClose(run, *lower, shift)) sets_.unite(upper, other);
      }
    }
  }
  return true;
}

bool ScanLineRunClusterer::anyPairClose(const Run& upper, const Run& lower, int shift)
{
  float squared_gap = 0.0F;
  for (int axis = 0; axis < 3; ++axis)
    squared_gap += squaredGap(upper.min[axis], upper.max[axis], lower.min[axis], lower.max[axis]);
  if (!(squared_gap < line_distance_ * line_distance_)) return false;

  std::uint32_t right = lower.begin;  // the first point of the lower run at or right of the upper point's column
  for (std::uint32_t i = upper.begin; i < upper.end; ++i)
  {
    const Point& p = points_[i];
    while (right < lower.end && points_[right].column + shift < p.column) ++right;
    const float distance = std::min(line_distance_, p.link_distance);
    if (!(squaredGap(p.x, p.x, lower.min[0], lower.max[0]) + squaredGap(p.y, p.y, lower.min[1], lower.max[1]) +
              squaredGap(p.z, p.z, lower.min[2], lower.max[2]) <
          distance * distance))
      continue;

    const auto close = [&](const Point& q)
    {
      ++looked_at_;
      return std::abs(q.column + shift - p.column) <= q.window && areClose(p, q, line_distance_);
    };
    for (std::uint32_t j = right; j < lower.end && points_[j].column + shift - p.column <= p.window; ++j)
      if (close(points_[j])) return true;
    for (std::uint32_t j = right; j > lower.begin && p.column - points_[j - 1].column - shift <= p.window; --j)
      if (close(points_[j - 1])) return true;
  }
  return false;
}
}  // namespace lidar_panoptic_clustering

#pragma once

#include "lidar_panoptic_clustering/core/language.h"

#include <cstdint>
#include <string>
#include <vector>

namespace lidar_panoptic_clustering
{
/// Wall time of one scan, taken in one thread.
struct FrameTime
{
  std::string scan;  ///< "sequence/scan", 08/000123
  std::uint32_t points = 0, thing_points = 0;
  double cluster_ms = 0.0;   ///< the algorithm alone
  double pipeline_ms = 0.0;  ///< from the organised cloud to the painted one
};

struct TimeSummary
{
  double median_ms = 0.0, p95_ms = 0.0, max_ms = 0.0;
};

/// Median (the mean of the middle two), 95th percentile (nearest rank) and maximum of a member of FrameTime; zeros
/// without any frame.
TimeSummary summarize(const std::vector<FrameTime>& times, double FrameTime::*member);
}  // namespace lidar_panoptic_clustering

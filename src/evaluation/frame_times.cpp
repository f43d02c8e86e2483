#include "lidar_panoptic_clustering/evaluation/frame_times.h"

#include <algorithm>

namespace lidar_panoptic_clustering
{
TimeSummary summarize(const std::vector<FrameTime>& times, double FrameTime::*member)
{
  if (times.empty()) return {};
  std::vector<double> sorted;
  for (const FrameTime& time : times) sorted.push_back(time.*member);
  std::sort(sorted.begin(), sorted.end());
  const std::size_t n = sorted.size();
  const std::size_t rank95 = (95 * n + 99) / 100;  // the smallest rank with 95 % of the values at or below it
  return {0.5 * (sorted[(n - 1) / 2] + sorted[n / 2]), sorted[rank95 - 1], sorted.back()};
}
}  // namespace lidar_panoptic_clustering

#pragma once

#include "lidar_panoptic_clustering/drawing/scan_figure.h"
#include "lidar_panoptic_clustering/evaluation/object_errors.h"
#include "tools/support/run_benchmark.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

namespace lidar_panoptic_clustering
{
namespace detail
{
constexpr std::uint32_t kSplitColor = 0xFF4040, kMergedColor = 0xFFB000;

/// A ring around the points of a true object.
inline Mark markOf(const TrueObject& object, const BenchmarkScan& scan)
{
  const std::uint32_t label = object.segment.instance << 16U | object.segment.class_id;
  double x = 0.0, y = 0.0, count = 0.0, radius = 0.0;
  for (std::size_t i = 0; i < scan.points.size(); ++i)
    if (scan.truth[i] == label) x += scan.points[i].x, y += scan.points[i].y, count += 1.0;
  x /= count, y /= count;
  for (std::size_t i = 0; i < scan.points.size(); ++i)
    if (scan.truth[i] == label) radius = std::max(radius, std::hypot(scan.points[i].x - x, scan.points[i].y - y));
  Mark mark;
  mark.x = static_cast<float>(x), mark.y = static_cast<float>(y);
  mark.radius_m = std::max(1.0F, static_cast<float>(radius) + 0.5F);
  mark.rgb = object.outcome == ObjectOutcome::kSplit ? kSplitColor : kMergedColor;
  return mark;
}
}  // namespace detail

/// The survey's figure of one scan: a panel a row, from above and as a range image, true objects that were split or
/// merged marked. Throws as BenchmarkScans::read and drawScanFigure do.
inline void drawBenchmarkFigure(const BenchmarkSettings& settings, const BenchmarkScans& scans, std::size_t i,
                                const std::shared_ptr<const ClassTable>& table, const std::string& png_path)
{
  BenchmarkScan scan;
  scans.read(i, scan);
  ScanClusterer clusterer(settings, table);
  clusterer.project(scan);
  SegmentOverlaps overlaps(table);
  ObjectErrors errors;

  std::vector<PanopticCloud> clouds(settings.rows.size());
  std::vector<ScanPanel> panels(settings.rows.size());
  for (std::size_t row = 0; row < settings.rows.size(); ++row)
  {
    std::vector<std::uint32_t> labels;
    FrameTime time;
    clusterer.cluster(row, clouds[row], labels, time);
    overlaps.count(ScanLabels::packed(labels.data()), ScanLabels::packed(scan.truth.data()), labels.size());
    ScanPanel& panel = panels[row];
    ObjectErrorCounts counts;
    for (const TrueObject& object : errors.judge(overlaps))
    {
      counts.add(object.outcome);
      if (object.outcome == ObjectOutcome::kSplit || object.outcome == ObjectOutcome::kMerged)
        panel.marks.push_back(detail::markOf(object, scan));
    }
    panel.title = settings.rows[row].name;
    panel.cloud = &clouds[row];
    panel.caption = std::to_string(counts.total()) + " true objects, " + std::to_string(counts.split) + " split, " +
                    std::to_string(counts.merged) + " merged, " + std::to_string(counts.missed) + " missed";
  }
  ScanFigureOptions options;
  options.title = "Sequence " + scans.sequence(i) + ", scan " + scans.scanName(i);
  options.mark_legend = {{detail::kSplitColor, "true object split"}, {detail::kMergedColor, "true object merged"}};
  drawScanFigure(panels, png_path, options);
}
}  // namespace lidar_panoptic_clustering

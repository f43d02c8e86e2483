#pragma once

#include "lidar_panoptic_clustering/core/color_series.h"
#include "lidar_panoptic_clustering/drawing/scan_figure.h"
#include "lidar_panoptic_clustering/evaluation/object_recall.h"
#include "lidar_panoptic_clustering/scan_to_objects/scan_to_objects.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <string>
#include <unordered_map>
#include <vector>

namespace lidar_panoptic_clustering
{
namespace detail
{
constexpr std::uint32_t kLostColor = 0xFF4040, kMergedObjectColor = 0xFFB000, kPartialColor = 0x40A0FF;

/// A ring around the points that have this true label.
inline Mark markOf(const RecalledObject& object, const std::vector<ScanPoint>& points,
                   const std::vector<std::uint32_t>& truth)
{
  const std::uint32_t label = object.instance << 16U | object.class_id;
  float x = 0.0F, y = 0.0F, radius = 0.0F;
  for (std::size_t i = 0; i < points.size(); ++i)
    if (truth[i] == label) x += points[i].x, y += points[i].y;
  x /= static_cast<float>(object.points), y /= static_cast<float>(object.points);
  for (std::size_t i = 0; i < points.size(); ++i)
    if (truth[i] == label) radius = std::max(radius, std::hypot(points[i].x - x, points[i].y - y));
  Mark mark;
  mark.x = x, mark.y = y, mark.radius_m = std::max(1.0F, radius + 0.5F);
  mark.rgb = object.outcome == RecallOutcome::kLost     ? kLostColor
             : object.outcome == RecallOutcome::kMerged ? kMergedObjectColor
                                                        : kPartialColor;
  return mark;
}

/// The scan's image with the true objects in the place of the found ones; all else is as if it were ground.
inline PanopticCloud truthOf(const PanopticCloud& image, const Projection& projection,
                             const std::vector<std::uint32_t>& truth, const ClassTable& table)
{
  constexpr std::uint32_t kFaint = 0x606060;
  PanopticCloud cloud = image;
  std::unordered_map<std::uint32_t, std::uint32_t> number;
  for (std::size_t pixel = 0; pixel < cloud.size(); ++pixel)
  {
    PanopticPoint& point = cloud.points[pixel];
    point.instance = 0, point.rgb = kFaint;
    const std::uint32_t owner = projection.owner_of_pixel[pixel];
    if (owner == Projection::kNone) continue;
    const std::uint32_t label = truth[owner];
    if (label >> 16U == 0 || table.kindOf(label & 0xFFFFU) != ClassKind::kThing) continue;
    const auto k = number.emplace(label, static_cast<std::uint32_t>(number.size() + 1)).first->second;
    point.instance = k, point.rgb = seriesColor(k);
  }
  return cloud;
}
}  // namespace detail

/// A scan's true objects beside those found without labels, from above and as range images; true objects that were
/// lost, merged, or found in part are ringed in both. `recall`: that the scan was added to last. `truth`: by point.
/// Throws as drawScanFigure does.
inline void drawRecallFigure(const std::string& title, const ScanToObjects& chain, const ObjectRecall& recall,
                             const std::vector<std::uint32_t>& truth, const ClassTable& table,
                             const std::string& png_path)
{
  const PanopticCloud true_cloud = detail::truthOf(chain.image(), chain.scan().image, truth, table);
  ScanPanel true_panel, found_panel;
  true_panel.title = "true objects", found_panel.title = "found without labels";
  true_panel.cloud = &true_cloud, found_panel.cloud = &chain.image();
  std::size_t lost = 0, merged = 0, partial = 0;
  for (const RecalledObject& object : recall.objects())
  {
    if (object.outcome == RecallOutcome::kFound) continue;
    ++(object.outcome == RecallOutcome::kLost ? lost : object.outcome == RecallOutcome::kMerged ? merged : partial);
    true_panel.marks.push_back(detail::markOf(object, chain.scan().points, truth));
  }
  found_panel.marks = true_panel.marks;
  true_panel.caption =
      std::to_string(recall.objects().size()) + " of " + std::to_string(recall.config().min_points) + " points or more";
  found_panel.caption = std::to_string(lost) + " lost, " + std::to_string(merged) + " merged, " +
                        std::to_string(partial) + " split or cut, " +
                        std::to_string(recall.lastFalseSegments().size()) + " false segments";
  ScanFigureOptions options;
  options.title = title;
  options.counts = false;
  options.mark_legend = {{detail::kLostColor, "true object lost"},
                         {detail::kMergedObjectColor, "true object merged"},
                         {detail::kPartialColor, "true object split or cut"}};
  drawScanFigure({true_panel, found_panel}, png_path, options);
}
}  // namespace lidar_panoptic_clustering

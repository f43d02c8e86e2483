#include "lidar_panoptic_clustering/datasets/ground_truth_cloud.h"

#include "lidar_panoptic_clustering/core/color_series.h"
#include "lidar_panoptic_clustering/datasets/semantic_kitti.h"

namespace lidar_panoptic_clustering
{
void paintGroundTruth(const Projection& projection, const std::vector<std::uint32_t>& labels, const ClassTable& table,
                      PanopticCloud& out)
{
  const auto& cloud = projection.cloud;
  out.points.assign(cloud.size(), PanopticPoint());
  out.width = cloud.width, out.height = cloud.height;
  out.is_dense = cloud.is_dense;
  for (std::size_t pixel = 0; pixel < cloud.size(); ++pixel)
  {
    auto& to = out.points[pixel];
    to.getVector4fMap() = cloud.points[pixel].getVector4fMap();
    to.intensity = cloud.points[pixel].intensity;
    const auto owner = projection.owner_of_pixel[pixel];
    if (owner == Projection::kNone) continue;
    to.label = rawClass(labels[owner]);
    const auto& info = table[table.find(to.label)];
    to.rgb = info.rgb;
    to.instance = info.isThing() ? rawInstance(labels[owner]) : 0;
    if (to.instance > 0) to.rgb = seriesColor(to.instance);
  }
}
}  // namespace lidar_panoptic_clustering

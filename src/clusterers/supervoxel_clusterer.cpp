#include "lidar_panoptic_clustering/clusterers/supervoxel_clusterer.h"

#include "lidar_panoptic_clustering/core/parameters.h"

#include <pcl/octree/octree_pointcloud.h>
#include <pcl/segmentation/supervoxel_clustering.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <tuple>

namespace lidar_panoptic_clustering
{
namespace
{
using Cloud = pcl::PointCloud<pcl::PointXYZ>;
constexpr std::uint32_t kNone = VoxelIndex::kNone;

/// The voxel grid pcl::octree::OctreePointCloudAdjacency lays over a cloud: the cloud's bounding box, which the octree
/// widens to a power of two of the resolution about its middle.
class OctreeGrid
{
public:
  OctreeGrid(const Cloud& cloud, float resolution) : resolution_(resolution)
  {
    float low[3], high[3];
    std::fill(low, low + 3, std::numeric_limits<float>::max());
    std::fill(high, high + 3, -std::numeric_limits<float>::max());
    for (const auto& p : cloud.points)
      for (int axis = 0; axis < 3; ++axis)
      {
        low[axis] = std::min(low[axis], p.data[axis]);
        high[axis] = std::max(high[axis], p.data[axis]);
      }
    pcl::octree::OctreePointCloud<pcl::PointXYZ> octree(resolution_);
    octree.defineBoundingBox(low[0], low[1], low[2], high[0], high[1], high[2]);
    double unused_x = 0.0, unused_y = 0.0, unused_z = 0.0;
    octree.getBoundingBox(origin_[0], origin_[1], origin_[2], unused_x, unused_y, unused_z);
  }

  template <class Point>
  VoxelKey keyOf(const Point& p) const
  {
    return {cell(p.x, 0), cell(p.y, 1), cell(p.z, 2)};
  }

private:
  std::int32_t cell(float metres, int axis) const
  {
    return static_cast<std::int32_t>((metres - origin_[axis]) / resolution_);
  }

  double resolution_;
  double origin_[3];
};

/// PCL's octree ends the program where a point is nearer to its border than a double tells apart at the distance from
/// the other one, as 1e-15 m is: what a sensor computes for the sine of a half turn.
float withoutDust(float metres)
{
  constexpr float kDust = 1e-9F;
  return std::abs(metres) < kDust ? 0.0F : metres;
}
}  // namespace

SupervoxelClusterer::SupervoxelClusterer(const SupervoxelConfig& config) : config_(config)
{
  validateParameters(config);
  config_.seed_m = std::max(config.seed_m, config.voxel_m);
}

void SupervoxelClusterer::cluster(const ThingScan& scan, std::vector<std::uint32_t>& component)
{
  component.resize(scan.size());
  groups_.build(scan);
  std::uint32_t objects = 0;
  for (std::size_t group = 0; group < groups_.count(); ++group)
    if (groups_.size(group) > 0) objects = clusterGroup(scan, group, objects, component);
  numberUsed(objects, component);
}

/// PCL keeps supervoxels that lost all their voxels to others: those left are numbered 0, 1, 2 ..
void SupervoxelClusterer::numberUsed(std::uint32_t objects, std::vector<std::uint32_t>& component)
{
  number_of_object_.assign(objects, kNone);
  std::uint32_t used = 0;
  for (std::uint32_t& object : component)
  {
    std::uint32_t& number = number_of_object_[object];
    if (number == kNone) number = used++;
    object = number;
  }
}

std::uint32_t SupervoxelClusterer::clusterGroup(const ThingScan& scan, std::size_t group, std::uint32_t first_object,
                                                std::vector<std::uint32_t>& component)
{
  // PCL's sums and ties depend on the order of its input: a fixed one makes the result independent of the scan's
  things_.clear();
  for (const std::uint32_t* i = groups_.begin(group); i != groups_.end(group); ++i)
    things_.push_back({scan.points[*i].x, scan.points[*i].y, scan.points[*i].z, *i});
  std::sort(things_.begin(), things_.end(),
            [](const Thing& p, const Thing& q) { return std::tie(p.x, p.y, p.z) < std::tie(q.x, q.y, q.z); });
  Cloud::Ptr cloud(new Cloud);
  cloud->points.reserve(things_.size());
  for (const Thing& p : things_) cloud->points.emplace_back(withoutDust(p.x), withoutDust(p.y), withoutDust(p.z));
  cloud->width = static_cast<std::uint32_t>(cloud->points.size());
  cloud->height = 1;

  const auto resolution = static_cast<float>(config_.voxel_m);
  const OctreeGrid grid(*cloud, resolution);
  voxels_.reset();
  voxel_of_point_.resize(things_.size());
  for (std::size_t k = 0; k < things_.size(); ++k) voxel_of_point_[k] = voxels_.insert(grid.keyOf(cloud->points[k]));

  object_of_voxel_.assign(voxels_.size(), kNone);
  std::uint32_t next_object = first_object;
  if (voxels_.size() > 1)  // PCL has crashed on a single voxel
  {
    pcl::SupervoxelClustering<pcl::PointXYZ> supervoxels(resolution, static_cast<float>(config_.seed_m));
    supervoxels.setUseSingleCameraTransform(false);
    supervoxels.setInputCloud(cloud);
    supervoxels.setColorImportance(static_cast<float>(config_.color_weight));
    supervoxels.setSpatialImportance(static_cast<float>(config_.spatial_weight));
    supervoxels.setNormalImportance(static_cast<float>(config_.normal_weight));
    std::map<std::uint32_t, pcl::Supervoxel<pcl::PointXYZ>::Ptr> found;
    supervoxels.extract(found);
    for (const auto& [label, supervoxel] : found)
    {
      for (const auto& centroid : supervoxel->voxels_->points)
      {
        const std::uint32_t voxel = voxels_.find(grid.keyOf(centroid));
        if (voxel != kNone) object_of_voxel_[voxel] = next_object;
      }
      ++next_object;
    }
  }
  next_object = joinLeftOver(next_object);
  for (std::size_t k = 0; k < things_.size(); ++k) component[things_[k].index] = object_of_voxel_[voxel_of_point_[k]];
  return next_object;
}

std::uint32_t SupervoxelClusterer::joinLeftOver(std::uint32_t next_object)
{
  const auto isLeftOver = [this](std::uint32_t voxel) { return object_of_voxel_[voxel] == kNone; };
  left_over_.reset(voxels_.size());
  for (std::uint32_t voxel = 0; voxel < voxels_.size(); ++voxel)
  {
    if (!isLeftOver(voxel)) continue;
    const VoxelKey key = voxels_[voxel];
    for (int neighbour = 0; neighbour < 13; ++neighbour)  // half of the 26: the relation is symmetric
    {
      const VoxelKey beside{key.x + neighbour % 3 - 1, key.y + neighbour / 3 % 3 - 1, key.z + neighbour / 9 - 1};
      const std::uint32_t other = voxels_.find(beside);
      if (other != kNone && isLeftOver(other)) left_over_.unite(voxel, other);
    }
  }
  object_of_set_.assign(voxels_.size(), kNone);
  for (std::uint32_t voxel = 0; voxel < voxels_.size(); ++voxel)
  {
    if (!isLeftOver(voxel)) continue;
    std::uint32_t& object = object_of_set_[left_over_.find(voxel)];
    if (object == kNone) object = next_object++;
    object_of_voxel_[voxel] = object;
  }
  return next_object;
}
}  // namespace lidar_panoptic_clustering

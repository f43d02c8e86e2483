#include "lidar_panoptic_clustering/clusterers/euclidean_clusterer.h"

#include "clusterers/grid_search.h"
#include "lidar_panoptic_clustering/core/parameters.h"

#include <pcl/segmentation/extract_clusters.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>

namespace lidar_panoptic_clustering
{
using Cloud = pcl::PointCloud<pcl::PointXYZ>;

EuclideanClusterer::EuclideanClusterer(const EuclideanConfig& config) : config_(config)
{
  validateParameters(config);
  requireOffOrDistance("distance_m", config.distance_m, 10.0);
}

Cloud::Ptr EuclideanClusterer::representatives(const ThingScan& scan, std::size_t group)
{
  const auto cell = [this](float metres) { return static_cast<std::int32_t>(std::floor(metres / config_.voxel_m)); };
  Cloud::Ptr cloud(new Cloud);
  voxels_.reset(groups_.size(group));
  for (const std::uint32_t* i = groups_.begin(group); i != groups_.end(group); ++i)
  {
    const ThingPoint& p = scan.points[*i];
    const std::uint32_t voxel = voxels_.insert({cell(p.x), cell(p.y), cell(p.z)});
    voxel_of_thing_[*i] = voxel;
    if (voxel == cloud->points.size()) cloud->points.emplace_back(p.x, p.y, p.z);
    auto& q = cloud->points[voxel];
    if (std::tie(p.x, p.y, p.z) < std::tie(q.x, q.y, q.z)) q.x = p.x, q.y = p.y, q.z = p.z;
  }
  cloud->width = static_cast<std::uint32_t>(cloud->points.size());
  cloud->height = 1;
  return cloud;
}

double EuclideanClusterer::tolerance(const ThingScan& scan, std::size_t group) const
{
  double distance = config_.distance_m > 0.0 ? config_.distance_m : std::numeric_limits<double>::infinity();
  for (const std::uint32_t* i = groups_.begin(group); i != groups_.end(group); ++i)
    distance = std::min<double>(distance, scan.linkDistance(*i, *i));
  return distance;
}

void EuclideanClusterer::cluster(const ThingScan& scan, std::vector<std::uint32_t>& component)
{
  component.resize(scan.size());
  voxel_of_thing_.resize(scan.size());
  groups_.build(scan);
  std::uint32_t objects = 0;
  for (std::size_t group = 0; group < groups_.count(); ++group)
  {
    if (groups_.size(group) == 0) continue;
    const Cloud::Ptr cloud = representatives(scan, group);
    constexpr double kRounding = 1.0001;  // PCL's tolerance is a float: never more than a cell
    const double distance = tolerance(scan, group);
    const pcl::search::Search<pcl::PointXYZ>::Ptr grid(new GridSearch(kRounding * distance, GridSearch::kOnce));
    pcl::EuclideanClusterExtraction<pcl::PointXYZ> extraction;
    extraction.setInputCloud(cloud);
    extraction.setSearchMethod(grid);
    extraction.setClusterTolerance(distance);
    extraction.setMinClusterSize(1);
    extraction.setMaxClusterSize(std::numeric_limits<int>::max());
    std::vector<pcl::PointIndices> clusters;
    extraction.extract(clusters);

    component_of_voxel_.resize(voxels_.size());
    for (const auto& cluster : clusters)
    {
      for (const auto voxel : cluster.indices) component_of_voxel_[static_cast<std::size_t>(voxel)] = objects;
      ++objects;
    }
    for (const std::uint32_t* i = groups_.begin(group); i != groups_.end(group); ++i)
      component[*i] = component_of_voxel_[voxel_of_thing_[*i]];
  }
}
}  // namespace lidar_panoptic_clustering

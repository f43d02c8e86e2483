// PCL called straight, beside the clusterers that call it.
//   euclidean: pcl::EuclideanClusterExtraction on all things, without voxels, class by class with the class's link
//              distance, so that both do the same task
//   supervoxel: pcl::SupervoxelClustering on the whole 64 x 2048 image, in which all but things is masked
#include "measure.h"

#include <pcl/search/kdtree.h>
#include <pcl/segmentation/extract_clusters.h>
#include <pcl/segmentation/supervoxel_clustering.h>

#include <limits>
#include <map>

namespace lidar_panoptic_clustering
{
namespace
{
using Cloud = pcl::PointCloud<pcl::PointXYZ>;

void euclideanStraight(benchmark::State& state, const Scans& scans)
{
  std::vector<ThingScan> things;
  for (const auto& scan : scans) things.push_back(thingsOf(scan));
  measure(state,
          [&](std::size_t i)
          {
            const ThingScan& scan = things[i % things.size()];
            std::map<ClassIndex, Cloud::Ptr> cloud_of_class;
            for (std::size_t k = 0; k < scan.size(); ++k)
            {
              Cloud::Ptr& cloud = cloud_of_class[scan.class_index[k]];
              if (!cloud) cloud.reset(new Cloud);
              cloud->push_back({scan.points[k].x, scan.points[k].y, scan.points[k].z});
            }
            for (const auto& [class_index, cloud] : cloud_of_class)
            {
              pcl::search::KdTree<pcl::PointXYZ>::Ptr tree(new pcl::search::KdTree<pcl::PointXYZ>(false));
              tree->setInputCloud(cloud);
              pcl::EuclideanClusterExtraction<pcl::PointXYZ> extraction;
              extraction.setInputCloud(cloud);
              extraction.setSearchMethod(tree);
              extraction.setClusterTolerance(scan.class_link_distance[class_index]);
              extraction.setMinClusterSize(1);
              extraction.setMaxClusterSize(std::numeric_limits<int>::max());
              std::vector<pcl::PointIndices> clusters;
              extraction.extract(clusters);
              benchmark::DoNotOptimize(clusters.data());
            }
          });
  setThings(state, scans);
}

void supervoxelStraight(benchmark::State& state, const Scans& scans)
{
  constexpr float kNone = std::numeric_limits<float>::quiet_NaN();
  std::vector<Cloud::Ptr> images;
  for (const auto& scan : scans)
  {
    images.emplace_back(new Cloud(scan.width, scan.height, pcl::PointXYZ(kNone, kNone, kNone)));
    images.back()->is_dense = false;
    const ThingScan things = thingsOf(scan);
    for (std::uint32_t row = 0; row < things.rows; ++row)
      for (std::uint32_t k = things.line_begin[row]; k < things.line_begin[row + 1]; ++k)
      {
        const ThingPoint& p = things.points[k];
        images.back()->at(static_cast<int>(p.column), static_cast<int>(row)) = {p.x, p.y, p.z};
      }
  }
  measure(state,
          [&](std::size_t i)
          {
            pcl::SupervoxelClustering<pcl::PointXYZ> supervoxels(0.5F, 8.0F);
            supervoxels.setUseSingleCameraTransform(false);
            supervoxels.setInputCloud(images[i % images.size()]);
            supervoxels.setColorImportance(0.0F);
            supervoxels.setSpatialImportance(1.0F);
            supervoxels.setNormalImportance(0.0F);
            std::map<std::uint32_t, pcl::Supervoxel<pcl::PointXYZ>::Ptr> clusters;
            supervoxels.extract(clusters);
            benchmark::DoNotOptimize(supervoxels.getLabeledCloud()->size());
          });
  setThings(state, scans);
}

void addAll()
{
  for (const std::string name : {"recorded", "street"})
  {
    const auto addRow = [&name](const std::string& row, void (*body)(benchmark::State&, const Scans&))
    { addOn(name + "/" + row, name, body); };
    addRow("euclidean/pcl_straight", euclideanStraight);
    addRow("euclidean/ours", [](benchmark::State& state, const Scans& scans) { cluster(state, scans, "euclidean"); });
    addRow("supervoxel/pcl_straight", supervoxelStraight);
    addRow("supervoxel/ours", [](benchmark::State& state, const Scans& scans) { cluster(state, scans, "supervoxel"); });
  }
}
}  // namespace
}  // namespace lidar_panoptic_clustering

int main(int argc, char** argv)
{
  using namespace lidar_panoptic_clustering;
  return runBenchmarks(argc, argv, addAll);
}

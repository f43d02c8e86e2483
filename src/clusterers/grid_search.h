#pragma once

#include "lidar_panoptic_clustering/geometry/voxel_index.h"

#include <pcl/pcl_base.h>
#include <pcl/point_types.h>
#include <pcl/search/search.h>

#include <cstdint>
#include <utility>
#include <vector>

namespace lidar_panoptic_clustering
{
/// A grid as a search method for PCL: points closer than a radius, in cells of about that size.
///
/// Finds what pcl::search::KdTree finds: squared distances in float are below the radius's square, strictly. Points
/// that are not finite are never found, and nothing is found about them. Results come in no order unless sorting is
/// asked for, as of every pcl::search::Search.
///
/// With kOnce a radius search passes over what an earlier one returned. That is all that
/// pcl::EuclideanClusterExtraction needs: it follows a point up when it is returned first, and skips it ever after.
/// Then all searches together are about linear in the points, however many lie within the radius.
class GridSearch : public pcl::search::Search<pcl::PointXYZ>
{
  using Search = pcl::search::Search<pcl::PointXYZ>;

public:
  using Index = pcl::Indices::value_type;  ///< pcl::index_t, which PCL 1.10 has not
  /// What setInputCloud() returns: nothing, and from PCL 1.15 on whether the cloud can be searched.
  using BoolFromPcl115 = decltype(std::declval<Search&>().setInputCloud(PointCloudConstPtr()));

  /// How often radius searches return a point of the cloud given last.
  enum HandOut
  {
    kAlways,
    kOnce
  };
  /// `cell`: edge of the cells [m], best the radius to be searched. Throws std::invalid_argument unless it is positive.
  explicit GridSearch(double cell, HandOut hand_out = kAlways);

  /// Linear in the points. Coordinates of up to 2^20 cells.
  BoolFromPcl115 setInputCloud(const PointCloudConstPtr& cloud,
                               const IndicesConstPtr& indices = IndicesConstPtr()) override;

  using Search::nearestKSearch;
  using Search::radiusSearch;
  /// Of `max_nn` > 0 the nearest only. Linear in the points of the cells within the radius.
  int radiusSearch(const pcl::PointXYZ& point, double radius, pcl::Indices& k_indices,
                   std::vector<float>& k_sqr_distances, unsigned int max_nn = 0) const override;
  /// Compares with every point: made for completeness, not for speed.
  int nearestKSearch(const pcl::PointXYZ& point, int k, pcl::Indices& k_indices,
                     std::vector<float>& k_sqr_distances) const override;

private:
  static constexpr std::uint32_t kNone = VoxelIndex::kNone;
  static constexpr int kAround = 27;

  struct Entry
  {
    float x, y, z;
    Index index;
  };
  /// Entries [begin, end) that can still be found, and up to 27 cells that hold such ones.
  struct Cell
  {
    std::uint32_t begin, end;
    mutable std::uint8_t around_count = 255;  ///< 255: not looked for yet
  };

  VoxelKey keyOf(const pcl::PointXYZ& point) const;
  void searchCell(std::uint32_t cell, const pcl::PointXYZ& point, float squared_radius, pcl::Indices& indices,
                  std::vector<float>& distances) const;
  void searchAround(std::uint32_t cell, const pcl::PointXYZ& point, float squared_radius, pcl::Indices& indices,
                    std::vector<float>& distances) const;
  void findAround(std::uint32_t cell) const;
  void order(unsigned int most, pcl::Indices& indices, std::vector<float>& distances) const;

  double cells_per_m_;
  HandOut hand_out_;
  VoxelIndex index_;
  // a search that hands out once takes points away: PCL's interface is const
  mutable std::vector<Cell> cells_;
  mutable std::vector<Entry> entries_;         ///< cell by cell
  mutable std::vector<std::uint32_t> around_;  ///< kAround a cell
  std::vector<std::uint32_t> cell_of_point_;
};
}  // namespace lidar_panoptic_clustering

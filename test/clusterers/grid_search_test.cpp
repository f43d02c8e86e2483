// The grid as a search method against PCL's k-d tree.
#include "clusterers/grid_search.h"

#include <gtest/gtest.h>

#include <pcl/search/kdtree.h>
#include <pcl/segmentation/extract_clusters.h>

#include <algorithm>
#include <limits>
#include <map>
#include <random>
#include <set>
#include <stdexcept>

namespace lidar_panoptic_clustering
{
namespace
{
using Cloud = pcl::PointCloud<pcl::PointXYZ>;
constexpr float kNaN = std::numeric_limits<float>::quiet_NaN(), kFar = std::numeric_limits<float>::infinity();

/// Points on a grid of an eighth of a metre, so that many lie at just the same distance, some twice.
Cloud::Ptr randomCloud(unsigned seed, int count, int side)
{
  std::mt19937 random(seed);
  const auto at = [&]
  { return 0.125F * static_cast<float>(static_cast<int>(random() % static_cast<unsigned>(side)) - side / 2); };
  Cloud::Ptr cloud(new Cloud);
  for (int k = 0; k < count; ++k) cloud->push_back({at(), at(), at()});
  return cloud;
}

/// Indices and squared distances, by index.
std::map<int, float> found(const pcl::search::Search<pcl::PointXYZ>& search, const pcl::PointXYZ& point, double radius,
                           unsigned int most = 0)
{
  pcl::Indices indices = {99};  // what was there before is not to stay
  std::vector<float> distances = {99.0F};
  const int count = search.radiusSearch(point, radius, indices, distances, most);
  EXPECT_EQ(static_cast<std::size_t>(count), indices.size());
  EXPECT_EQ(indices.size(), distances.size());
  std::map<int, float> result;
  for (std::size_t k = 0; k < indices.size(); ++k) result[indices[k]] = distances[k];
  EXPECT_EQ(result.size(), indices.size()) << "a point twice";
  return result;
}

TEST(GridSearch, findsWhatTheTreeFinds)
{
  for (unsigned seed = 1; seed <= 8; ++seed)
  {
    const Cloud::Ptr cloud = randomCloud(seed, 400, seed % 2 == 0 ? 12 : 60);
    pcl::search::KdTree<pcl::PointXYZ> tree(false);
    tree.setInputCloud(cloud);
    for (const double cell : {0.5, 1.0})
    {
      GridSearch grid(cell);
      grid.setInputCloud(cloud);
      for (const double radius : {0.01, 0.3, 0.5, 1.0, 1.7, 40.0})
        for (std::size_t k = 0; k < cloud->size(); k += 9)
        {
          ASSERT_EQ(found(grid, (*cloud)[k], radius), found(tree, (*cloud)[k], radius)) << radius;
          const pcl::PointXYZ beside((*cloud)[k].x + 0.31F, (*cloud)[k].y - 3.0F, (*cloud)[k].z);
          ASSERT_EQ(found(grid, beside, radius), found(tree, beside, radius)) << radius;
        }
    }
  }
}

TEST(GridSearch, theRadiusItselfIsOutside)
{
  Cloud::Ptr cloud(new Cloud);
  for (const float x : {0.0F, 0.5F, 0.49999997F, -0.5F, -0.25F}) cloud->push_back({x, 0.0F, 0.0F});
  GridSearch grid(0.5);
  grid.setInputCloud(cloud);
  const std::map<int, float> expected = {{0, 0.0F}, {2, 0.49999997F * 0.49999997F}, {4, 0.0625F}};
  EXPECT_EQ(found(grid, (*cloud)[0], 0.5), expected);
}

TEST(GridSearch, duplicatesAreAllFound)
{
  Cloud::Ptr cloud(new Cloud);
  for (int k = 0; k < 7; ++k) cloud->push_back({1.0F, 2.0F, 3.0F});
  GridSearch grid(0.5);
  grid.setInputCloud(cloud);
  EXPECT_EQ(found(grid, (*cloud)[3], 0.1).size(), 7U);
}

TEST(GridSearch, whatIsNotFiniteIsNeverFoundAndFindsNothing)
{
  Cloud::Ptr cloud(new Cloud);
  cloud->push_back({0.0F, 0.0F, 0.0F});
  cloud->push_back({kNaN, 0.0F, 0.0F});
  cloud->push_back({0.0F, kFar, 0.0F});
  cloud->push_back({0.1F, 0.0F, 0.0F});
  cloud->is_dense = false;
  GridSearch grid(0.5);
  grid.setInputCloud(cloud);
  EXPECT_EQ(found(grid, (*cloud)[0], 0.5).size(), 2U);
  EXPECT_TRUE(found(grid, (*cloud)[1], 0.5).empty());
  EXPECT_TRUE(found(grid, (*cloud)[2], 0.5).empty());
  EXPECT_TRUE(found(grid, (*cloud)[0], 0.0).empty());
  grid.setInputCloud(Cloud::Ptr(new Cloud));
  EXPECT_TRUE(found(grid, (*cloud)[0], 0.5).empty());
}

TEST(GridSearch, onlyTheIndicesGivenAndTheNearestOfThem)
{
  const Cloud::Ptr cloud = randomCloud(3, 300, 20);
  pcl::IndicesPtr indices(new pcl::Indices);
  for (int k = 0; k < 300; k += 3) indices->push_back(k);
  GridSearch grid(0.6);
  grid.setInputCloud(cloud, indices);
  pcl::search::KdTree<pcl::PointXYZ> tree(true);
  tree.setInputCloud(cloud, indices);
  for (std::size_t k = 0; k < cloud->size(); k += 7)
  {
    EXPECT_EQ(found(grid, (*cloud)[k], 0.6), found(tree, (*cloud)[k], 0.6));
    const auto mine = found(grid, (*cloud)[k], 1.5, 5), theirs = found(tree, (*cloud)[k], 1.5, 5);
    std::multiset<float> my_distances, their_distances;  // which of those equally far is nobody's promise
    for (const auto& [index, distance] : mine) my_distances.insert(distance);
    for (const auto& [index, distance] : theirs) their_distances.insert(distance);
    EXPECT_EQ(my_distances, their_distances);
    pcl::Indices nearest, expected;
    std::vector<float> distances, expected_distances;
    grid.nearestKSearch((*cloud)[k], 4, nearest, distances);
    tree.nearestKSearch((*cloud)[k], 4, expected, expected_distances);
    EXPECT_EQ(distances, expected_distances);
  }
}

TEST(GridSearch, sortedWhereAskedFor)
{
  const Cloud::Ptr cloud = randomCloud(4, 300, 20);
  GridSearch grid(0.6);
  grid.setSortedResults(true);
  grid.setInputCloud(cloud);
  pcl::Indices indices;
  std::vector<float> distances;
  grid.radiusSearch((*cloud)[0], 1.2, indices, distances);
  EXPECT_GT(indices.size(), 5U);
  EXPECT_TRUE(std::is_sorted(distances.begin(), distances.end()));
}

TEST(GridSearch, handedOutOnce)
{
  const Cloud::Ptr cloud = randomCloud(5, 500, 16);
  GridSearch all(0.5), once(0.5, GridSearch::kOnce);
  all.setInputCloud(cloud);
  for (int round = 0; round < 2; ++round)  // a cloud given again is whole again
  {
    once.setInputCloud(cloud);
    std::map<int, float> seen;
    for (const auto& point : *cloud)
    {
      std::map<int, float> expected = found(all, point, 0.5);
      for (const auto& [index, distance] : seen) expected.erase(index);
      EXPECT_EQ(found(once, point, 0.5), expected);
      seen.insert(expected.begin(), expected.end());
    }
    EXPECT_EQ(seen.size(), cloud->size());
  }
}

std::vector<pcl::Indices> clustersBy(const pcl::search::Search<pcl::PointXYZ>::Ptr& search, const Cloud::Ptr& cloud,
                                     double tolerance)
{
  pcl::EuclideanClusterExtraction<pcl::PointXYZ> extraction;
  extraction.setInputCloud(cloud);
  extraction.setSearchMethod(search);
  extraction.setClusterTolerance(tolerance);
  std::vector<pcl::PointIndices> clusters;
  extraction.extract(clusters);
  std::vector<pcl::Indices> indices;
  for (const auto& cluster : clusters) indices.push_back(cluster.indices);
  std::sort(indices.begin(), indices.end());
  return indices;
}

TEST(GridSearch, euclideanClustersAreThoseOfTheTree)
{
  for (unsigned seed = 1; seed <= 20; ++seed)
  {
    const Cloud::Ptr cloud = randomCloud(seed, 600, static_cast<int>(20 + 5 * seed));
    for (const double tolerance : {0.13, 0.25, 0.3, 0.8, 2.0})
    {
      const pcl::search::Search<pcl::PointXYZ>::Ptr tree(new pcl::search::KdTree<pcl::PointXYZ>(false));
      const pcl::search::Search<pcl::PointXYZ>::Ptr once(new GridSearch(1.0001 * tolerance, GridSearch::kOnce));
      const pcl::search::Search<pcl::PointXYZ>::Ptr always(new GridSearch(tolerance));
      const auto expected = clustersBy(tree, cloud, tolerance);
      ASSERT_EQ(clustersBy(once, cloud, tolerance), expected) << seed << ", " << tolerance;
      ASSERT_EQ(clustersBy(always, cloud, tolerance), expected) << seed << ", " << tolerance;
    }
  }
}

TEST(GridSearch, aCellWithoutSizeIsRefused)
{
  EXPECT_THROW(GridSearch(0.0), std::invalid_argument);
  EXPECT_THROW(GridSearch(static_cast<double>(kNaN)), std::invalid_argument);
}
}  // namespace
}  // namespace lidar_panoptic_clustering

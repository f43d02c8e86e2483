// Each algorithm against a brute-force reading of its rule, in double, over all pairs of points.
#include "scan_fixture.h"
#include "worst_scans.h"

#include <gtest/gtest.h>

#include <pcl/octree/octree_pointcloud_adjacency.h>
#include <pcl/segmentation/supervoxel_clustering.h>

#include <algorithm>
#include <array>
#include <optional>
#include <tuple>

namespace lidar_panoptic_clustering
{
namespace
{
struct Thing
{
  double x, y, z;
  int row, column;
  ClassIndex link;
};

/// The valid thing points in row-major order.
std::vector<Thing> thingsOf(const LabelledCloud& cloud)
{
  std::vector<Thing> things;
  for (std::size_t i = 0; i < cloud.points.size(); ++i)
  {
    const auto& p = cloud.points[i];
    const ClassIndex link = kittiTable()->find(p.label);
    if (!(*kittiTable())[link].isThing() || !std::isfinite(p.x) || (p.x == 0.0F && p.y == 0.0F && p.z == 0.0F))
      continue;
    things.push_back({p.x, p.y, p.z, static_cast<int>(i / cloud.width), static_cast<int>(i % cloud.width), link});
  }
  return things;
}

double distance(const Thing& a, const Thing& b)
{
  return std::sqrt((a.x - b.x) * (a.x - b.x) + (a.y - b.y) * (a.y - b.y) + (a.z - b.z) * (a.z - b.z));
}

/// A graph by a rule; remembers whether any decision was within float rounding of its threshold.
struct Graph
{
  explicit Graph(std::size_t n) : neighbours(n) {}

  void link(std::size_t i, std::size_t j) { neighbours[i].push_back(j), neighbours[j].push_back(i); }
  bool below(double value, double threshold)
  {
    if (std::abs(value - threshold) < 1e-5 * threshold) doubtful = true;
    return value < threshold;
  }

  std::vector<std::vector<std::size_t>> neighbours;
  bool doubtful = false;
};

using Oracle = std::function<Graph(const LabelledCloud&, const std::vector<Thing>&)>;

Graph depthGraph(const LabelledCloud& cloud, const std::vector<Thing>& things)
{
  constexpr double kTheta = 10.0 * 3.14159265358979323846 / 180.0;
  constexpr int kMaxGap = 9;
  std::map<std::pair<int, int>, std::size_t> at;
  for (std::size_t i = 0; i < things.size(); ++i) at[{things[i].row, things[i].column}] = i;
  Graph graph(things.size());
  const int rows = static_cast<int>(cloud.height), columns = static_cast<int>(cloud.width);
  const auto connect = [&](std::size_t i, std::size_t j)
  {
    const double d1 =
        std::max(std::hypot(things[i].x, things[i].y, things[i].z), std::hypot(things[j].x, things[j].y, things[j].z));
    const double d2 =
        std::min(std::hypot(things[i].x, things[i].y, things[i].z), std::hypot(things[j].x, things[j].y, things[j].z));
    const double dot = things[i].x * things[j].x + things[i].y * things[j].y + things[i].z * things[j].z;
    const double a = std::acos(std::min(1.0, dot / (d1 * d2)));
    const double beta = std::atan2(d2 * std::sin(a), d1 - d2 * std::cos(a));
    if (distance(things[i], things[j]) == 0.0 || !graph.below(beta, kTheta)) graph.link(i, j);
  };
  for (std::size_t i = 0; i < things.size(); ++i)
    for (const auto& [down, right] : {std::pair{1, 0}, std::pair{0, 1}})
      for (int step = 1; step <= kMaxGap; ++step)
      {
        const int row = things[i].row + down * step, column = (things[i].column + right * step) % columns;
        const auto found = at.find({row, column});
        if (row >= rows || found == at.end() || things[found->second].link != things[i].link) continue;
        connect(i, found->second);
        break;
      }
  return graph;
}

Graph scanLineRunGraph(const LabelledCloud& cloud, const std::vector<Thing>& things)
{
  Graph graph(things.size());
  const int columns = static_cast<int>(cloud.width);
  const auto window = [&](const Thing& p)
  {
    const double exact =
        std::asin(std::min(1.0, 1.0 / std::hypot(p.x, p.y))) / (2.0 * 3.14159265358979323846 / columns);
    if (std::abs(exact - std::round(exact)) < 1e-3) graph.doubtful = true;
    return static_cast<int>(std::floor(exact)) + 1;
  };
  std::map<std::pair<int, ClassIndex>, std::vector<std::size_t>> lines;
  for (std::size_t i = 0; i < things.size(); ++i) lines[{things[i].row, things[i].link}].push_back(i);
  for (const auto& [key, line] : lines)
    for (std::size_t k = 0; k < line.size(); ++k)
    {
      const std::size_t i = line[k], next = line[(k + 1) % line.size()];
      if (graph.below(distance(things[i], things[next]), 0.5)) graph.link(i, next);
    }
  for (std::size_t i = 0; i < things.size(); ++i)
    for (std::size_t j = 0; j < i; ++j)
    {
      const int lines_apart = std::abs(things[i].row - things[j].row);
      if (things[i].link != things[j].link || lines_apart < 1 || lines_apart > 2) continue;
      const int apart = std::abs(things[i].column - things[j].column);
      if (std::min(apart, columns - apart) > std::min(window(things[i]), window(things[j]))) continue;
      if (graph.below(distance(things[i], things[j]), 1.0)) graph.link(i, j);
    }
  return graph;
}

Graph euclideanGraph(const LabelledCloud&, const std::vector<Thing>& things)
{
  using Cell = std::tuple<ClassIndex, int, int, int>;
  std::map<Cell, std::vector<std::size_t>> voxels;
  Graph graph(things.size());
  for (std::size_t i = 0; i < things.size(); ++i)
  {
    const auto cell = [](double metres) { return static_cast<int>(std::floor(metres / 0.1)); };
    voxels[{things[i].link, cell(things[i].x), cell(things[i].y), cell(things[i].z)}].push_back(i);
  }
  std::vector<std::size_t> representatives;
  for (auto& [cell, members] : voxels)
  {
    const std::size_t smallest = *std::min_element(members.begin(), members.end(),
                                                   [&](std::size_t a, std::size_t b)
                                                   {
                                                     const Thing &p = things[a], &q = things[b];
                                                     return std::tie(p.x, p.y, p.z) < std::tie(q.x, q.y, q.z);
                                                   });
    for (const std::size_t i : members) graph.link(i, smallest);
    representatives.push_back(smallest);
  }
  for (const std::size_t i : representatives)
    for (const std::size_t j : representatives)
      if (i < j && things[i].link == things[j].link && graph.below(distance(things[i], things[j]), 0.5))
        graph.link(i, j);
  return graph;
}

Graph birdsEyeGraph(const LabelledCloud&, const std::vector<Thing>& things)
{
  Graph graph(things.size());
  for (std::size_t i = 0; i < things.size(); ++i)
    for (std::size_t j = 0; j < i; ++j)
      if (things[i].link == things[j].link &&
          graph.below(std::hypot(things[i].x - things[j].x, things[i].y - things[j].y), 0.5))
        graph.link(i, j);
  return graph;
}

struct Rule
{
  std::string algorithm;
  Oracle oracle;
};

class OracleTest : public testing::TestWithParam<Rule>
{
};

TEST_P(OracleTest, randomScansAreSplitAsTheRuleSays)
{
  int compared = 0, split = 0;
  for (unsigned seed = 0; seed < 200; ++seed)
  {
    const std::uint32_t rows = 1 + seed % 17, columns = 1 + seed * 7 % 90;
    const LabelledCloud cloud = randomScan(seed, rows, columns);
    const auto things = thingsOf(cloud);
    const Graph graph = GetParam().oracle(cloud, things);
    if (graph.doubtful) continue;
    std::vector<std::uint32_t> found;
    const PanopticCloud out = runRule(GetParam().algorithm, cloud);
    for (const Thing& thing : things) found.push_back(out.points[thing.row * cloud.width + thing.column].instance);
    const auto expected = components(things.size(), graph.neighbours);
    ASSERT_EQ(found, expected) << "seed " << seed;
    ++compared;
    split += !expected.empty() && *std::max_element(expected.begin(), expected.end()) > 2 ? 1 : 0;
  }
  EXPECT_GT(compared, 100);
  EXPECT_GT(split, 50);
}

TEST_P(OracleTest, worstScansAreSplitAsTheRuleSays)
{
  int compared = 0;
  for (const WorstScan& worst : worstScans())
    for (const std::uint32_t columns : {40U, 97U, 300U})
    {
      const LabelledCloud cloud = worst.build(6, columns);
      const auto things = thingsOf(cloud);
      const Graph graph = GetParam().oracle(cloud, things);
      if (graph.doubtful) continue;
      std::vector<std::uint32_t> found;
      const PanopticCloud out = runRule(GetParam().algorithm, cloud, {{"field_of_view", std::string("full_turn")}});
      for (const Thing& thing : things) found.push_back(out.points[thing.row * cloud.width + thing.column].instance);
      ASSERT_EQ(found, components(things.size(), graph.neighbours)) << worst.name << ", " << columns << " columns";
      ++compared;
    }
  std::cout << compared << " scans compared\n";
  EXPECT_GE(compared, 10);
}

INSTANTIATE_TEST_SUITE_P(Rules, OracleTest,
                         testing::Values(Rule{"depth", depthGraph}, Rule{"scan_line_run", scanLineRunGraph},
                                         Rule{"euclidean", euclideanGraph}, Rule{"birds_eye", birdsEyeGraph}),
                         [](const auto& test) { return test.param.algorithm; });

using XyzCloud = pcl::PointCloud<pcl::PointXYZ>;

/// Supervoxels straight from PCL, of points in order of (x, y, z): each point's label, 0 where PCL left its voxel out.
/// Whether two points share a voxel is asked of PCL's own octree.
std::map<std::array<float, 3>, std::uint32_t> supervoxelsByPcl(XyzCloud::Ptr cloud, float normal_weight,
                                                               std::vector<std::array<float, 3>>& left_out)
{
  std::sort(cloud->points.begin(), cloud->points.end(),
            [](const auto& p, const auto& q) { return std::tie(p.x, p.y, p.z) < std::tie(q.x, q.y, q.z); });
  pcl::SupervoxelClustering<pcl::PointXYZ> supervoxels(0.5F, 8.0F);
  supervoxels.setUseSingleCameraTransform(false);
  supervoxels.setInputCloud(cloud);
  supervoxels.setColorImportance(0.0F);
  supervoxels.setSpatialImportance(1.0F);
  supervoxels.setNormalImportance(normal_weight);
  std::map<std::uint32_t, pcl::Supervoxel<pcl::PointXYZ>::Ptr> found;
  supervoxels.extract(found);

  pcl::octree::OctreePointCloudAdjacency<pcl::PointXYZ> octree(0.5);
  octree.setInputCloud(cloud);
  octree.addPointsFromInputCloud();
  std::map<const void*, std::uint32_t> label_of_leaf;
  for (const auto& [label, supervoxel] : found)
    for (const auto& centroid : supervoxel->voxels_->points)
      label_of_leaf[octree.getLeafContainerAtPoint(centroid)] = label;
  std::map<std::array<float, 3>, std::uint32_t> labels;
  for (const auto& p : cloud->points)
  {
    const auto at = label_of_leaf.find(octree.getLeafContainerAtPoint(p));
    if (at == label_of_leaf.end())
      left_out.push_back({p.x, p.y, p.z});
    else
      labels[{p.x, p.y, p.z}] = at->second;
  }
  return labels;
}

TEST(SupervoxelOracle, pointsTakeTheSupervoxelPclGivesTheirVoxel)
{
  std::size_t labelled_points = 0, left_out_points = 0;
  for (unsigned seed = 0; seed < 12; ++seed)
  {
    // cars only, so that one call of PCL sees all
    LabelledCloud cloud = randomScan(seed, 32, 256);
    for (auto& p : cloud.points) p.label = p.label == kRoad ? kRoad : kCar;
    const XyzCloud::Ptr points(new XyzCloud);
    for (const Thing& p : thingsOf(cloud))
      points->push_back({static_cast<float>(p.x), static_cast<float>(p.y), static_cast<float>(p.z)});
    for (const float normal_weight : {0.0F, 0.5F})
    {
      std::vector<std::array<float, 3>> left_out;
      const auto expected = supervoxelsByPcl(points, normal_weight, left_out);
      const PanopticCloud out = runRule("supervoxel", cloud, {{"normal_weight", static_cast<double>(normal_weight)}});
      std::map<std::uint32_t, std::uint32_t> label_of_instance, instance_of_label;
      for (const auto& p : out.points)
      {
        if (p.instance == 0) continue;
        const auto at = expected.find({p.x, p.y, p.z});
        const std::uint32_t label = at == expected.end() ? 0 : at->second;
        EXPECT_EQ(label_of_instance.emplace(p.instance, label).first->second, label);
        if (label != 0)
        {
          EXPECT_EQ(instance_of_label.emplace(label, p.instance).first->second, p.instance);
        }
      }
      labelled_points += expected.size(), left_out_points += left_out.size();
    }
  }
  EXPECT_GT(labelled_points, 1000U);
  EXPECT_GT(left_out_points, 10U);
}
}  // namespace
}  // namespace lidar_panoptic_clustering

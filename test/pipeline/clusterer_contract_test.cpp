// What the pipeline holds a clusterer to, a user's own too, and inputs that once broke it.
#include "scan_fixture.h"

#include "lidar_panoptic_clustering/clusterers/supervoxel_clusterer.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <set>

namespace lidar_panoptic_clustering
{
/// Writes what it is told to, whatever the scan.
class BrokenClusterer : public Clusterer
{
public:
  explicit BrokenClusterer(std::vector<std::uint32_t> components) : components_(std::move(components)) {}
  void cluster(const ThingScan&, std::vector<std::uint32_t>& component) override { component = components_; }

private:
  std::vector<std::uint32_t> components_;
};

namespace
{
LabelledCloud rowOf(const std::vector<LabelledPoint>& points)
{
  LabelledCloud cloud;
  cloud.points.assign(points.begin(), points.end());
  cloud.width = static_cast<std::uint32_t>(points.size()), cloud.height = 1;
  return cloud;
}

/// "" where nothing is thrown.
std::string complaintOf(const std::vector<std::uint32_t>& components)
{
  FramePipeline pipeline(kittiTable(), PipelineConfig(), std::make_unique<BrokenClusterer>(components));
  const LabelledCloud cloud = rowOf({labelled(5, 0, 0, kCar), labelled(9, 0, 0, kCar), labelled(5, 4, 0, kRoad)});
  try
  {
    pipeline.segment(cloud);
    EXPECT_EQ(pipeline.instances().id.size(), 2U);
    return "";
  }
  catch (const std::logic_error& error)
  {
    EXPECT_EQ(pipeline.things().size(), 0U);
    EXPECT_EQ(pipeline.instances().count(), 0U);
    PanopticCloud out;
    EXPECT_THROW(pipeline.paint(cloud, out), std::invalid_argument);
    return error.what();
  }
}

TEST(ClustererContract, IsHeldByTheName)
{
  const std::string who = "clusterer lidar_panoptic_clustering::BrokenClusterer is broken: expected 2 ";
  EXPECT_EQ(complaintOf({0, 1}), "");
  EXPECT_EQ(complaintOf({1, 1}), "");
  EXPECT_EQ(complaintOf({0, 2}), who + "thing points' components below that, found 2");
  EXPECT_EQ(complaintOf({0xFFFFFFFF, 0}), who + "thing points' components below that, found 4294967295");
  EXPECT_EQ(complaintOf({0}), who + "components, one a thing point, found 1");
  EXPECT_EQ(complaintOf({}), who + "components, one a thing point, found 0");
  EXPECT_EQ(complaintOf({0, 0, 0}), who + "components, one a thing point, found 3");
}

TEST(ClustererContract, ThereHasToBeOne)
{
  EXPECT_THROW(FramePipeline(kittiTable(), PipelineConfig(), nullptr), std::invalid_argument);
  Algorithm depth = makeAlgorithm("depth");
  FramePipeline pipeline(kittiTable(), depth.pipeline, std::move(depth.clusterer));
  EXPECT_THROW(pipeline.reconfigure(PipelineConfig(), nullptr), std::invalid_argument);
  pipeline.segment(rowOf({labelled(5, 0, 0, kCar)}));
  EXPECT_EQ(pipeline.instances().count(), 1U);
}

/// Components 0 .. n - 1 of n points at most, and all points of an object in one.
void expectContract(Clusterer& clusterer, const LabelledCloud& cloud)
{
  ThingScan scan;
  selectThings(cloud, *kittiTable(), SelectionConfig(), scan);
  std::vector<std::uint32_t> component;
  clusterer.cluster(scan, component);
  ASSERT_EQ(component.size(), scan.size());
  const std::set<std::uint32_t> used(component.begin(), component.end());
  ASSERT_TRUE(used.empty() || *used.rbegin() < scan.size()) << *used.rbegin() << " of " << scan.size();
}

/// Twenty-nine returns a metre apart, of which PCL makes thirty supervoxels, one of them empty.
TEST(ClustererContract, SupervoxelsThatLoseAllTheirVoxelsAreNotCounted)
{
  const float points[][3] = {{37.5851898F, -1.14850283F, -0.859377325F},  {38.5070076F, -2.75324106F, 0.568704009F},
                             {38.5072784F, 3.31792212F, -1.01061451F},    {38.3421135F, 1.15134084F, -0.989667177F},
                             {39.6890144F, 3.71784163F, 0.549791873F},    {43.5460663F, -0.517626345F, -0.130458459F},
                             {39.6705284F, 0.762029469F, 0.328913093F},   {38.5943756F, 2.75488281F, 0.892648458F},
                             {38.7209282F, -0.16045545F, -0.878596127F},  {37.3699226F, -2.16053915F, 1.03895974F},
                             {40.3631325F, -3.23377252F, 0.751641214F},   {41.2993927F, -3.26777768F, -0.73685497F},
                             {43.9549294F, 2.32972693F, 0.580258727F},    {42.7743568F, -2.4187696F, 0.380243599F},
                             {36.1679306F, 1.18471014F, -0.132751361F},   {37.4885178F, 0.205950007F, 0.462219596F},
                             {43.4054718F, -3.56959867F, -0.519802153F},  {36.9703827F, 3.4554739F, 0.528655529F},
                             {41.544445F, -3.02119708F, 0.336752236F},    {42.938549F, -0.833413839F, 0.96204865F},
                             {39.9891014F, -0.721747577F, -0.921661854F}, {42.7680588F, 2.4061749F, -0.414779663F},
                             {40.1124992F, -1.81770074F, 0.47596705F},    {36.7658463F, -3.13617253F, -0.0477089919F},
                             {43.8290939F, 3.7020402F, 0.133209288F},     {44.2379799F, -1.67393196F, 0.0281106271F},
                             {39.9904709F, 1.78733408F, 0.14313145F},     {41.2873955F, 1.56770015F, 0.478809983F},
                             {36.3110695F, -1.19178283F, 0.0212875716F}};
  std::vector<LabelledPoint> things;
  for (const auto& p : points) things.push_back(labelled(p[0], p[1], p[2], kCar));
  SupervoxelClusterer clusterer;
  expectContract(clusterer, rowOf(things));
  const PanopticCloud out = runAlgorithm("supervoxel", rowOf(things));
  for (const auto& p : out.points) EXPECT_NE(p.instance, 0U);
}

/// A point at nearly 0 and others a multiple of the seeds' distance away: PCL 1.10's octree ended the program.
TEST(ClustererContract, SupervoxelsOfPointsAtTheOctreesBorder)
{
  SupervoxelClusterer clusterer;
  for (const float nothing : {-8e-23F, 8e-23F, -6e-16F, 6e-16F, -1e-9F, 1e-7F})
    for (const float away : {-8.0F, -16.0F, -24.0F, -48.0F, 8.0F, 16.0F})
      for (const float aside : {-12.0F, -5.0F, -3.0F, 4.0F})
        for (int axis = 0; axis < 3; ++axis)
        {
          float p[2][3] = {{-4.0F, away, 0.5F}, {aside, nothing, 0.5F}};
          for (auto& point : p) std::rotate(point, point + axis, point + 3);
          expectContract(clusterer,
                         rowOf({labelled(p[0][0], p[0][1], p[0][2], kCar), labelled(p[1][0], p[1][1], p[1][2], kCar)}));
        }
}

TEST(ClustererContract, SparseReturnsWithSmallSeeds)
{
  std::mt19937 random(5);
  std::uniform_real_distribution<float> place(-4.0F, 4.0F);
  for (const double seed_m : {1.0, 2.0, 8.0})
  {
    SupervoxelConfig config;
    config.seed_m = seed_m;
    SupervoxelClusterer clusterer(config);
    for (int i = 0; i < 150; ++i)
    {
      std::vector<LabelledPoint> things;
      for (auto n = random() % 40; n > 0; --n)
        things.push_back(labelled(40.0F + place(random), place(random), 0.25F * place(random), kCar));
      expectContract(clusterer, rowOf(things));
    }
  }
}

/// Cells of a tiny distance are many: a coordinate of the grid has to hold them all, and what it cannot hold is
/// refused.
TEST(ClustererContract, TinyDistancesJoinNothingFarAway)
{
  for (const char* name : {"birds_eye", "euclidean"})
    for (const double distance : {1e-7, 0.0001, 0.00099, -1.0, 10.5})
      EXPECT_THROW(makeAlgorithm(name, {{"distance_m", distance}}), std::invalid_argument) << distance;
  EXPECT_THROW(makeAlgorithm("depth", {{"max_distance_m", 1e-30}}), std::invalid_argument);
  EXPECT_THROW(makeAlgorithm("depth", {{"bridge_distance_m", 1e-30}}), std::invalid_argument);
  PipelineConfig config;
  config.refinement.bridge_distance_m = 1e-30;
  EXPECT_THROW(FramePipeline(kittiTable(), config, std::make_unique<BrokenClusterer>(std::vector<std::uint32_t>())),
               std::invalid_argument);

  Algorithm a = makeAlgorithm("birds_eye",
                              {{"distance_m", 0.001}, {"split", false}, {"merge", false}, {"bridge_distance_m", 0.0}});
  FramePipeline pipeline(kittiTable(), a.pipeline, std::move(a.clusterer));
  const float cell = 0.7071F * 0.001F;
  LabelledCloud cloud = rowOf({labelled(-70.00003F, 3, 0, kCar), labelled(0, 3, 0, kCar)});
  for (const float turn : {65536.0F, 1048576.0F / 4.0F, 2097152.0F / 8.0F})
    for (int i = -20; i < 20; ++i)
    {
      cloud.points[1].x = -70.00003F + turn * cell + static_cast<float>(i) * cell / 4;
      pipeline.segment(cloud);
      ASSERT_EQ(pipeline.instances().count(), 2U) << cloud.points[1].x;
    }
  // 7 km apart with cells that once shared a place on the grid
  Algorithm far = makeAlgorithm("birds_eye", {{"distance_m", 0.005}, {"max_range_m", 10000.0}});
  FramePipeline wide(kittiTable(), far.pipeline, std::move(far.clusterer));
  for (int i = -20; i < 20; ++i)
  {
    const float step = 0.7071F * 0.005F;
    cloud.points[0].x = -3700.0F, cloud.points[1].x = -3700.0F + 2097152.0F * step + static_cast<float>(i) * step / 4;
    wide.segment(cloud);
    ASSERT_EQ(wide.instances().count(), 2U) << cloud.points[1].x;
  }
}
}  // namespace
}  // namespace lidar_panoptic_clustering

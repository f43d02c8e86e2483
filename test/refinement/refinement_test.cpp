// The steps behind the clusterer, on literal street scenes seen from above.
#include "scan_fixture.h"

#include "lidar_panoptic_clustering/clusterers/birds_eye_clusterer.h"
#include "lidar_panoptic_clustering/geometry/footprint.h"

#include <gtest/gtest.h>

#include <set>

namespace lidar_panoptic_clustering
{
namespace
{
constexpr std::uint32_t kBus = 13, kBicycle = 11;

/// A cloud of one row, to be filled point by point.
class Scene
{
public:
  void add(float x, float y, std::uint32_t label, float z = 0.0F) { points_.push_back(labelled(x, y, z, label)); }

  /// A wall of points from (x0, y0) to (x1, y1), 5 cm apart.
  void addWall(float x0, float y0, float x1, float y1, std::uint32_t label)
  {
    const int steps = static_cast<int>(std::hypot(x1 - x0, y1 - y0) / 0.05F) + 1;
    for (int k = 0; k <= steps; ++k)
    {
      const float t = static_cast<float>(k) / static_cast<float>(steps);
      add(x0 + t * (x1 - x0), y0 + t * (y1 - y0), label);
    }
  }

  /// All four sides of a box.
  void addBox(float x, float y, float length, float width, std::uint32_t label)
  {
    addWall(x, y, x + length, y, label);
    addWall(x + length, y, x + length, y + width, label);
    addWall(x + length, y + width, x, y + width, label);
    addWall(x, y + width, x, y, label);
  }

  PanopticCloud cluster(const ParameterMap& parameters = {}) const
  {
    LabelledCloud cloud = emptyCloud(1, static_cast<std::uint32_t>(points_.size()));
    std::copy(points_.begin(), points_.end(), cloud.points.begin());
    return runAlgorithm("birds_eye", cloud, parameters);
  }

  std::size_t count(const ParameterMap& parameters = {}) const
  {
    const auto ids = instancesOf(cluster(parameters));
    return std::set<std::uint32_t>(ids.begin(), ids.end()).size();
  }

private:
  std::vector<LabelledPoint> points_;
};

TEST(Splitting, twoCarsThirtyCentimetresApart)
{
  Scene scene;
  scene.addBox(10.0F, 0.0F, 4.4F, 1.8F, kCar);
  scene.addBox(10.0F, 2.1F, 4.4F, 1.8F, kCar);
  EXPECT_EQ(scene.count(), 2U);
  EXPECT_EQ(scene.count({{"split", false}}), 1U);
}

TEST(Splitting, aBusIsNotSplit)
{
  Scene scene;
  scene.addBox(10.0F, 0.0F, 12.0F, 2.5F, kBus);
  EXPECT_EQ(scene.count(), 1U);
}

TEST(Splitting, whatHangsTogetherIsNotSplit)
{
  Scene scene;  // longer than any car, but without a gap
  scene.addBox(10.0F, 0.0F, 9.0F, 1.8F, kCar);
  EXPECT_EQ(scene.count(), 1U);
}

TEST(Splitting, anLShapedCornerViewIsNotSplit)
{
  Scene scene;
  scene.addWall(10.0F, 0.0F, 14.4F, 0.5F, kCar);
  scene.addWall(10.0F, 0.0F, 9.8F, 1.8F, kCar);
  EXPECT_EQ(scene.count(), 1U);
}

TEST(Splitting, aCrowd)
{
  Scene scene;
  for (int k = 0; k < 5; ++k) scene.addBox(8.0F, 0.8F * static_cast<float>(k), 0.3F, 0.5F, kPerson);
  EXPECT_EQ(scene.count(), 5U);
  EXPECT_EQ(scene.count({{"split", false}}), 1U);
}

TEST(Merging, aTruckSeenThroughAFence)
{
  Scene scene;
  for (int k = 0; k < 4; ++k)
    scene.addWall(10.0F + 3.5F * static_cast<float>(k), 4.0F, 11.0F + 3.5F * static_cast<float>(k), 4.0F, kTruck);
  EXPECT_EQ(scene.count(), 1U);
  EXPECT_EQ(scene.count({{"merge", false}}), 4U);
}

TEST(Merging, twoBicyclesAreTwo)
{
  Scene scene;
  scene.addWall(6.0F, 0.0F, 7.7F, 0.0F, kBicycle);
  scene.addWall(6.0F, 0.9F, 7.7F, 0.9F, kBicycle);
  EXPECT_EQ(scene.count(), 2U);
}

TEST(Merging, notAcrossAThirdObject)
{
  Scene scene;
  scene.addWall(10.0F, 4.0F, 11.0F, 4.0F, kTruck);
  scene.addWall(14.0F, 4.0F, 15.0F, 4.0F, kTruck);
  EXPECT_EQ(scene.count(), 1U);
  scene.addBox(12.0F, 3.0F, 1.0F, 2.0F, kPerson);
  EXPECT_EQ(scene.count(), 3U);
}

TEST(Vote, aCarPartlyPaintedAsATruckIsOneCar)
{
  Scene scene;
  scene.addBox(10.0F, 0.0F, 3.0F, 1.8F, kMovingCar);
  scene.addBox(13.1F, 0.0F, 1.2F, 1.8F, kTruck);
  const PanopticCloud out = scene.cluster();
  for (const auto& p : out.points)
  {
    EXPECT_EQ(p.instance, 1U);
    EXPECT_EQ(p.label, p.x < 13.05F ? kMovingCar : kCar) << "the raw id stays where the class does";
  }
  EXPECT_EQ(scene.cluster({{"vote", false}}).points.back().label, kTruck);
  EXPECT_EQ(scene.count({{"bridge_distance_m", 0.0}}), 2U);
}

TEST(Vote, aPedestrianBesideACarIsParted)
{
  Scene scene;
  scene.addBox(10.0F, 0.0F, 4.4F, 1.8F, kCar);
  scene.addBox(11.0F, 1.85F, 0.4F, 0.4F, kPerson);
  EXPECT_EQ(scene.count(), 2U);
}

TEST(FootprintTest, sizesOfRectanglesAreExactWhateverTheirHeading)
{
  for (int degrees = 0; degrees < 180; degrees += 7)
  {
    const float c = std::cos(0.0174533F * static_cast<float>(degrees));
    const float s = std::sin(0.0174533F * static_cast<float>(degrees));
    Footprint footprint;
    for (int i = 0; i <= 20; ++i)
      for (int j = 0; j <= 10; ++j)
      {
        const float x = 0.2F * static_cast<float>(i), y = 0.18F * static_cast<float>(j);
        footprint.add(30.0F + c * x - s * y, -5.0F + s * x + c * y);
      }
    const RectangleSize size = footprint.smallestRectangle();
    EXPECT_NEAR(size.length, 4.0F, 1e-4F) << degrees;
    EXPECT_NEAR(size.width, 1.8F, 1e-4F) << degrees;
    EXPECT_TRUE(footprint.fits(4.01F, 1.81F));
    EXPECT_FALSE(footprint.fits(3.99F, 1.81F));
    EXPECT_FALSE(footprint.fits(4.01F, 1.79F));
  }
}

TEST(FootprintTest, gaps)
{
  const auto outline = [](std::initializer_list<PlanarPoint> points)
  {
    Footprint footprint;
    for (const auto& p : points) footprint.add(p.x, p.y);
    return footprint;
  };
  const Footprint square = outline({{0, 0}, {2, 0}, {2, 2}, {0, 2}});
  EXPECT_FLOAT_EQ(square.gapTo(outline({{3, 1}})).squaredDistance(), 1.0F);
  EXPECT_FLOAT_EQ(outline({{3, 1}}).gapTo(square).squaredDistance(), 1.0F);
  EXPECT_FLOAT_EQ(square.gapTo(outline({{5, 6}, {7, 6}})).squaredDistance(), 25.0F);
  EXPECT_FLOAT_EQ(square.gapTo(outline({{-1, 1}, {3, 1}})).squaredDistance(), 0.0F) << "a segment through it";
  EXPECT_FLOAT_EQ(square.gapTo(outline({{1, 1}})).squaredDistance(), 0.0F) << "a point within";
  EXPECT_FLOAT_EQ(outline({{1, 1}}).gapTo(square).squaredDistance(), 0.0F);
  EXPECT_TRUE(square.isCrossedBy({-1, 1}, {3, 1}));
  EXPECT_FALSE(square.isCrossedBy({-1, 3}, {3, 3}));
}

/// How many points bird's-eye clustering looks at for two walls of `n` points together and 10 m length, just farther
/// apart than the link distance: no pair is close, and all cells are beside others.
std::size_t workForWalls(std::uint32_t n, float heading)
{
  const float c = std::cos(heading), s = std::sin(heading);
  LabelledCloud cloud = emptyCloud(1, n);
  for (std::uint32_t i = 0; i < n; ++i)
  {
    const float along = 20.0F * static_cast<float>(i / 2) / static_cast<float>(n), across = i % 2 == 0 ? 0.0F : 0.8001F;
    cloud.points[i] = labelled(20.0F + c * along - s * across, s * along + c * across, 0.0F, kCar);
  }
  ThingScan scan;
  selectThings(cloud, *kittiTable(), SelectionConfig(), scan);
  BirdsEyeClusterer clusterer;
  std::vector<std::uint32_t> component;
  clusterer.cluster(scan, component);
  EXPECT_EQ(std::set<std::uint32_t>(component.begin(), component.end()).size(), 2U);
  return clusterer.pointsLookedAt();
}

TEST(BirdsEye, workGrowsWithThePointsAndNotWithTheirPairs)
{
  for (int degrees = 0; degrees < 90; degrees += 15)
  {
    const float heading = 0.0174533F * static_cast<float>(degrees);
    // all pairs would be 16 times as many; the power 1.5 is 8
    EXPECT_LT(workForWalls(80000, heading), 9 * workForWalls(20000, heading)) << degrees;
  }
}
}  // namespace
}  // namespace lidar_panoptic_clustering

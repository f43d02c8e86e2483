#include "lidar_panoptic_clustering/simulation/ray_caster.h"

#include "lidar_panoptic_clustering/simulation/ground.h"
#include "lidar_panoptic_clustering/simulation/labels.h"
#include "lidar_panoptic_clustering/simulation/models.h"
#include "lidar_panoptic_clustering/simulation/street.h"

#include <Eigen/LU>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

namespace lidar_panoptic_clustering
{
using namespace simulation;

namespace
{
constexpr float kInfinity = std::numeric_limits<float>::infinity();

/// A small sensor with room above and below the horizon, without noise.
SensorModel smallModel()
{
  SensorModel model;
  model.name = "small";
  for (int i = 0; i < 16; ++i) model.elevations_rad.push_back(0.30F - 0.045F * static_cast<float>(i));
  model.columns = 128;
  model.min_range_m = 0.5F;
  model.max_range_m = 120.0F;
  model.mount_height_m = 1.73F;
  return model;
}

/// The first sample of a line that lies inside a unit shape, found by walking.
float march(Shape shape, const Eigen::Vector3f& origin, const Eigen::Vector3f& direction, float end, float step)
{
  for (float t = 0.0F; t < end; t += step)
  {
    const Eigen::Vector3f p = origin + t * direction;
    const bool inside = shape == Shape::kBox        ? p.cwiseAbs().maxCoeff() <= 1.0F
                        : shape == Shape::kCylinder ? p.head<2>().norm() <= 1.0F && std::abs(p.z()) <= 1.0F
                                                    : p.norm() <= 1.0F;
    if (inside) return t;
  }
  return kInfinity;
}
}  // namespace

TEST(Random, IsTheSameEverywhere)
{
  // SplitMix64's published first outputs for seed 1234567
  Random random(1234567);
  EXPECT_EQ(random.next(), 6457827717110365317ULL);
  EXPECT_EQ(random.next(), 3203168211198807973ULL);
  EXPECT_EQ(random.next(), 9817491932198370423ULL);
}

TEST(Random, GaussianHasMeanZeroAndDeviationOne)
{
  double sum = 0.0, squares = 0.0;
  constexpr int kCount = 20000;
  for (std::uint64_t i = 0; i < kCount; ++i)
  {
    const double value = gaussian(draw(7, i));
    sum += value, squares += value * value;
  }
  EXPECT_NEAR(sum / kCount, 0.0, 0.03);
  EXPECT_NEAR(squares / kCount, 1.0, 0.03);
}

TEST(Intersect, LiteralLines)
{
  Chord chord;
  ASSERT_TRUE(intersect(Shape::kBox, {-5.0F, 0.5F, 0.0F}, {1.0F, 0.0F, 0.0F}, chord));
  EXPECT_FLOAT_EQ(chord.enter, 4.0F);
  EXPECT_FLOAT_EQ(chord.exit, 6.0F);
  EXPECT_FALSE(intersect(Shape::kBox, {-5.0F, 1.5F, 0.0F}, {1.0F, 0.0F, 0.0F}, chord));

  ASSERT_TRUE(intersect(Shape::kCylinder, {-5.0F, 0.6F, 0.0F}, {1.0F, 0.0F, 0.0F}, chord));
  EXPECT_NEAR(chord.enter, 4.2F, 1e-5F);
  ASSERT_TRUE(intersect(Shape::kCylinder, {0.3F, 0.0F, 9.0F}, {0.0F, 0.0F, -2.0F}, chord));
  EXPECT_FLOAT_EQ(chord.enter, 4.0F);
  EXPECT_FALSE(intersect(Shape::kCylinder, {-5.0F, 0.0F, 1.1F}, {1.0F, 0.0F, 0.0F}, chord));

  ASSERT_TRUE(intersect(Shape::kEllipsoid, {0.0F, -3.0F, 0.8F}, {0.0F, 1.0F, 0.0F}, chord));
  EXPECT_NEAR(chord.enter, 2.4F, 1e-5F);
  EXPECT_FALSE(intersect(Shape::kEllipsoid, {0.0F, -3.0F, 1.01F}, {0.0F, 1.0F, 0.0F}, chord));
}

TEST(Intersect, AgreesWithMarching)
{
  Random random(3);
  int hits = 0;
  for (int i = 0; i < 300; ++i)
  {
    const auto shape = static_cast<Shape>(random.below(3));
    Eigen::Vector3f origin, aim;
    for (int k = 0; k < 3; ++k) origin[k] = random.uniform(-4.0F, 4.0F), aim[k] = random.uniform(-1.0F, 1.0F);
    if (origin.cwiseAbs().maxCoeff() <= 1.05F) continue;  // starts inside or nearly
    const Eigen::Vector3f direction = (aim - origin).normalized();
    Chord chord;
    const bool met = intersect(shape, origin, direction, chord) && chord.enter > 0.0F;
    const float expected = march(shape, origin, direction, 12.0F, 2e-3F);
    if (expected < kInfinity)
    {
      ++hits;
      ASSERT_TRUE(met) << "line " << i;
      EXPECT_NEAR(chord.enter, expected, 3e-3F) << "line " << i;
    }
    else if (met)  // a corner between two samples
    {
      EXPECT_LT(chord.exit - chord.enter, 2e-3F) << "line " << i;
    }
  }
  EXPECT_GT(hits, 100);
}

TEST(Ground, CrossSectionOfAStraightPlace)
{
  const Course course(1);
  const double station = 1000.0;
  const Pose sensor = course.at(station, 0.3, 2.0);
  const Ground ground(course, 1, sensor, 100.0);
  // beams to the left that meet the ground `out` metres away; height 2 m above the road, 1.88 above the sidewalk
  const auto towards = [&](float out, float below)
  { return ground.hit(Eigen::Vector3f(0.0F, out, -below).normalized(), 0); };

  EXPECT_EQ(towards(3.0F, 2.0F).surface.label, label::kRoad);
  EXPECT_NEAR(towards(3.0F, 2.0F).range_m, std::hypot(3.0F, 2.0F), 1e-4F);
  EXPECT_EQ(towards(5.0F, 2.0F).surface.label, label::kParking);
  EXPECT_EQ(towards(9.0F, 1.88F).surface.label, label::kSidewalk);
  EXPECT_NEAR(towards(9.0F, 1.88F).range_m, std::hypot(9.0F, 1.88F), 1e-3F);
  const GroundHit curb = towards(6.9F, 1.94F);  // half way up its face
  EXPECT_EQ(curb.surface.label, label::kSidewalk);
  EXPECT_NEAR(curb.range_m, std::hypot(6.9F, 1.94F), 0.02F);
  EXPECT_GT(curb.incidence, 0.9F);
}

TEST(RayCaster, EqualsEverySolidOnEveryBeam)
{
  RayCaster caster(smallModel());
  int solid_ends = 0, foliage_ends = 0;
  for (const std::uint64_t frame : {0, 7, 90})
  {
    const double station = 8.0 * static_cast<double>(frame);
    Street street({5, 0.8, 0.5}, {5, 8.0, 0.8, 0.5});
    std::vector<Solid> solids;
    street.collect(static_cast<double>(frame), station, 120.0, solids);
    const Pose sensor = street.course().at(station, kEgoOffset, 1.73);
    caster.cast(solids, sensor, frame);

    for (std::uint32_t row = 0; row < 16; ++row)
      for (std::uint32_t column = 0; column < 128; ++column)
      {
        float nearest = caster.limit(row);
        std::int64_t owner = -1;
        for (const Target& target : caster.targets())
        {
          const float range_m =
              RayCaster::range(target, caster.direction(row, column), caster.beamKey(frame, row, column));
          if (range_m < nearest || (range_m == nearest && owner >= 0 && target.solid < owner))
            nearest = range_m, owner = target.solid;
        }
        const BeamEnd& end = caster.at(row, column);
        ASSERT_EQ(end.range_m, nearest) << "row " << row << " column " << column;
        ASSERT_EQ(end.target < 0 ? -1 : std::int64_t{caster.targets()[end.target].solid}, owner);
        solid_ends += owner >= 0 ? 1 : 0;
        foliage_ends += owner >= 0 && solids[owner].surface.label == label::kVegetation ? 1 : 0;
      }
  }
  EXPECT_GT(solid_ends, 1500);
  EXPECT_GT(foliage_ends, 100);
}

/// Against a ray tracer of its own in double precision, straight from the solids: nothing may be culled wrongly, and
/// sensor pose, axes and beams must fit together; in sectors too, of which the widest leaves out little of the rear.
class RayCasterOfView : public testing::TestWithParam<int>
{
};

TEST_P(RayCasterOfView, FindsTheRangesOfTheWorld)
{
  Street street({9, 0.8, 0.5}, {9, 8.0, 0.8, 0.5});
  std::vector<Solid> solids, opaque;
  street.collect(3.0, 24.0, 120.0, solids);
  for (const Solid& solid : solids)
    if (solid.surface.transmission == 0.0F && solid.surface.depth_m == 0.0F) opaque.push_back(solid);
  const Pose sensor{24.0, 0.4, 1.73, 0.7};
  SensorModel model = smallModel();
  model.horizontal_fov_rad = GetParam() * M_PI / 180.0;
  RayCaster caster(model);
  caster.cast(opaque, sensor, 0);

  int differences = 0, ends = 0;
  for (std::uint32_t row = 0; row < 16; ++row)
    for (std::uint32_t column = 0; column < 128; ++column)
    {
      const double elevation = model.elevations_rad[row],
                   heading = sensor.yaw + (0.5 - (column + 0.5) / 128) * model.horizontal_fov_rad;
      const Eigen::Vector3d ray(std::cos(elevation) * std::cos(heading), std::cos(elevation) * std::sin(heading),
                                std::sin(elevation));
      double nearest = elevation < 0.0 ? std::min(120.0, 1.73 / std::sin(-elevation)) : 120.0;
      for (const Solid& solid : opaque)
      {
        const Eigen::Matrix3f inverse = solid.half_axes.inverse();
        const Eigen::Vector3d offset = Eigen::Vector3d(sensor.x, sensor.y, sensor.z) - solid.center;
        const Eigen::Vector3f origin = (inverse.cast<double>() * offset).cast<float>();
        Chord chord;
        if (intersect(solid.shape, origin, (inverse.cast<double>() * ray).cast<float>(), chord) && chord.enter > 0.0F)
          nearest = std::min(nearest, double{chord.enter});
      }
      ++ends;
      differences += std::abs(nearest - double{caster.at(row, column).range_m}) > 0.01 * nearest ? 1 : 0;
    }
  EXPECT_LE(differences, ends / 200);  // beams that graze an edge
}
INSTANTIATE_TEST_SUITE_P(Degrees, RayCasterOfView, testing::Values(360, 350, 180, 90, 10));

TEST(RayCaster, WhatStandsBehindAWallIsNotSeen)
{
  std::vector<Solid> solids;
  ObjectBuilder(solids, {10.0, 0.0, 0.0, 0.0}, label::kBuilding).box({0.0F, 0.0F, 2.0F}, {0.2F, 8.0F, 4.0F});
  ObjectBuilder(solids, {15.0, 0.0, 0.0, 0.0}, label::kCar, 1).box({0.0F, 0.0F, 0.75F}, {4.0F, 1.8F, 1.5F});
  ObjectBuilder(solids, {6.0, 0.0, 0.0, 0.0}, label::kPole).bar({0.0F, 0.0F, 0.0F}, {0.0F, 0.0F, 3.0F}, 0.3F);
  RayCaster caster(smallModel());
  caster.cast(solids, {0.0, 0.0, 1.73, 0.0}, 0);
  std::map<std::uint32_t, int> beams;
  for (std::uint32_t row = 0; row < 16; ++row)
    for (std::uint32_t column = 0; column < 128; ++column)
      if (const auto target = caster.at(row, column).target; target >= 0) ++beams[caster.targets()[target].solid];
  EXPECT_GT(beams[0], 50);
  EXPECT_EQ(beams.count(1), 0U);
  EXPECT_GT(beams[2], 5);
  // column 63 and 64 look ahead, either side of the x axis; the pole stands before the wall
  EXPECT_NEAR(caster.at(6, 63).range_m, 5.7F, 0.1F);
}

TEST(RayCaster, SeesWhatSpansTheRearAndWhatHangsOverIt)
{
  std::vector<Solid> solids;
  ObjectBuilder(solids, {-10.0, 0.0, 0.0, 0.0}, label::kBuilding).box({0.0F, 0.0F, 2.0F}, {0.2F, 8.0F, 4.0F});
  ObjectBuilder(solids, {0.5, 0.0, 0.0, 0.0}, label::kVegetation).ellipsoid({0.0F, 0.0F, 3.5F}, {16.0F, 16.0F, 2.0F});
  RayCaster caster(smallModel());
  caster.cast(solids, {0.0, 0.0, 1.73, 0.0}, 0);
  for (const std::uint32_t column : {0, 3, 124, 127}) EXPECT_NEAR(caster.at(7, column).range_m, 9.95F, 0.2F);
  for (std::uint32_t column = 0; column < 128; ++column) EXPECT_LT(caster.at(0, column).range_m, 8.0F);
}
}  // namespace lidar_panoptic_clustering

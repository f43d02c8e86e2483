#include "projection/point_azimuths.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <limits>
#include <random>
#include <vector>

namespace lidar_panoptic_clustering
{
namespace
{
std::uint32_t bitsOf(float value)
{
  std::uint32_t bits = 0;
  std::memcpy(&bits, &value, sizeof(bits));
  return bits;
}

/// The points and their directions, each by itself.
void expectAsOneByOne(const std::vector<ScanPoint>& scan)
{
  std::size_t next = 0;
  forEachAzimuth(scan,
                 [&](std::size_t i, float azimuth, float squared_range)
                 {
                   ASSERT_EQ(i, next++);
                   const ScanPoint& p = scan[i];
                   ASSERT_EQ(std::isnan(azimuth), !hasDirection(p)) << p.x << ' ' << p.y << ' ' << p.z;
                   if (!hasDirection(p)) return;
                   ASSERT_EQ(bitsOf(azimuth), bitsOf(fastAzimuth(p.x, p.y))) << p.x << ' ' << p.y;
                   ASSERT_EQ(bitsOf(squared_range), bitsOf(p.x * p.x + p.y * p.y + p.z * p.z));
                 });
  EXPECT_EQ(next, scan.size());
}

TEST(PointAzimuths, AreThoseOfEachPointToTheBit)
{
  std::mt19937 random(3);
  std::uniform_real_distribution<float> metres(-120.0F, 120.0F);
  std::vector<ScanPoint> scan(100000);
  for (ScanPoint& p : scan) p = {metres(random), metres(random), metres(random), 0.0F};
  expectAsOneByOne(scan);
}

TEST(PointAzimuths, OnTheAxesAndWithoutADirection)
{
  constexpr float kNaN = std::numeric_limits<float>::quiet_NaN(), kInfinity = std::numeric_limits<float>::infinity();
  const float values[] = {0.0F, -0.0F, 1.0F, -1.0F, 3e-39F, 1e-30F, 1e18F, 3e19F, -3e38F, kNaN, kInfinity, -kInfinity};
  std::vector<ScanPoint> scan;
  for (const float x : values)
    for (const float y : values)
      for (const float z : values) scan.push_back({x, y, z, 0.0F});
  expectAsOneByOne(scan);
}

TEST(PointAzimuths, AnyNumberOfPoints)
{
  std::vector<ScanPoint> scan;
  for (int count = 0; count < 10; ++count)
  {
    expectAsOneByOne(scan);
    scan.push_back({1.0F + static_cast<float>(count), -2.0F, 0.5F, 0.0F});
  }
}
}  // namespace
}  // namespace lidar_panoptic_clustering

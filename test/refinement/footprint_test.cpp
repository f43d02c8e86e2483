#include "lidar_panoptic_clustering/geometry/footprint.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <random>
#include <vector>

namespace lidar_panoptic_clustering
{
namespace
{
/// Outlines of one to twelve points, some of them in one line, 0 to 4 m from the origin.
std::vector<Footprint> randomOutlines(unsigned count)
{
  std::mt19937 random(5);
  const auto upTo = [&random](float most) { return most * static_cast<float>(random() % 10000) / 10000.0F; };
  std::vector<Footprint> outlines(count);
  for (Footprint& outline : outlines)
  {
    const float x = upTo(4.0F) - 2.0F, y = upTo(4.0F) - 2.0F, size = upTo(1.5F);
    const bool is_line = random() % 4 == 0;
    for (auto k = 1 + random() % 12; k > 0; --k)
    {
      const float along = upTo(size);
      outline.add(x + along, y + (is_line ? 0.5F * along : upTo(size)));
    }
  }
  return outlines;
}

float squaredDistanceToSide(const PlanarPoint& a, const PlanarPoint& b, const PlanarPoint& p)
{
  const float dx = b.x - a.x, dy = b.y - a.y, squared = dx * dx + dy * dy;
  const float t = squared == 0.0F ? 0.0F : std::clamp(((p.x - a.x) * dx + (p.y - a.y) * dy) / squared, 0.0F, 1.0F);
  const float ex = a.x + t * dx - p.x, ey = a.y + t * dy - p.y;
  return ex * ex + ey * ey;
}

/// The least distance of any corner to any side of the other outline, which is the gap of outlines that do not overlap.
float cornersToSides(const Footprint& a, const Footprint& b)
{
  std::array<PlanarPoint, 8> p, q;
  const int m = a.corners(p), n = b.corners(q);
  float least = std::numeric_limits<float>::max();
  for (int i = 0; i < m; ++i)
    for (int j = 0; j < n; ++j)
    {
      least = std::min(least, squaredDistanceToSide(p[i], p[(i + 1) % m], q[j]));
      least = std::min(least, squaredDistanceToSide(q[j], q[(j + 1) % n], p[i]));
    }
  return least;
}

TEST(Footprint, GapIsThatOfTheNearestCornerAndSideOrNone)
{
  const auto outlines = randomOutlines(150);
  int apart = 0, overlapping = 0;
  for (const Footprint& a : outlines)
    for (const Footprint& b : outlines)
    {
      const Footprint::Gap gap = a.gapTo(b);
      const float expected = cornersToSides(a, b);
      if (gap.squaredDistance() == 0.0F && expected > 0.0F)
      {
        ++overlapping;
        EXPECT_TRUE(a.mayBeCloser(b, 1e-6F));
        continue;
      }
      ++apart;
      EXPECT_EQ(gap.squaredDistance(), expected);
    }
  EXPECT_GT(apart, 5000);
  EXPECT_GT(overlapping, 500);
}

TEST(Footprint, FitsWithAnotherAsTheOutlineOfBothFits)
{
  const auto outlines = randomOutlines(150);
  int fitting = 0, compared = 0;
  for (const Footprint& a : outlines)
    for (const Footprint& b : outlines)
      for (const float length : {0.3F, 1.0F, 2.0F, 3.5F})
        for (const float share : {0.4F, 1.0F})
        {
          Footprint both = a;
          both.add(b);
          const bool fits = both.fits(length, share * length);
          ASSERT_EQ(a.fitsWith(b, length, share * length), fits);
          ++compared;
          fitting += fits ? 1 : 0;
        }
  EXPECT_GT(fitting, compared / 20);
  EXPECT_LT(fitting, compared / 2);
}

TEST(Footprint, OfTwoIsThatOfAllTheirPoints)
{
  Footprint square, inside, beside, all;
  for (const float x : {0.0F, 2.0F})
    for (const float y : {0.0F, 2.0F}) square.add(x, y), all.add(x, y);
  inside.add(0.5F, 1.0F);
  beside.add(1.0F, 3.0F);
  all.add(1.0F, 3.0F);
  square.add(inside);
  EXPECT_EQ(square.maxY(), 2.0F);
  square.add(beside);
  std::array<PlanarPoint, 8> corners, expected;
  ASSERT_EQ(square.corners(corners), all.corners(expected));
  for (int k = 0; k < all.corners(expected); ++k)
  {
    EXPECT_EQ(corners[k].x, expected[k].x) << k;
    EXPECT_EQ(corners[k].y, expected[k].y) << k;
  }
}

TEST(Footprint, IsCrossedByWhatMeetsIt)
{
  Footprint square, line;
  for (const float x : {1.0F, 2.0F})
    for (const float y : {1.0F, 2.0F}) square.add(x, y);
  line.add(1.0F, 1.0F), line.add(1.0F, 3.0F);
  EXPECT_TRUE(square.isCrossedBy({0.0F, 1.5F}, {3.0F, 1.6F}));
  EXPECT_TRUE(square.isCrossedBy({1.2F, 1.2F}, {1.4F, 1.3F})) << "within";
  EXPECT_FALSE(square.isCrossedBy({0.0F, 2.5F}, {3.0F, 2.4F})) << "beside it";
  EXPECT_FALSE(square.isCrossedBy({0.0F, 2.5F}, {0.9F, 1.9F})) << "off its corner";
  EXPECT_TRUE(line.isCrossedBy({0.0F, 2.0F}, {2.0F, 2.1F}));
  EXPECT_FALSE(line.isCrossedBy({0.0F, 3.5F}, {2.0F, 3.4F}));
}
}  // namespace
}  // namespace lidar_panoptic_clustering

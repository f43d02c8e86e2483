#include "drawing/round_numbers.h"

#include <gtest/gtest.h>

#include <cmath>

namespace lidar_panoptic_clustering
{
TEST(RoundNumbers, steps)
{
  EXPECT_EQ(roundStep(100.0, 5), 20.0);
  EXPECT_EQ(roundStep(101.0, 5), 50.0);
  EXPECT_EQ(roundStep(80.0, 5), 20.0);
  EXPECT_EQ(roundStep(0.3, 3), 0.1);
  EXPECT_EQ(roundStep(32.0, 2), 20.0);
  EXPECT_EQ(roundStep(1e6, 2), 5e5);
  EXPECT_EQ(roundStep(0.0, 5), 1.0);
  EXPECT_EQ(roundStep(NAN, 5), 1.0);
}

TEST(RoundNumbers, stepsReachOverTheLengthAndAFinerOneDoesNot)
{
  for (const double length : {1e-4, 0.3, 1.0, 7.7, 1234.5})
    for (const int max_count : {2, 3, 5, 9})
    {
      const double step = roundStep(length, max_count);
      EXPECT_GE(step * max_count, length * (1.0 - 1e-9));
      EXPECT_LT(0.4 * step * max_count, length) << "the next finer one is 0.4 or 0.5 of it";
    }
}

TEST(RoundNumbers, labels)
{
  EXPECT_EQ(stepLabel(120000.0, 10000.0), "120,000");
  EXPECT_EQ(stepLabel(1234567.0, 1.0), "1,234,567");
  EXPECT_EQ(stepLabel(0.25, 0.05), "0.25");
  EXPECT_EQ(stepLabel(-1000.5, 0.5), "-1,000.5");
  EXPECT_EQ(stepLabel(-1e-20, 0.1), "0.0");
  EXPECT_EQ(stepLabel(999.0, 1.0), "999");
  EXPECT_EQ(roundNumber(1e6, 1), "1,000,000.0");
}
}  // namespace lidar_panoptic_clustering

#include "ros/stamp_matcher.h"

#include <gtest/gtest.h>

namespace lidar_panoptic_clustering
{
namespace
{
using Pair = StampMatcher<int>::Pair;

TEST(StampMatcher, takesTheNearestWithinTheTolerance)
{
  StampMatcher<int> matcher(10, 5);
  EXPECT_FALSE(matcher.addLeft(100, 1));
  EXPECT_FALSE(matcher.addLeft(108, 2));
  EXPECT_FALSE(matcher.addLeft(116, 3));
  EXPECT_FALSE(matcher.addRight(94, 10)) << "6 away";
  EXPECT_EQ(matcher.addRight(113, 11), (Pair{3, 11})) << "3 and 5 away";
  EXPECT_EQ(matcher.unmatchedLeft(), 2U) << "their labels cannot come any more";
  EXPECT_EQ(matcher.unmatchedRight(), 1U);
  EXPECT_EQ(matcher.waitingLeft(), 0U);
}

TEST(StampMatcher, takesTheOlderOfTwoEquallyNear)
{
  StampMatcher<int> matcher(10, 5);
  EXPECT_FALSE(matcher.addRight(104, 11));
  EXPECT_FALSE(matcher.addRight(100, 10));
  EXPECT_EQ(matcher.addLeft(102, 1), (Pair{1, 11}));
}

TEST(StampMatcher, toleranceIsInclusiveOnBothSidesAndNoneMeansTheSameStamp)
{
  StampMatcher<int> close(10, 1), exact(10);
  close.addLeft(100, 1);
  EXPECT_EQ(close.addRight(101, 2), (Pair{1, 2}));
  close.addLeft(100, 3);
  EXPECT_EQ(close.addRight(99, 4), (Pair{3, 4}));
  exact.addLeft(100, 1);
  EXPECT_FALSE(exact.addRight(101, 2));
  EXPECT_EQ(exact.waitingLeft(), 1U);
  EXPECT_EQ(exact.addRight(100, 3), (Pair{1, 3}));
}

TEST(StampMatcher, lateOnesAreMatchedAsLongAsTheirPartnerWaits)
{
  StampMatcher<int> matcher(3);
  for (int i = 0; i < 5; ++i) matcher.addLeft(static_cast<std::uint64_t>(i), i);
  EXPECT_EQ(matcher.waitingLeft(), 3U);
  EXPECT_EQ(matcher.unmatchedLeft(), 2U);
  EXPECT_FALSE(matcher.addRight(1, 11)) << "no longer there";
  EXPECT_EQ(matcher.addRight(2, 12), (Pair{2, 12}));
  EXPECT_EQ(matcher.addRight(3, 13), (Pair{3, 13}));
  EXPECT_EQ(matcher.waitingLeft(), 1U);
}
}  // namespace
}  // namespace lidar_panoptic_clustering

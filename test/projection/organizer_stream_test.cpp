// What an Organizer found holds for the stream: one bad scan is refused alone, ten in a row change it.
#include "lidar_panoptic_clustering/projection/organizer.h"
#include "synthetic_scans.h"

#include <gtest/gtest.h>

#include <set>

namespace lidar_panoptic_clustering
{
namespace
{
const std::vector<double> kVlp16 = {15, 13, 11, 9, 7, 5, 3, 1, -1, -3, -5, -7, -9, -11, -13, -15};

OrganizerConfig withoutLabels(const std::string& layout = "auto")
{
  OrganizerConfig config;
  config.layout = layout;
  config.labels = false;
  return config;
}

/// A sensor 1.8 m above a street; `channels` and so on as given.
SyntheticCloud cloudFrom(const SyntheticOrder& order, SyntheticLidar lidar = {kVlp16})
{
  lidar.firings = std::max(lidar.firings, 180U);
  return cloudOf(scanOf(lidar), order);
}

const SyntheticOrder kOrganized{Channels::kHighestFirst, Laid::kRingAfterRing, Declared::kRingsByFirings,
                                RingField::kNone};
const SyntheticOrder kByRing{Channels::kLowestFirst, Laid::kFiringAfterFiring, Declared::kOneRowDense,
                             RingField::kFromTheBottom};
const SyntheticOrder kTurned{Channels::kHighestFirst, Laid::kFiringAfterFiring, Declared::kFiringsByRings,
                             RingField::kNone};

class OrganizerStream : public testing::Test
{
protected:
  std::string send(const SyntheticCloud& cloud)
  {
    return errorOf([&] { organizer_.organize(cloud.message.view(), scan_); });
  }

  Organizer organizer_{withoutLabels()};
  OrganizedScan scan_;
};

TEST_F(OrganizerStream, OneBadScanIsRefusedAloneAndTenInARowAreTheNewStream)
{
  const auto good = cloudFrom(kOrganized), other = cloudFrom(kByRing);
  ASSERT_EQ(send(good), "");
  EXPECT_EQ(organizer_.found().change, 1U);
  const std::string before = describe(organizer_.found());
  EXPECT_EQ(before, "rows are rings, the highest first: 16 rows; no sensor file");
  EXPECT_EQ(send(other),
            "expected rows are rings, the highest first, as in the scans before, found points with the number of their "
            "ring, the lowest first; the stream is taken for that when 10 scans in a row are so");
  EXPECT_EQ(describe(organizer_.found()), before);
  ASSERT_EQ(send(good), "");
  for (int i = 0; i < 9; ++i) ASSERT_NE(send(other), "") << i;
  ASSERT_EQ(send(good), "") << "nine in a row change nothing";
  for (int i = 0; i < 9; ++i) ASSERT_NE(send(other), "") << i;
  EXPECT_EQ(organizer_.found().change, 1U);
  ASSERT_EQ(send(other), "");
  EXPECT_EQ(organizer_.found().change, 2U);
  EXPECT_EQ(describe(organizer_.found()),
            "points with the number of their ring, the lowest first: 16 rows x 256 columns; no sensor file");
  EXPECT_NE(send(good), "") << "and now that holds";
}

TEST_F(OrganizerStream, TurnedRowsAndColumnsAreRefusedAlone)
{
  ASSERT_EQ(send(cloudFrom(kOrganized)), "");
  EXPECT_NE(send(cloudFrom(kTurned)), "");
  ASSERT_EQ(send(cloudFrom(kOrganized)), "");
  EXPECT_EQ(scan_.image.cloud.height, 16U);
}

TEST_F(OrganizerStream, AnOrganisedCloudMayHaveAnotherSizeAtAnyTime)
{
  SyntheticLidar fine{kVlp16}, few{{10, 6, 2, -2, -6, -10, -14, -18}};
  fine.firings = 360;
  for (const SyntheticLidar& lidar : {SyntheticLidar{kVlp16}, fine, few, fine})
  {
    ASSERT_EQ(send(cloudFrom(kOrganized, lidar)), "");
    EXPECT_EQ(scan_.image.cloud.height, lidar.elevations_deg.size());
    EXPECT_EQ(scan_.image.cloud.width, std::max(180U, lidar.firings));
  }
}

TEST_F(OrganizerStream, BlindScansFollow)
{
  SyntheticOrder order = kTurned;
  const auto good = cloudFrom(order);
  SyntheticScan nothing = scanOf({kVlp16, 180});
  for (ScanPoint& p : nothing.points) p = {0.0F, 0.0F, 0.0F, 0.0F};
  ASSERT_EQ(send(good), "");
  for (int i = 0; i < 20; ++i) ASSERT_EQ(send(cloudOf(nothing, order)), "");
  EXPECT_EQ(scan_.image.cloud.height, 16U);
  EXPECT_EQ(organizer_.found().change, 1U);
}

/// In the open only what looks down returns: eight of sixteen beams.
TEST_F(OrganizerStream, RowsDoNotFollowWhatReturns)
{
  SyntheticLidar open{{-1, -3, -5, -7, -9, -11, -13, -15}};
  const auto sky = cloudFrom(kByRing, open);  // its rings are 0 to 7, as those of a whole sensor would be
  ASSERT_EQ(send(sky), "");
  EXPECT_EQ(scan_.image.cloud.height, 16U) << "the nearest number of beams above";
  ASSERT_EQ(send(cloudFrom(kByRing)), "");
  EXPECT_EQ(scan_.image.cloud.height, 16U);
  EXPECT_EQ(organizer_.found().change, 1U);
  ASSERT_EQ(send(sky), "");
  EXPECT_EQ(scan_.image.cloud.height, 16U);

  // the beam of ring 7 has the same row in all of them
  for (std::size_t i = 0; i < sky.index.size(); ++i)
    ASSERT_EQ(scan_.image.pixel_of_point[i] / scan_.image.cloud.width, 8 + sky.index[i] / 180);
}

TEST_F(OrganizerStream, RowsGrowAndNeverShrink)
{
  std::vector<double> many;
  for (int i = 0; i < 60; ++i) many.push_back(12.0 - 0.5 * i);
  std::set<std::uint32_t> heights;
  ASSERT_EQ(send(cloudFrom(kByRing)), "");
  ASSERT_EQ(send(cloudFrom(kByRing, {many})), "");
  EXPECT_EQ(scan_.image.cloud.height, 64U);
  EXPECT_EQ(organizer_.found().change, 2U);
  EXPECT_EQ(organizer_.found().rows, 64U);
  ASSERT_EQ(send(cloudFrom(kByRing)), "");
  EXPECT_EQ(scan_.image.cloud.height, 64U);
}

TEST_F(OrganizerStream, KnownNumbersOfBeams)
{
  const std::vector<std::pair<std::uint32_t, std::uint32_t>> expected = {
      {0, 16}, {7, 16}, {15, 16}, {16, 32}, {31, 32}, {32, 40}, {40, 64}, {63, 64}, {64, 80}, {80, 128}, {128, 129}};
  for (const auto& [highest, beams] : expected) EXPECT_EQ(RowFinder::beamsOf(highest), beams) << highest;
}

TEST_F(OrganizerStream, RobosenseRowsAreSortedByElevation)
{
  for (const auto declared : {Declared::kRingsByFirings, Declared::kFiringsByRings})
    for (const auto laid : {Laid::kRingAfterRing, Laid::kFiringAfterFiring})
    {
      const SyntheticScan scan = scanOf({kVlp16, 180});
      const auto cloud = cloudOf(scan, {Channels::kRoboSense, laid, declared, RingField::kNone});
      Organizer organizer{withoutLabels()};
      ASSERT_EQ(errorOf([&] { organizer.organize(cloud.message.view(), scan_); }), "");
      EXPECT_EQ(organizer.found().line_order, LineOrder::kAsFired);
      EXPECT_EQ(organizer.found().reshaped, (declared == Declared::kRingsByFirings) != (laid == Laid::kRingAfterRing));
      ASSERT_EQ(scan_.image.cloud.height, 16U);
      for (std::size_t i = 0; i < cloud.index.size(); ++i)
        ASSERT_EQ(scan_.image.pixel_of_point[i], cloud.index[i]) << "the pixel of the sorted scan";
      // and the next scan goes the same way, by the sample alone
      ASSERT_EQ(errorOf([&] { organizer.organize(cloud.message.view(), scan_); }), "");
      EXPECT_EQ(scan_.image.pixel_of_point.back(), cloud.index.back());
    }
}

/// Nearly as many rows as columns: laid the other way, a row would hold one ring and a bit of the next.
TEST_F(OrganizerStream, ASectorWithNearlyAsManyFiringsAsRings)
{
  SyntheticLidar lidar;
  for (int i = 0; i < 64; ++i) lidar.elevations_deg.push_back(16.0 - 0.5 * i);
  lidar.firings = 60, lidar.field_of_view_deg = 30.0, lidar.start_deg = 15.0;
  const SyntheticScan scan = scanOf(lidar);
  for (const auto declared : {Declared::kRingsByFirings, Declared::kFiringsByRings})
    for (const auto laid : {Laid::kRingAfterRing, Laid::kFiringAfterFiring})
    {
      const auto cloud = cloudOf(scan, {Channels::kHighestFirst, laid, declared, RingField::kNone});
      Organizer organizer{withoutLabels()};
      ASSERT_EQ(errorOf([&] { organizer.organize(cloud.message.view(), scan_); }), "");
      EXPECT_EQ(scan_.image.cloud.height, 64U);
      EXPECT_EQ(figuresOf(scan_, cloud, scan).right_rows, 1.0);
    }
}

TEST_F(OrganizerStream, RingsInEitherSenseFromAnyAzimuth)
{
  for (const bool clockwise : {false, true})
    for (int start = -180; start < 180; start += 15)
    {
      SyntheticLidar lidar{kVlp16, 512};
      lidar.clockwise = clockwise, lidar.start_deg = start;
      const SyntheticScan scan = scanOf(lidar);
      const auto cloud = cloudOf(scan, SyntheticOrder());
      ASSERT_EQ(send(cloud), "") << start;
      const ImageFigures figures = figuresOf(scan_, cloud, scan);
      EXPECT_GE(figures.right_rows, 0.99) << start << ' ' << clockwise;
      EXPECT_LE(figures.hidden, 0.01) << start << ' ' << clockwise;
      EXPECT_EQ(figures.columns, 512U);
    }
}

/// As of a driver that leaves out what did not return: told as what they are, never taken for rings. Each laser fires a
/// little later than the one before.
TEST_F(OrganizerStream, FiringsInOneRowAreNoRings)
{
  for (const auto channels : {Channels::kHighestFirst, Channels::kLowestFirst, Channels::kRoboSense})
    for (const auto declared : {Declared::kOneRowDense, Declared::kOneColumn})
      for (int start = -180; start < 180; start += 15)
      {
        SyntheticLidar lidar{kVlp16, 512};
        lidar.start_deg = start;
        const SyntheticScan scan = scanOf(lidar);
        auto cloud = cloudOf(scan, {channels, Laid::kFiringAfterFiring, declared, RingField::kNone});
        const auto sequence = channelsOf(channels, scan.rows);
        for (std::uint32_t i = 0; i < cloud.index.size(); ++i)
        {
          const ScanPoint& p = scan.points[cloud.index[i]];
          const auto place = std::find(sequence.begin(), sequence.end(), cloud.index[i] / scan.firings);
          const double turned = -2.0 * M_PI / 512 * static_cast<double>(place - sequence.begin()) / 16;
          const auto [sine, cosine] = std::make_pair(std::sin(turned), std::cos(turned));
          const bool row = cloud.message.header.height == 1;
          cloud.message.setPoint(row ? 0 : i, row ? i : 0, static_cast<float>(cosine * p.x - sine * p.y),
                                 static_cast<float>(sine * p.x + cosine * p.y), p.z);
        }
        EXPECT_NE(send(cloud).find(declared == Declared::kOneColumn ? "found one column, firing after firing, of 8192"
                                                                    : "found one row, firing after firing, of "),
                  std::string::npos)
            << start;
      }
}

TEST_F(OrganizerStream, RingLayoutWithoutTheFieldTakesOnlyVerifiedRows)
{
  Organizer organizer{withoutLabels("ring")};
  ASSERT_EQ(errorOf([&] { organizer.organize(cloudFrom(kOrganized).message.view(), scan_); }), "");
  EXPECT_EQ(describe(organizer.found()),
            "no field ring, the cloud's rows are rings, the highest first: 16 rows x 256 columns; no sensor file");
  SyntheticOrder mixed = kOrganized;
  mixed.laid = Laid::kShuffled;
  Organizer other{withoutLabels("ring")};
  const std::string error = errorOf([&] { other.organize(cloudFrom(mixed).message.view(), scan_); });
  EXPECT_NE(error.find("expected points of one ring to have one elevation, found"), std::string::npos) << error;
}

TEST_F(OrganizerStream, AFieldRingThatHoldsSomethingElseIsRefused)
{
  auto cloud = cloudFrom(kByRing);
  std::mt19937 random(1);
  for (std::uint32_t i = 0; i < cloud.message.header.width; ++i)
    cloud.message.set(0, i, "ring", static_cast<double>(random() % 16));
  const std::string error = send(cloud);
  EXPECT_NE(error.find("expected points of one ring to have one elevation, found that it varies by"), std::string::npos)
      << error;
}

TEST_F(OrganizerStream, EmptyCloudsWithAnyLayout)
{
  for (const std::string& layout : layoutNames())
    for (const auto& [height, width] : std::vector<std::pair<std::uint32_t, std::uint32_t>>{{0, 0}, {16, 0}, {0, 16}})
    {
      if (layout == "beams") continue;
      std::uint32_t step = 0;
      auto fields =
          packed({{"x", NumberType::kFloat32}, {"y", NumberType::kFloat32}, {"z", NumberType::kFloat32}}, step);
      fields.push_back(rawField("ring", step++, NumberType::kUint8));
      const RawMessage message(height, width, fields, step);
      Organizer organizer{withoutLabels(layout)};
      EXPECT_EQ(errorOf([&] { organizer.organize(message.view(), scan_); }), "") << layout << height << width;
      EXPECT_TRUE(scan_.points.empty());
    }
}

/// Two returns a beam lie in one direction: not a contradiction, though half of them are hidden.
TEST_F(OrganizerStream, DualReturnsHideEachOtherByRight)
{
  SyntheticScan scan = scanOf({kVlp16, 180});
  auto single = cloudOf(scan, kByRing);
  RawMessage dual(1, 2 * single.message.header.width, single.message.header.fields, single.message.header.point_step);
  const std::size_t step = dual.header.point_step;
  for (std::size_t i = 0; i < single.index.size(); ++i)
    for (std::size_t k = 0; k < 2; ++k)
    {
      std::memcpy(&dual.bytes[(2 * i + k) * step], &single.message.bytes[i * step], step);
      const ScanPoint& p = scan.points[single.index[i]];
      if (k == 1) dual.setPoint(0, 2 * i + 1, 1.3F * p.x, 1.3F * p.y, 1.3F * p.z);
    }
  EXPECT_EQ(errorOf([&] { organizer_.organize(dual.view(), scan_); }), "");

  // two lidars a metre apart with one numbering of rings are no scan of one
  for (std::size_t i = 0; i < single.index.size(); ++i)
  {
    const ScanPoint& p = scan.points[single.index[(i + single.index.size() / 3) % single.index.size()]];
    dual.setPoint(0, 2 * i + 1, p.y, p.x + 1.0F, p.z);
  }
  Organizer other{withoutLabels()};
  EXPECT_NE(errorOf([&] { other.organize(dual.view(), scan_); }), "");
}
}  // namespace
}  // namespace lidar_panoptic_clustering

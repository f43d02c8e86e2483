// The organizer on recorded scans: files unfolded, clouds staggered.
#include "lidar_panoptic_clustering/datasets/semantic_kitti.h"
#include "lidar_panoptic_clustering/projection/original_labeller.h"
#include "recorded_data.h"
#include "recorded_message.h"
#include "scan_fixture.h"
#include "unordered_clouds.h"

#include <gtest/gtest.h>

#include <cmath>

namespace lidar_panoptic_clustering
{
namespace
{
constexpr auto kF32 = NumberType::kFloat32;

/// A scan of the data set as one row of x y z intensity float32 and label uint16.
RawMessage kittiMessage(const std::vector<ScanPoint>& points, const std::vector<std::uint32_t>& labels)
{
  std::uint32_t step = 0;
  auto fields =
      packed({{"x", kF32}, {"y", kF32}, {"z", kF32}, {"intensity", kF32}, {"label", NumberType::kUint16}}, step);
  RawMessage message(1, static_cast<std::uint32_t>(points.size()), fields, step);
  for (std::size_t i = 0; i < points.size(); ++i)
  {
    std::memcpy(&message.bytes[i * step], &points[i], sizeof(ScanPoint));
    message.set(0, i, "label", labels[i] & 0xFFFFU);
  }
  return message;
}

template <class Visit>
void forEachScan(const std::string& folder, Visit visit)
{
  std::vector<ScanPoint> points;
  std::vector<std::uint32_t> labels;
  for (const auto& name : semanticKittiSequences(folder + "/semantickitti"))
  {
    const SemanticKittiSequence sequence(folder + "/semantickitti", name);
    for (std::size_t i = 0; i < sequence.size(); ++i)
    {
      sequence.readScan(i, points);
      sequence.readLabels(i, points.size(), labels);
      visit(points, labels);
    }
  }
}

std::size_t hiddenPoints(const Projection& image)
{
  std::size_t hidden = image.pixel_of_point.size();
  for (const std::uint32_t owner : image.owner_of_pixel) hidden -= owner != Projection::kNone;
  return hidden;
}

/// Points that share their pixel with a nearer one in a spherical projection: HDL-64E, 3 to -25 deg, as RangeNet++
/// does.
std::size_t hiddenBySphericalProjection(const std::vector<ScanPoint>& points)
{
  constexpr int kRows = 64, kColumns = 2048;
  std::vector<bool> taken(std::size_t{kRows} * kColumns, false);
  std::size_t hidden = 0;
  for (const ScanPoint& p : points)
  {
    const double azimuth = std::atan2(p.y, p.x), elevation = std::atan2(p.z, std::hypot(p.x, p.y)) * 180.0 / M_PI;
    const int column = std::min(kColumns - 1, static_cast<int>((M_PI - azimuth) / (2.0 * M_PI) * kColumns));
    const int row = std::clamp(static_cast<int>((3.0 - elevation) / 28.0 * kRows), 0, kRows - 1);
    auto pixel = taken[static_cast<std::size_t>(row) * kColumns + static_cast<std::size_t>(column)];
    hidden += pixel;
    pixel = true;
  }
  return hidden;
}

TEST(OrganizerRecorded, UnfoldedFilesHideAtMostTwoPercentAt4096Columns)
{
  REQUIRE_RECORDED_DATA(folder);
  OrganizerConfig config;
  config.columns = 4096;
  Organizer organizer(config), by_itself{OrganizerConfig()};
  OrganizedScan scan;
  std::size_t points = 0, hidden = 0, spherical = 0;
  forEachScan(folder,
              [&](const std::vector<ScanPoint>& sent, const std::vector<std::uint32_t>& labels)
              {
                const auto message = kittiMessage(sent, labels);
                organizer.organize(message.view(), scan);
                ASSERT_EQ(scan.layout, Layout::kUnfold);
                ASSERT_EQ(scan.image.cloud.height, 64U);
                ASSERT_EQ(scan.image.begin.back(), sent.size()) << "every point is in the map";
                std::vector<int> seen(sent.size(), 0);
                for (const std::uint32_t point : scan.image.points) ++seen[point];
                for (const int times : seen) ASSERT_EQ(times, 1);
                const std::size_t hidden_here = hiddenPoints(scan.image);
                EXPECT_LE(hidden_here, sent.size() / 50);
                points += sent.size(), hidden += hidden_here, spherical += hiddenBySphericalProjection(sent);

                by_itself.organize(message.view(), scan);
                EXPECT_EQ(scan.image.cloud.width, 2048U);
                EXPECT_EQ(scan.image.cloud.height, 64U);
              });
  ASSERT_GT(points, 0U);
  RecordProperty("hidden_permille", static_cast<int>(1000 * hidden / points));
  RecordProperty("spherical_permille", static_cast<int>(1000 * spherical / points));
  EXPECT_GT(spherical, 5 * hidden) << "of a 64 x 2048 spherical projection";
}

TEST(OrganizerRecorded, UnfoldsAsThePointProjectorDoes)
{
  REQUIRE_RECORDED_DATA(folder);
  PointProjector projector{ProjectionConfig{}};
  Projection expected;
  OrganizedScan scan;
  OrganizerConfig config;
  config.columns = 2048;
  Organizer organizer(config);
  forEachScan(folder,
              [&](const std::vector<ScanPoint>& sent, const std::vector<std::uint32_t>& labels)
              {
                projector.project(sent, labels, expected);
                organizer.organize(kittiMessage(sent, labels).view(), scan);
                ASSERT_EQ(scan.image.pixel_of_point, expected.pixel_of_point);
                ASSERT_EQ(scan.image.owner_of_pixel, expected.owner_of_pixel);
                for (std::size_t i = 0; i < expected.cloud.size(); ++i)
                  ASSERT_EQ(scan.image.cloud.points[i].label, expected.cloud.points[i].label);
              });
}

/// The beams' azimuths in each ring in turn rotated by as many columns, as an Ouster sends them with destaggering off:
/// `shifts` as in its metadata's pixel_shift_by_row.
RawMessage staggered(const RawMessage& message, const std::vector<int>& shifts)
{
  RawMessage result = message;
  const RawCloud& h = message.header;
  const int width = static_cast<int>(h.width);
  for (std::size_t row = 0; row < h.height; ++row)
    for (int column = 0; column < width; ++column)
    {
      const int to = (column - shifts[row % shifts.size()] + width) % width;
      std::memcpy(&result.bytes[row * h.row_step + static_cast<std::size_t>(to) * h.point_step],
                  &message.bytes[row * h.row_step + static_cast<std::size_t>(column) * h.point_step], h.point_step);
    }
  return result;
}

TEST(OrganizerRecorded, StaggeredColumnsAreRefusedAndRealOffsetsAreNot)
{
  REQUIRE_RECORDED_DATA(folder);
  for (const char* name : {"pandaset/0001.pcd", "pandaset/0002.pcd", "pandaset/0003.pcd", "ouster/os1_128_1024_0.pcd",
                           "ouster/os1_128_1024_1.pcd"})
  {
    const auto scan = recordedMessage(folder + "/" + name);
    EXPECT_EQ(errorOf([&] { organized(scan); }), "") << name;
    EXPECT_EQ(errorOf([&] { organized(transposed(scan)); }), "") << name;
  }
  // pixel_shift_by_row of OS1-128 (1024 columns), of a first-generation OS1-64 (1024), and of the latter with 512
  for (const auto& shifts : {std::vector<int>{12, 4, -4, -12}, {18, 12, 6, 0}, {9, 6, 3, 0}})
  {
    const auto scan = staggered(recordedMessage(folder + "/ouster/os1_128_1024_0.pcd"), shifts);
    for (const auto& message : {scan, transposed(scan)})
      EXPECT_NE(errorOf([&] { organized(message); }).find("switch on destaggering in the driver"), std::string::npos);
    OrganizerConfig config;
    config.layout = "ring";
    const auto by_ring = organized(scan, config);
    const auto expected = organized(recordedMessage(folder + "/ouster/os1_128_1024_0.pcd"), config);
    for (std::size_t i = 0; i < expected.image.cloud.size(); ++i)
      ASSERT_EQ(hasReturn(by_ring.image.cloud.points[i]), hasReturn(expected.image.cloud.points[i])) << i;
  }
}

TEST(OrganizerRecorded, RowZeroIsTheHighestBeamWhicheverComesFirst)
{
  REQUIRE_RECORDED_DATA(folder);
  for (const char* name : {"pandaset/0001.pcd", "ouster/os1_128_1024_0.pcd"})
  {
    const auto scan = recordedMessage(folder + "/" + name);
    const auto expected = organized(scan);
    const auto turned = upsideDown(scan);
    for (const auto& message : {turned, transposed(turned)})
    {
      const auto found = organized(message);
      ASSERT_EQ(found.image.cloud.height, expected.image.cloud.height);
      for (std::size_t i = 0; i < expected.image.cloud.size(); ++i)
        ASSERT_EQ(found.image.cloud.points[i].label, expected.image.cloud.points[i].label) << name << ' ' << i;
    }
  }
}
}  // namespace
}  // namespace lidar_panoptic_clustering

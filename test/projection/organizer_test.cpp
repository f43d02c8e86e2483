#include "lidar_panoptic_clustering/projection/organizer.h"

#include "lidar_panoptic_clustering/core/parameters.h"
#include "raw_message.h"
#include "recorded_data.h"
#include "recorded_message.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace lidar_panoptic_clustering
{
namespace
{
constexpr auto kF32 = NumberType::kFloat32;
constexpr auto kF64 = NumberType::kFloat64;
constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// A turn of a lidar whose beams are 2 degrees apart, walls at changing range; label = 100 row + column.
RawMessage syntheticScan(std::uint32_t rings, std::uint32_t firings, NumberType coordinates = kF32,
                         bool with_ring = false)
{
  std::uint32_t step = 0;
  auto fields = packed(
      {{"x", coordinates}, {"y", coordinates}, {"z", coordinates}, {"intensity", kF32}, {"label", NumberType::kUint16}},
      step);
  if (with_ring) fields.push_back(rawField("ring", step++, NumberType::kUint8));
  RawMessage message(rings, firings, fields, step);
  for (std::uint32_t r = 0; r < rings; ++r)
    for (std::uint32_t c = 0; c < firings; ++c)
    {
      const double azimuth = -2.0 * M_PI * c / firings, elevation = (rings / 2.0 - r) * 2.0 * M_PI / 180.0;
      const double range = c % 7 < 4 ? 12.0 + r : 30.0 - 10.0 * c / firings;
      message.setPoint(r, c, range * std::cos(elevation) * std::cos(azimuth),
                       range * std::cos(elevation) * std::sin(azimuth), range * std::sin(elevation));
      message.set(r, c, "intensity", 0.25 * c);
      message.set(r, c, "label", 100 * r + c);
      if (with_ring) message.set(r, c, "ring", rings - 1 - r);
    }
  return message;
}

OrganizedScan scanOf(const RawMessage& message, const OrganizerConfig& config = {})
{
  OrganizedScan scan;
  Organizer(config).organize(message.view(), scan);
  return scan;
}

LabelledCloud organize(const RawMessage& message, const OrganizerConfig& config = {})
{
  return scanOf(message, config).image.cloud;
}

LayoutProbe probe(const RawMessage& message, const std::string& ring_field = "")
{
  const RawCloud raw = message.view();
  LayoutProbe result;
  result.look(raw, findScanFields(raw, {"", "", ring_field}, false));
  return result;
}

std::optional<Orientation> orientationOf(const RawMessage& message)
{
  return probe(message).orientation();
}

/// The same scan without the ring's number.
RawMessage withoutRing(RawMessage message)
{
  for (auto& field : message.header.fields)
    if (field.name == "ring") field.name = "beam";
  return message;
}

/// Equal, where no return equals no return.
void expectSame(const LabelledCloud& a, const LabelledCloud& b)
{
  ASSERT_EQ(a.width, b.width);
  ASSERT_EQ(a.height, b.height);
  ASSERT_EQ(a.points.size(), b.points.size());
  for (std::size_t i = 0; i < a.points.size(); ++i)
  {
    const auto &p = a.points[i], &q = b.points[i];
    ASSERT_EQ(std::isnan(p.x), std::isnan(q.x)) << i;
    ASSERT_TRUE(std::isnan(p.x) || (p.x == q.x && p.y == q.y && p.z == q.z)) << i;
    ASSERT_TRUE(p.intensity == q.intensity || (std::isnan(p.intensity) && std::isnan(q.intensity))) << i;
    ASSERT_EQ(p.label, q.label) << i;
  }
}

TEST(Organizer, RowsBecomeRingsWhicheverWayTheyAreSent)
{
  for (const bool with_ring : {false, true})
    for (const auto type : {kF32, kF64})
      for (const std::uint32_t rings : {16U, 32U, 64U})
      {
        const auto scan = syntheticScan(rings, 90, type, with_ring);
        const auto cloud = organize(scan);
        ASSERT_EQ(cloud.height, rings);
        ASSERT_EQ(cloud.width, 90U);
        for (std::uint32_t r = 0; r < rings; ++r)
          for (std::uint32_t c = 0; c < 90; ++c)
          {
            ASSERT_EQ(cloud.at(c, r).label, 100 * r + c);
            ASSERT_EQ(cloud.at(c, r).intensity, 0.25F * static_cast<float>(c));
          }
        expectSame(organize(transposed(scan)), cloud);
      }
}

TEST(Organizer, MoreRingsThanFirings)  // a sector: the shape alone would mislead
{
  const auto scan = syntheticScan(64, 20);
  EXPECT_EQ(organize(scan).height, 64U);
  EXPECT_EQ(organize(transposed(scan)).height, 64U);
}

TEST(Organizer, OrientationCanBeSet)
{
  const auto scan = syntheticScan(16, 90);
  OrganizerConfig config;
  config.orientation = "rows_are_firings";
  EXPECT_EQ(organize(scan, config).height, 90U);
  config.orientation = "rows_are_rings";
  EXPECT_EQ(organize(transposed(scan), config).height, 90U);
  config.orientation = "sideways";
  EXPECT_EQ(errorOf([&] { Organizer organizer(config); }),
            "parameter 'orientation': expected one of 'auto' 'rows_are_rings' 'rows_are_firings', got 'sideways'");
}

/// All points at one elevation, so that only the ring tells.
TEST(Organizer, RingDecidesWhereGeometryCannot)
{
  auto scan = syntheticScan(16, 16, kF32, true);
  for (unsigned r = 0; r < 16; ++r)
    for (unsigned c = 0; c < 16; ++c) scan.setPoint(r, c, 1.0 + r, 1.0 + c, 0.0);
  EXPECT_EQ(orientationOf(scan), Orientation::kRowsAreRings);
  EXPECT_EQ(orientationOf(transposed(scan)), Orientation::kRowsAreFirings);
  EXPECT_EQ(orientationOf(withoutRing(scan)), std::nullopt);
}

TEST(Organizer, GeometryDecidesWhereRingIsTheSameEverywhere)
{
  auto scan = syntheticScan(16, 90, kF32, true);
  for (unsigned r = 0; r < 16; ++r)
    for (unsigned c = 0; c < 90; ++c) scan.set(r, c, "ring", 0);
  EXPECT_EQ(orientationOf(scan), Orientation::kRowsAreRings);
  EXPECT_EQ(orientationOf(transposed(scan)), Orientation::kRowsAreFirings);
}

TEST(Organizer, FewReturnsAmongManyPixelsDecide)
{
  auto scan = syntheticScan(64, 1024);
  for (unsigned r = 0; r < 64; ++r)
    for (unsigned c = 0; c < 1024; ++c)
      if (r < 20 || r > 28 || c < 500 || c > 508) scan.setPoint(r, c, kNaN, kNaN, kNaN);
  EXPECT_EQ(orientationOf(scan), Orientation::kRowsAreRings);
  EXPECT_EQ(orientationOf(transposed(scan)), Orientation::kRowsAreFirings);
}

TEST(Organizer, UndecidedScansFollowTheLastOneElseTheShape)
{
  auto sector = syntheticScan(64, 20);
  auto blind = sector;
  for (unsigned r = 0; r < 64; ++r)
    for (unsigned c = 0; c < 20; ++c) blind.setPoint(r, c, 0, 0, 0);
  EXPECT_EQ(orientationOf(blind), std::nullopt);

  Organizer organizer{OrganizerConfig()};
  OrganizedScan scan;
  organizer.organize(blind.view(), scan);
  EXPECT_EQ(scan.image.cloud.height, 20U);
  organizer.organize(sector.view(), scan);
  EXPECT_EQ(scan.image.cloud.height, 64U);
  organizer.organize(blind.view(), scan);
  EXPECT_EQ(scan.image.cloud.height, 64U);
}

TEST(Organizer, NoReturnsBecomeNaN)
{
  for (const auto type : {kF32, kF64})
  {
    auto scan = syntheticScan(16, 90, type);
    scan.setPoint(0, 0, 0, 0, 0);
    scan.setPoint(0, 1, kNaN, 1, 1);
    scan.setPoint(0, 2, 1, kInfinity, 1);
    scan.setPoint(0, 3, 1, 1, -kInfinity);
    scan.setPoint(0, 4, 0, 0, -0.0);
    scan.setPoint(0, 5, 0, 0, 1);  // is a return
    scan.setPoint(0, 6, 1e20, 0, 0);
    for (const auto& cloud : {organize(scan), organize(transposed(scan))})
    {
      ASSERT_EQ(cloud.height, 16U);
      for (int c = 0; c < 5; ++c)
      {
        const auto& p = cloud.at(c, 0);
        EXPECT_TRUE(std::isnan(p.x) && std::isnan(p.y) && std::isnan(p.z)) << c;
        EXPECT_EQ(p.label, static_cast<std::uint32_t>(c));
      }
      EXPECT_EQ(cloud.at(5, 0).z, 1.0F);
      EXPECT_EQ(cloud.at(6, 0).x, 1e20F);
      EXPECT_FALSE(cloud.is_dense);
    }
  }
}

TEST(Organizer, FieldsHaveConfigurableNames)
{
  auto scan = syntheticScan(16, 90);
  scan.header.fields[3].name = "gain";
  scan.header.fields[4].name = "kind";
  OrganizerConfig config;
  config.label_field = "kind";
  EXPECT_EQ(organize(scan, config).at(3, 2).label, 203U);
  EXPECT_EQ(organize(scan, config).at(3, 2).intensity, 0.0F);
  config.intensity_field = "gain";
  EXPECT_EQ(organize(scan, config).at(3, 2).intensity, 0.75F);
  config.ring_field = "beam";
  EXPECT_EQ(errorOf([&] { organize(scan, config); }),
            "expected a field 'beam' with ring numbers (named by the parameter ring_field), found x float32, y "
            "float32, z float32, gain float32, kind uint16");
}

TEST(Organizer, FieldsAreFoundByTheirUsualNames)
{
  for (const char* label : {"label", "class_id", "semantic", "class"})
    for (const char* intensity :
         {"intensity", "reflectivity", "remission", "i", "intensities", "Intensity", "reflectance"})
    {
      auto scan = syntheticScan(16, 90);
      scan.header.fields[3].name = intensity;
      scan.header.fields[4].name = label;
      EXPECT_EQ(organize(scan).at(3, 2).label, 203U) << label;
      EXPECT_EQ(organize(scan).at(3, 2).intensity, 0.75F) << intensity;
    }
}

TEST(Organizer, ParametersAreListed)
{
  std::vector<std::string> names;
  for (const auto& info : describeParameters(OrganizerConfig{})) names.push_back(info.name);
  EXPECT_EQ(names, (std::vector<std::string>{"layout", "orientation", "sensor", "columns", "label_field",
                                             "intensity_field", "ring_field"}));

  OrganizerConfig config;
  applyParameters(config, {{"orientation", std::string("rows_are_firings")}, {"label_field", std::string("class_id")}});
  EXPECT_EQ(config.orientation, "rows_are_firings");
  EXPECT_EQ(config.label_field, "class_id");
  EXPECT_NE(errorOf([&] { applyParameters(config, {{"orientation", std::string("sideways")}}); }), "");
}

TEST(Organizer, RefusesCloudsWithoutLabels)
{
  auto scan = syntheticScan(16, 90);
  scan.header.fields.pop_back();
  EXPECT_EQ(errorOf([&] { organize(scan); }),
            "expected a field 'label', 'class_id', 'semantic', 'class' or one named by the parameter label_field, with "
            "class ids, found x float32, y float32, z float32, intensity float32");
  OrganizerConfig config;
  config.labels = false;
  EXPECT_EQ(organize(scan, config).at(3, 2).label, 0U);
}

TEST(Organizer, LivesOnAfterABadCloud)
{
  Organizer organizer{OrganizerConfig()};
  OrganizedScan cloud;
  const auto good = syntheticScan(16, 90);
  auto bad = good;
  bad.bytes.pop_back();
  EXPECT_EQ(errorOf([&] { organizer.organize(bad.view(), cloud); }),
            "expected data of height * row_step = 16 * 1620 bytes, found 25919 bytes");
  bad = good;
  bad.header.fields[0].offset = 17;
  EXPECT_NE(errorOf([&] { organizer.organize(bad.view(), cloud); }), "");
  organizer.organize(good.view(), cloud);
  expectSame(cloud.image.cloud, organize(good));
}

TEST(Organizer, SmallestClouds)
{
  auto scan = syntheticScan(16, 0);
  EXPECT_EQ(organize(scan).points.size(), 0U);
  EXPECT_EQ(organize(transposed(scan)).points.size(), 0U);
  EXPECT_EQ(organize(syntheticScan(1, 1)).points.size(), 1U);
  EXPECT_EQ(organize(syntheticScan(2, 1)).points.size(), 2U);
  OrganizerConfig config;
  config.orientation = "rows_are_rings";
  EXPECT_EQ(organize(syntheticScan(90, 1), config).height, 90U) << "a single firing";
  EXPECT_EQ(organize(syntheticScan(1, 90)).width, 90U) << "a sensor of one scan line";
  EXPECT_EQ(organize(transposed(syntheticScan(1, 90))).width, 90U);
}

TEST(OrganizerRecorded, FindsTheOrientationOfDriversClouds)
{
  REQUIRE_RECORDED_DATA(folder);
  for (const char* name : {"pandaset/0001.pcd", "pandaset/0002.pcd", "pandaset/0003.pcd", "ouster/os1_128_1024_0.pcd",
                           "ouster/os1_128_1024_1.pcd"})
  {
    const auto scan = recordedMessage(folder + "/" + name);
    const auto turned = transposed(scan);
    for (const bool with_ring : {true, false})
    {
      EXPECT_EQ(orientationOf(with_ring ? scan : withoutRing(scan)), Orientation::kRowsAreRings) << name;
      EXPECT_EQ(orientationOf(with_ring ? turned : withoutRing(turned)), Orientation::kRowsAreFirings) << name;
    }
    const auto cloud = organize(scan);
    EXPECT_EQ(cloud.height, scan.header.height) << name;
    EXPECT_EQ(cloud.points[12345].label, 12345U % 251) << name;
    expectSame(organize(turned), cloud);
  }
}
}  // namespace
}  // namespace lidar_panoptic_clustering

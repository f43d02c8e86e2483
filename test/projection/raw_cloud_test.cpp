#include "lidar_panoptic_clustering/projection/raw_cloud.h"

#include "raw_message.h"

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

void expectSimple(const LabelledCloud& cloud)
{
  ASSERT_EQ(cloud.height, 2U);
  ASSERT_EQ(cloud.width, 3U);
  ASSERT_EQ(cloud.points.size(), 6U);
  EXPECT_FALSE(cloud.is_dense);
  for (unsigned r = 0; r < 2; ++r)
    for (unsigned c = 0; c < 3; ++c)
    {
      const auto& p = cloud.points[r * 3 + c];
      EXPECT_EQ(p.x, 10.0F * static_cast<float>(r) + static_cast<float>(c));
      EXPECT_EQ(p.y, 0.5F);
      EXPECT_EQ(p.z, -1.0F);
      EXPECT_EQ(p.intensity, 0.0F);
      EXPECT_EQ(p.label, r + c);
    }
}

LabelledCloud readSimple(const RawCloud& raw)
{
  LabelledCloud cloud;
  readLabelled(raw, LabelledFields(), cloud);
  return cloud;
}

TEST(RawCloud, ReadsPackedPoints)
{
  expectSimple(readSimple(simpleMessage().view()));
}

TEST(RawCloud, ReadsPaddedRows)
{
  expectSimple(readSimple(simpleMessage(5).view()));
  expectSimple(readSimple(simpleMessage(4096).view()));
}

TEST(RawCloud, ReusedCloudKeepsNothing)
{
  LabelledCloud cloud;
  cloud.points.resize(100);
  cloud.is_dense = true;
  for (auto& p : cloud.points) p.intensity = 7.0F, p.label = 9;
  readLabelled(simpleMessage().view(), LabelledFields(), cloud);
  expectSimple(cloud);
}

/// As velodyne_pointcloud packs its points (22 bytes), with a label added at an odd offset by a semantic node.
TEST(RawCloud, ReadsVelodynePointsWithByteLabel)
{
  std::uint32_t step = 0;
  const auto fields = packed({{"x", kF32},
                              {"y", kF32},
                              {"z", kF32},
                              {"intensity", kF32},
                              {"ring", NumberType::kUint16},
                              {"time", kF32},
                              {"confidence", NumberType::kUint8},
                              {"label", NumberType::kUint8}},
                             step);
  ASSERT_EQ(fields[5].offset + 4, 22U);
  ASSERT_EQ(fields.back().offset % 2, 1U);
  RawMessage message(1, 2, fields, step);
  message.setPoint(0, 1, 1.5, -2.5, 3.5);
  message.set(0, 1, "intensity", 42.0);
  message.set(0, 1, "label", 252);
  const auto p = readSimple(message.view()).points[1];
  EXPECT_EQ(p.x, 1.5F);
  EXPECT_EQ(p.y, -2.5F);
  EXPECT_EQ(p.z, 3.5F);
  EXPECT_EQ(p.intensity, 42.0F);
  EXPECT_EQ(p.label, 252U);
}

TEST(RawCloud, ReadsDoublesUnderOtherNamesInAnyOrder)
{
  std::uint32_t step = 0;
  const auto fields = packed(
      {{"class_id", NumberType::kInt16}, {"Z", kF64}, {"Y", kF64}, {"X", kF64}, {"reflectivity", NumberType::kUint16}},
      step);
  RawMessage message(1, 1, fields, step);
  message.set(0, 0, "X", 0.1);
  message.set(0, 0, "Y", 1e300);
  message.set(0, 0, "Z", -1e300);
  message.set(0, 0, "class_id", -3);
  message.set(0, 0, "reflectivity", 65535);
  LabelledCloud cloud;
  readLabelled(message.view(), {"X", "Y", "Z", "reflectivity", "class_id"}, cloud);
  EXPECT_EQ(cloud.points[0].x, 0.1F);
  EXPECT_EQ(cloud.points[0].y, std::numeric_limits<float>::infinity());
  EXPECT_EQ(cloud.points[0].z, -std::numeric_limits<float>::infinity());
  EXPECT_EQ(cloud.points[0].label, kUnreadableLabel);
  EXPECT_EQ(cloud.points[0].intensity, 65535.0F);
}

TEST(RawCloud, TransposesAcrossBlockBorders)
{
  std::uint32_t step = 0;
  const auto fields = packed({{"x", kF32}, {"y", kF32}, {"z", kF32}, {"label", NumberType::kUint16}}, step);
  for (const std::uint32_t rows : {1U, 15U, 16U, 17U, 600U})
    for (const std::uint32_t columns : {1U, 3U, 300U})
    {
      RawMessage message(rows, columns, fields, step, 3);
      for (unsigned r = 0; r < rows; ++r)
        for (unsigned c = 0; c < columns; ++c)
        {
          message.setPoint(r, c, r, c, 0.0);
          message.set(r, c, "label", r + c);
        }
      LabelledCloud cloud;
      readLabelled(message.view(), LabelledFields(), cloud, RowOrder::kTransposed);
      ASSERT_EQ(cloud.height, columns);
      ASSERT_EQ(cloud.width, rows);
      for (unsigned r = 0; r < rows; ++r)
        for (unsigned c = 0; c < columns; ++c)
        {
          const auto& p = cloud.points[c * rows + r];
          ASSERT_EQ(p.x, static_cast<float>(r));
          ASSERT_EQ(p.y, static_cast<float>(c));
          ASSERT_EQ(p.label, r + c);
        }
    }
}

std::uint32_t idOf(NumberType type, double value)
{
  RawMessage message(1, 1, {rawField("label", 1, type)}, 9);
  message.set(0, 0, "label", value);
  const RawCloud raw = message.view();
  std::uint32_t id = 0;
  readIds({raw.data, raw.point_step, 1}, raw.fields[0], &id, sizeof(id));
  return id;
}

float floatOf(NumberType type, double value)
{
  RawMessage message(1, 1, {rawField("x", 1, type)}, 9);
  message.set(0, 0, "x", value);
  const RawCloud raw = message.view();
  float number = 0;
  readFloats({raw.data, raw.point_step, 1}, raw.fields[0], &number, sizeof(number));
  return number;
}

TEST(RawCloud, ReadsIdsOfEveryType)
{
  for (int code = 1; code <= 8; ++code) EXPECT_EQ(idOf(static_cast<NumberType>(code), 99), 99U) << code;
  EXPECT_EQ(idOf(NumberType::kUint8, 255), 255U);
  EXPECT_EQ(idOf(NumberType::kUint16, 65535), 65535U);
  EXPECT_EQ(idOf(NumberType::kInt32, 2147483647), 2147483647U);
  EXPECT_EQ(idOf(NumberType::kUint32, 4294967294.0), 4294967294U);
  EXPECT_EQ(idOf(kF32, 16777216.0), 16777216U);
  EXPECT_EQ(idOf(kF64, 4294967294.0), 4294967294U);
  EXPECT_EQ(idOf(kF64, -0.0), 0U);
}

TEST(RawCloud, WhatIsNoIdIsUnreadable)
{
  for (const auto type : {NumberType::kInt8, NumberType::kInt16, NumberType::kInt32, kF32, kF64})
    EXPECT_EQ(idOf(type, -1), kUnreadableLabel) << static_cast<int>(type);
  for (const auto type : {kF32, kF64})
    for (const double value : {kNaN, kInfinity, -kInfinity, 0.5, -0.5, 4294967296.0, 1e30, -1e30})
      EXPECT_EQ(idOf(type, value), kUnreadableLabel) << value;
  EXPECT_EQ(idOf(kF64, 1e300), kUnreadableLabel);
}

TEST(RawCloud, ReadsFloatsOfEveryType)
{
  for (int code = 1; code <= 8; ++code) EXPECT_EQ(floatOf(static_cast<NumberType>(code), 17), 17.0F) << code;
  for (const auto type : {NumberType::kInt8, NumberType::kInt16, NumberType::kInt32, kF32, kF64})
    EXPECT_EQ(floatOf(type, -17), -17.0F) << static_cast<int>(type);
  EXPECT_EQ(floatOf(kF64, 1.0 / 3.0), 1.0F / 3.0F);
  EXPECT_TRUE(std::isnan(floatOf(kF64, kNaN)));
  EXPECT_EQ(floatOf(kF64, kInfinity), std::numeric_limits<float>::infinity());
}

TEST(RawCloud, ReadsPanopticPoints)
{
  std::uint32_t step = 0;
  const auto fields = packed(
      {{"x", kF32}, {"y", kF32}, {"z", kF32}, {"label", NumberType::kUint32}, {"instance", kF32}, {"rgb", kF32}}, step);
  RawMessage message(1, 2, fields, step);
  for (unsigned c = 0; c < 2; ++c)
  {
    message.setPoint(0, c, 1, 2, 3);
    message.set(0, c, "label", 10);
    message.set(0, c, "instance", c == 0 ? 7 : -7);
    const std::uint32_t color = 0x00123456;
    std::memcpy(&message.bytes[c * step + fields[5].offset], &color, sizeof(color));
  }
  PanopticCloud cloud;
  readPanoptic(message.view(), cloud);
  ASSERT_EQ(cloud.points.size(), 2U);
  EXPECT_EQ(cloud.points[0].label, 10U);
  EXPECT_EQ(cloud.points[0].instance, 7U);
  EXPECT_EQ(cloud.points[1].instance, 0U);
  EXPECT_EQ(cloud.points[0].rgb, 0x00123456U);

  message.header.fields[4].name = "object";
  EXPECT_EQ(errorOf([&] { readPanoptic(message.view(), cloud); }),
            "expected a field 'instance', found x float32, y float32, z float32, label uint32, object float32, "
            "rgb float32");
}

/// As another process of this package sends them: 32 bytes a point, what is no field of it undefined.
RawMessage messageAsInMemory(std::uint32_t intensity_offset, std::uint32_t label_offset, std::uint32_t row_padding)
{
  RawMessage message(
      2, 300,
      {rawField("x", 0, kF32), rawField("y", 4, kF32), rawField("z", 8, kF32),
       rawField("intensity", intensity_offset, kF32), rawField("label", label_offset, NumberType::kUint32),
       rawField("instance", 24, NumberType::kUint32), rawField("rgb", 28, NumberType::kUint32)},
      32, row_padding);
  for (unsigned r = 0; r < 2; ++r)
    for (unsigned c = 0; c < 300; ++c)
    {
      message.setPoint(r, c, c, r, -1);
      message.set(r, c, "intensity", 0.5 * c);
      message.set(r, c, "label", 2.0 * c + r);
      message.set(r, c, "instance", c == 299 ? 4294967295.0 : 3.0 * c);  // the last one is no instance
      message.set(r, c, "rgb", 5.0 * c);
    }
  return message;
}

template <class Cloud>
void expectAsInMemory(const Cloud& cloud)
{
  ASSERT_EQ(cloud.points.size(), 600U);
  for (unsigned r = 0; r < 2; ++r)
    for (unsigned c = 0; c < 300; ++c)
    {
      const auto& p = cloud.points[r * 300 + c];
      EXPECT_EQ(p.getVector4fMap(), Eigen::Vector4f(static_cast<float>(c), static_cast<float>(r), -1.0F, 1.0F));
      EXPECT_EQ(p.intensity, 0.5F * static_cast<float>(c));
      EXPECT_EQ(p.label, 2 * c + r);
    }
}

TEST(RawCloud, ReadsPointsThatLieAsInMemoryOrNearlySo)
{
  for (const std::uint32_t padding : {0U, 7U})
    for (const auto& [intensity, label] : {std::pair(16U, 20U), std::pair(20U, 16U), std::pair(12U, 20U)})
    {
      SCOPED_TRACE(testing::Message() << padding << ' ' << intensity << ' ' << label);
      const auto message = messageAsInMemory(intensity, label, padding);
      expectAsInMemory(readSimple(message.view()));
      PanopticCloud cloud;
      readPanoptic(message.view(), cloud);
      expectAsInMemory(cloud);
      for (unsigned i = 0; i < 600; ++i)
      {
        const unsigned column = i % 300;
        EXPECT_EQ(cloud.points[i].instance, column == 299 ? 0 : 3 * column);
        EXPECT_EQ(cloud.points[i].rgb, 5 * column);
      }
      LabelledCloud turned;
      readLabelled(message.view(), LabelledFields(), turned, RowOrder::kTransposed);
      ASSERT_EQ(turned.points.size(), 600U);
      EXPECT_EQ(turned.points[2 * 7 + 1].label, 2 * 7 + 1U);
    }
}

TEST(RawCloud, EmptyCloudsKeepTheirShape)
{
  auto message = simpleMessage();
  message.bytes.clear();
  message.header.height = 0;
  auto cloud = readSimple(message.view());
  EXPECT_EQ(cloud.width, 3U);
  EXPECT_EQ(cloud.height, 0U);
  EXPECT_TRUE(cloud.points.empty());

  message.header.width = 0, message.header.height = 64, message.header.row_step = 0;
  cloud = readSimple(message.view());
  EXPECT_EQ(cloud.width, 0U);
  EXPECT_EQ(cloud.height, 64U);
}

}  // namespace
}  // namespace lidar_panoptic_clustering

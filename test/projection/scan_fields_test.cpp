#include "lidar_panoptic_clustering/projection/scan_fields.h"
#include "raw_message.h"

#include <gtest/gtest.h>

#include <vector>

namespace lidar_panoptic_clustering
{
namespace
{
constexpr auto kF32 = NumberType::kFloat32;

using FieldList = std::vector<std::pair<const char*, NumberType>>;

/// 300 points, more than are read in one go, whose fields lie one behind the other in the order given.
RawMessage messageOf(const FieldList& list)
{
  std::uint32_t step = 0;
  std::vector<RawField> fields;
  for (const auto& [name, type] : list)
  {
    fields.push_back(rawField(name, step, type));
    step += bytesOf(type);
  }
  RawMessage message(1, 300, fields, step);
  for (std::uint32_t i = 0; i < 300; ++i)
  {
    message.setPoint(0, i, i, -2.0 * i, 0.5 * i);
    if (findField(message.header, "intensity") != nullptr) message.set(0, i, "intensity", i % 200);
  }
  return message;
}

void expectPoints(const FieldList& list, bool has_intensity)
{
  const RawMessage message = messageOf(list);
  const RawCloud cloud = message.view();
  std::vector<ScanPoint> points(300, ScanPoint{7.0F, 7.0F, 7.0F, 7.0F});
  std::vector<std::uint32_t> labels(300, 7);
  readScan(cloud, findScanFields(cloud, FieldNames(), false), 0, 0, 300, points.data(), labels.data());
  for (std::uint32_t i = 0; i < 300; ++i)
  {
    const auto at = static_cast<float>(i);
    ASSERT_EQ(points[i].x, at);
    ASSERT_EQ(points[i].y, -2.0F * at);
    ASSERT_EQ(points[i].z, 0.5F * at);
    ASSERT_EQ(points[i].remission, has_intensity ? static_cast<float>(i % 200) : 0.0F);
    ASSERT_EQ(labels[i], 0U);
  }
}

TEST(ScanFields, CoordinatesInARowWithAnyIntensity)
{
  expectPoints({{"x", kF32}, {"y", kF32}, {"z", kF32}}, false);
  expectPoints({{"x", kF32}, {"y", kF32}, {"z", kF32}, {"intensity", kF32}}, true);
  expectPoints({{"intensity", kF32}, {"x", kF32}, {"y", kF32}, {"z", kF32}}, true);
  expectPoints({{"x", kF32}, {"y", kF32}, {"z", kF32}, {"intensity", NumberType::kUint8}}, true);
  expectPoints({{"intensity", NumberType::kUint16}, {"x", kF32}, {"y", kF32}, {"z", kF32}}, true);
}

TEST(ScanFields, CoordinatesInAnyOrderAndOfAnyType)
{
  expectPoints({{"y", kF32}, {"x", kF32}, {"z", kF32}, {"intensity", kF32}}, true);
  expectPoints({{"x", kF32}, {"intensity", kF32}, {"y", kF32}, {"z", kF32}}, true);
  expectPoints({{"z", kF32}, {"y", kF32}, {"x", kF32}}, false);
  expectPoints({{"x", NumberType::kFloat64}, {"y", NumberType::kFloat64}, {"z", NumberType::kFloat64}}, false);
}
}  // namespace
}  // namespace lidar_panoptic_clustering

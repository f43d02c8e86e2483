// The number type of the fields that addLabels() adds.
#include "raw_message.h"

#include "lidar_panoptic_clustering/projection/original_cloud.h"

#include <gtest/gtest.h>

#include <cstring>

namespace lidar_panoptic_clustering
{
namespace
{
using Ids = std::vector<std::uint32_t>;

float floatAt(const OriginalCloud& cloud, const RawField& field, std::size_t point)
{
  float value = 0.0F;
  std::memcpy(&value, &cloud.data[point * cloud.point_step + field.offset], sizeof(value));
  return value;
}

TEST(AddedFields, AreFloatsWhereFiltersWantThem)
{
  const RawMessage sent = simpleMessage();  // x y z float32, label uint32, 2 x 3
  OriginalCloud out;
  addLabels(sent.view(), {10, 40, 252, 0, 65535, kUnreadableLabel}, {1, 0, 2, 0, 16777216, 3}, out,
            AddedType::kFloat32);
  ASSERT_EQ(out.fields.size(), 6U);
  const RawField &label = out.fields[4], &instance = out.fields[5];
  EXPECT_EQ(label.name, "panoptic_label") << "the sender's own is no float32";
  EXPECT_EQ(instance.name, "instance");
  EXPECT_EQ(label.type(), NumberType::kFloat32);
  EXPECT_EQ(instance.type(), NumberType::kFloat32);
  const float expected[][2] = {{10, 1}, {40, 0}, {252, 2}, {0, 0}, {65535, 16777216}, {-1, 3}};
  for (std::size_t i = 0; i < 6; ++i)
  {
    EXPECT_EQ(floatAt(out, label, i), expected[i][0]) << i;
    EXPECT_EQ(floatAt(out, instance, i), expected[i][1]) << i;
  }
  EXPECT_EQ(errorOf([&] { addLabels(sent.view(), Ids(6, 1), Ids(6, 16777217), out, AddedType::kFloat32); }),
            "expected ids up to 16777216, which a float32 holds exactly, found 16777217");
}

TEST(AddedFields, OverwriteTheSendersOwnOfThatTypeOnly)
{
  std::uint32_t step = 0;
  constexpr auto kF32 = NumberType::kFloat32;
  const auto fields = packed({{"x", kF32}, {"y", kF32}, {"z", kF32}, {"label", kF32}}, step);
  const RawMessage sent(1, 2, fields, step);
  OriginalCloud as_float, as_uint32;
  addLabels(sent.view(), {10, 40}, {1, 0}, as_float, AddedType::kFloat32);
  addLabels(sent.view(), {10, 40}, {1, 0}, as_uint32);
  EXPECT_EQ(as_float.fields.size(), 5U);
  EXPECT_EQ(floatAt(as_float, as_float.fields[3], 1), 40.0F);
  ASSERT_EQ(as_uint32.fields.size(), 6U);
  EXPECT_EQ(as_uint32.fields[4].name, "panoptic_label");
  EXPECT_EQ(as_uint32.fields[4].type(), NumberType::kUint32);
}
}  // namespace
}  // namespace lidar_panoptic_clustering

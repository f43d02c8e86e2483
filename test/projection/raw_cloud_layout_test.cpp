#include "lidar_panoptic_clustering/projection/raw_cloud.h"

#include "raw_message.h"

#include <gtest/gtest.h>

#include <functional>

namespace lidar_panoptic_clustering
{
namespace
{
std::string errorOfReading(const RawCloud& raw)
{
  return errorOf(
      [&]
      {
        LabelledCloud cloud;
        readLabelled(raw, LabelledFields(), cloud);
      });
}

struct Malformation
{
  const char* name;
  std::function<void(RawMessage&)> apply;
  std::string message;
};

/// Applied to simpleMessage().
const std::vector<Malformation>& malformations()
{
  static const std::vector<Malformation> list = {
      {"DataShort", [](RawMessage& m) { m.bytes.pop_back(); },
       "expected data of height * row_step = 2 * 48 bytes, found 95 bytes"},
      {"DataLong", [](RawMessage& m) { m.bytes.push_back(0); },
       "expected data of height * row_step = 2 * 48 bytes, found 97 bytes"},
      {"NoData", [](RawMessage& m) { m.bytes.clear(); },
       "expected data of height * row_step = 2 * 48 bytes, found 0 bytes"},
      {"RowStepShort", [](RawMessage& m) { m.header.row_step = 47, m.bytes.resize(94); },
       "expected a row_step of at least width * point_step = 3 * 16 bytes, found 47 bytes"},
      {"PointStepZero", [](RawMessage& m) { m.header.point_step = 0; }, "expected a point_step above 0, found 0"},
      {"PointStepHuge", [](RawMessage& m) { m.header.point_step = 0xFFFFFFFF; },
       "expected a row_step of at least width * point_step = 3 * 4294967295 bytes, found 48 bytes"},
      {"WidthThatWouldOverflow",  // 2^28 * 16 = 2^32
       [](RawMessage& m) { m.header.width = 0x10000000, m.header.row_step = 0, m.bytes.clear(); },
       "expected a row_step of at least width * point_step = 268435456 * 16 bytes, found 0 bytes"},
      {"HeightThatWouldOverflow",  // 2^28 * 48 = 3 * 2^32
       [](RawMessage& m) { m.header.height = 0x10000000, m.bytes.clear(); },
       "expected data of height * row_step = 268435456 * 48 bytes, found 0 bytes"},
      {"EmptyButEndless",
       [](RawMessage& m) { m.header.width = 0, m.header.row_step = 0, m.header.height = 0xFFFFFFFF, m.bytes.clear(); },
       "expected at most 65536 rows or columns in an empty cloud, found 0 x 4294967295"},
      {"BigEndian", [](RawMessage& m) { m.header.is_bigendian = true; },
       "expected little-endian data, found is_bigendian = true"},
      {"OffsetOutside", [](RawMessage& m) { m.header.fields[0].offset = 13; },
       "expected field 'x' inside the point of 16 bytes, found 4 bytes at offset 13"},
      {"OffsetThatWouldOverflow", [](RawMessage& m) { m.header.fields[0].offset = 0xFFFFFFFE; },
       "expected field 'x' inside the point of 16 bytes, found 4 bytes at offset 4294967294"},
      {"CountOutside", [](RawMessage& m) { m.header.fields[3].count = 2; },
       "expected field 'label' inside the point of 16 bytes, found 8 bytes at offset 12"},
      {"CountThatWouldOverflow", [](RawMessage& m) { m.header.fields[3].count = 0x40000001; },
       "expected field 'label' inside the point of 16 bytes, found 4294967300 bytes at offset 12"},
      {"CountZero", [](RawMessage& m) { m.header.fields[1].count = 0; },
       "expected field 'y' with a count of at least 1, found count 0"},
      {"TypeZero", [](RawMessage& m) { m.header.fields[2].datatype = 0; },
       "expected field 'z' of a datatype from 1 (int8) to 8 (float64), found datatype 0"},
      {"TypeNine", [](RawMessage& m) { m.header.fields[2].datatype = 9; },
       "expected field 'z' of a datatype from 1 (int8) to 8 (float64), found datatype 9"},
      {"FieldMissing",
       [](RawMessage& m) {
         m.header.fields[3] = {"class", 12, 200, 3};
       },
       "expected a field 'label', found x float32, y float32, z float32, class datatype 200[3]"},
      {"NoFields", [](RawMessage& m) { m.header.fields.clear(); }, "expected a field 'x', found no fields"},
      {"BadIntensity",
       [](RawMessage& m) { m.header.fields.push_back(rawField("intensity", 16, NumberType::kFloat32)); },
       "expected field 'intensity' inside the point of 16 bytes, found 4 bytes at offset 16"},
  };
  return list;
}

class RawCloudMalformed : public testing::TestWithParam<Malformation>
{
};

TEST_P(RawCloudMalformed, IsRefusedWithExpectedAndFound)
{
  auto message = simpleMessage();
  GetParam().apply(message);
  EXPECT_EQ(errorOfReading(message.view()), GetParam().message);
}

INSTANTIATE_TEST_SUITE_P(All, RawCloudMalformed, testing::ValuesIn(malformations()),
                         [](const auto& test) { return std::string(test.param.name); });

TEST(RawCloudLayout, FieldsNobodyReadsMayBeOdd)
{
  auto message = simpleMessage();
  message.header.fields.push_back({"timestamp64", 1000, 77, 0});
  EXPECT_EQ(errorOfReading(message.view()), "");
}
}  // namespace
}  // namespace lidar_panoptic_clustering

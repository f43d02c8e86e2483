#include "raw_message.h"

#include "lidar_panoptic_clustering/projection/separate_labels.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <utility>

namespace lidar_panoptic_clustering
{
namespace
{
using Bytes = std::vector<std::uint8_t>;
using Labels = std::vector<std::uint32_t>;

/// Two rows of three pixels.
RawImage imageOf(const Bytes& bytes, const std::string& encoding, std::uint32_t step, bool is_bigendian = false)
{
  return {3, 2, step, is_bigendian, encoding, bytes.data(), bytes.size()};
}

Labels read(const RawImage& image)
{
  Labels labels;
  readLabelImage(image, 2, 3, labels);
  return labels;
}

std::string errorOfReading(const RawImage& image)
{
  return errorOf([&] { read(image); });
}

TEST(LabelImage, readsEightBitsWithPaddedRows)
{
  const Bytes bytes = {10, 252, 0, 99, 99, 40, 48, 255, 99, 99};
  for (const char* encoding : {"mono8", "8UC1"})
    EXPECT_EQ(read(imageOf(bytes, encoding, 5)), (Labels{10, 252, 0, 40, 48, 255})) << encoding;
}

TEST(LabelImage, readsSixteenBitsOfEitherByteOrder)
{
  const Bytes little = {10, 0, 252, 0, 0, 1, 40, 0, 48, 0, 0xFF, 0xFF};
  const Bytes big = {0, 10, 0, 252, 1, 0, 0, 40, 0, 48, 0xFF, 0xFF};
  for (const char* encoding : {"mono16", "16UC1"})
  {
    EXPECT_EQ(read(imageOf(little, encoding, 6)), (Labels{10, 252, 256, 40, 48, 65535})) << encoding;
    EXPECT_EQ(read(imageOf(big, encoding, 6, true)), (Labels{10, 252, 256, 40, 48, 65535})) << encoding;
  }
}

TEST(LabelImage, readsSignedIdsOfEitherByteOrder)
{
  const Bytes little = {10, 0, 0, 0, 0, 1, 0, 0, 0xFF, 0xFF, 0xFF, 0xFF, 1, 2, 3, 4, 0, 0, 0, 0x80, 7, 0, 0, 0};
  Bytes big;
  for (std::size_t i = 0; i < little.size(); ++i) big.push_back(little[i / 4 * 4 + 3 - i % 4]);
  const Labels expected = {10, 256, kUnreadableLabel, 0x04030201, kUnreadableLabel, 7};
  EXPECT_EQ(read(imageOf(little, "32SC1", 12)), expected);
  EXPECT_EQ(read(imageOf(big, "32SC1", 12, true)), expected);
}

/// The bytes of six numbers, and the same of the other byte order.
template <class T>
std::pair<Bytes, Bytes> bytesOf(const std::vector<T>& numbers)
{
  Bytes little(numbers.size() * sizeof(T)), big(little.size());
  std::memcpy(little.data(), numbers.data(), little.size());
  for (std::size_t i = 0; i < big.size(); ++i)
    big[i] = little[i / sizeof(T) * sizeof(T) + sizeof(T) - 1 - i % sizeof(T)];
  return {little, big};
}

template <class T>
void expectRead(const std::string& encoding, const std::vector<T>& numbers, const Labels& expected)
{
  const auto [little, big] = bytesOf(numbers);
  const auto step = static_cast<std::uint32_t>(3 * sizeof(T));
  EXPECT_EQ(read(imageOf(little, encoding, step)), expected) << encoding;
  EXPECT_EQ(read(imageOf(big, encoding, step, true)), expected) << encoding << ", big-endian";
}

TEST(LabelImage, readsEveryNumberType)
{
  const std::uint32_t none = kUnreadableLabel;
  expectRead<std::int8_t>("8SC1", {0, 1, 18, 127, -1, -128}, {0, 1, 18, 127, none, none});
  expectRead<std::int16_t>("16SC1", {0, 252, 259, 32767, -1, -100}, {0, 252, 259, 32767, none, none});
  expectRead<std::int32_t>("32SC1", {0, 252, 65546, 2147483647, -1, -100}, {0, 252, 65546, 2147483647, none, none});
  expectRead<float>("32FC1", {0.0F, 252.0F, 16777216.0F, 0.5F, -1.0F, NAN}, {0, 252, 16777216, none, none, none});
  expectRead<double>("64FC1", {0.0, 252.0, 4294967294.0, 0.5, -1.0, INFINITY}, {0, 252, 4294967294, none, none, none});
}

TEST(LabelImage, readsRowsLongerThanAPieceOfTheOtherByteOrder)
{
  std::vector<std::uint16_t> numbers(2 * 1000);
  for (std::size_t i = 0; i < numbers.size(); ++i) numbers[i] = static_cast<std::uint16_t>(31 * i);
  const Bytes big = bytesOf(numbers).second;
  const RawImage image{1000, 2, 2000, true, "mono16", big.data(), big.size()};
  Labels labels;
  readLabelImage(image, 2, 1000, labels);
  EXPECT_EQ(labels, Labels(numbers.begin(), numbers.end()));
}

TEST(LabelImage, ofAnotherSizeIsRefused)
{
  const Bytes bytes(6);
  RawImage image = imageOf(bytes, "mono8", 3);
  image.height = 1;
  image.data_size = 3;
  EXPECT_EQ(errorOfReading(image),
            "expected a label image of the range image's 2 rows x 3 columns, found 1 rows x 3 columns");
  image = imageOf(bytes, "mono8", 3);
  image.width = 2;
  EXPECT_EQ(errorOfReading(image),
            "expected a label image of the range image's 2 rows x 3 columns, found 2 rows x 2 columns");
}

TEST(LabelImage, ofAnotherEncodingIsRefused)
{
  const Bytes bytes(18);
  EXPECT_EQ(
      errorOfReading(imageOf(bytes, "rgb8", 9)),
      "expected a label image of encoding mono8, 8UC1, 8SC1, mono16, 16UC1, 16SC1, 32SC1, 32FC1, 64FC1, found 'rgb8'");
}

TEST(LabelImage, thatContradictsItselfIsRefused)
{
  const Bytes bytes(11);
  EXPECT_EQ(errorOfReading(imageOf(bytes, "mono16", 5)),
            "expected a label image whose step is at least 6 bytes, found 5");
  EXPECT_EQ(errorOfReading(imageOf(bytes, "mono16", 6)),
            "expected a label image with height * step = 12 bytes, found 11");
  RawImage huge = imageOf(bytes, "mono8", 0xFFFFFFFF);
  EXPECT_NE(errorOfReading(huge).find("found 11"), std::string::npos);
}

TEST(LabelImage, withoutPixelsIsFine)
{
  Labels labels(5);
  RawImage image;
  image.encoding = "mono8";
  readLabelImage(image, 0, 0, labels);
  EXPECT_TRUE(labels.empty());
}

TEST(LabelCloud, isReadInTheOrderOfTheCloud)
{
  const RawMessage cloud = simpleMessage(), padded = simpleMessage(5);
  Labels labels;
  readLabelCloud(padded.view(), "label", cloud.view(), labels);
  EXPECT_EQ(labels, (Labels{0, 1, 2, 1, 2, 3}));
  readLabelCloud(cloud.view(), "", padded.view(), labels);
  EXPECT_EQ(labels, (Labels{0, 1, 2, 1, 2, 3})) << "by its usual name";
  readLabelCloud(cloud.view(), "x", padded.view(), labels);
  EXPECT_EQ(labels, (Labels{0, 1, 2, 10, 11, 12}));
}

TEST(LabelCloud, mayHaveAllPointsInOneRow)
{
  const RawMessage cloud = simpleMessage();
  RawMessage flat = cloud;
  flat.header.width = 6, flat.header.height = 1, flat.header.row_step *= 2;
  Labels labels;
  readLabelCloud(flat.view(), "label", cloud.view(), labels);
  EXPECT_EQ(labels, (Labels{0, 1, 2, 1, 2, 3}));
}

TEST(LabelCloud, ofOtherPointsIsRefused)
{
  const RawMessage cloud = simpleMessage();
  Labels labels;
  EXPECT_EQ(errorOf([&] { readLabelCloud(transposed(cloud).view(), "label", cloud.view(), labels); }),
            "expected a label cloud with the cloud's points in the same order, 2 rows x 3 columns or all in one row, "
            "found 3 rows x 2 columns");
  EXPECT_EQ(errorOf([&] { readLabelCloud(cloud.view(), "class", cloud.view(), labels); }),
            "expected a field 'class' with class ids (named by the parameter label_field), found x float32, y float32, "
            "z float32, label uint32");
  RawMessage damaged = cloud;
  damaged.bytes.pop_back();
  EXPECT_NE(errorOf([&] { readLabelCloud(damaged.view(), "label", cloud.view(), labels); }), "");
}
}  // namespace
}  // namespace lidar_panoptic_clustering

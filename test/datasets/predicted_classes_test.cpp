// Prediction files in other numberings than the class table's, and of other number types.
#include "lidar_panoptic_clustering/datasets/predicted_classes.h"

#include "recorded_data.h"
#include "tiny_dataset.h"

#include <gtest/gtest.h>

namespace lidar_panoptic_clustering
{
namespace
{
template <class Call>
std::string errorOf(Call&& call)
{
  try
  {
    call();
    return "";
  }
  catch (const std::runtime_error& error)
  {
    return error.what();
  }
}

bool has(const std::string& text, const std::string& part)
{
  return text.find(part) != std::string::npos;
}

class Predictions : public testing::Test
{
protected:
  template <class T>
  void write(const std::vector<T>& labels)
  {
    for (int scan = 0; scan < 3; ++scan) writeFile(data_.file("predictions", scan, ".label"), labels);
  }
  SemanticKittiSequence open() const { return {data_.root_.string(), "07", data_.root_.string()}; }
  std::string errorOfReading(const std::string& label_table = "")
  {
    return errorOf(
        [&]
        {
          const PredictedClasses predicted(open(), kittiTable(), label_table);
          predicted.read(open(), 0, kScanPoints, labels_);
        });
  }

  TinyDataset data_{"predicted_classes"};
  std::vector<std::uint32_t> labels_;
};

/// A car in the first ring, then what is sent for road, and instances in the high half.
std::vector<std::uint32_t> numbered(std::uint32_t car, std::uint32_t road)
{
  std::vector<std::uint32_t> labels(kScanPoints, road);
  std::fill(labels.begin(), labels.begin() + 8, 3U << 16U | car);
  return labels;
}

TEST_F(Predictions, BecomeTheClassTablesIds)
{
  write(numbered(10, 40));
  EXPECT_EQ(errorOfReading(), "");
  EXPECT_EQ(labels_, numbered(10, 40));
  write(numbered(1, 9));
  EXPECT_EQ(errorOfReading("semantic_kitti_training"), "");
  EXPECT_EQ(labels_, numbered(10, 40));
  std::vector<std::uint32_t> less_one = numbered(0, 8);
  less_one[20] = 255, less_one[21] = 0xFFFFFFFFU;
  write(less_one);
  EXPECT_EQ(errorOfReading("semantic_kitti_training_less_one"), "");
  std::vector<std::uint32_t> expected = numbered(10, 40);
  expected[20] = expected[21] = 0;
  EXPECT_EQ(labels_, expected);
}

TEST_F(Predictions, OfAnotherNumberingAreRefusedWithTheTableThatFits)
{
  write(numbered(1, 9));
  const std::string error = errorOfReading();
  EXPECT_TRUE(has(error, "000000.label: expected class ids of the table 'semantic_kitti'")) << error;
  EXPECT_TRUE(has(error, "'semantic_kitti_training'")) << error;
}

TEST_F(Predictions, OneBadFileIsNamedWhenItIsRead)
{
  write(numbered(10, 40));
  writeFile(data_.file("predictions", 1, ".label"), numbered(10, 9));
  const PredictedClasses predicted(open(), kittiTable(), "");
  EXPECT_EQ(errorOf([&] { predicted.read(open(), 0, kScanPoints, labels_); }), "");
  const std::string error = errorOf([&] { predicted.read(open(), 1, kScanPoints, labels_); });
  EXPECT_TRUE(has(error, "000001.label: point 8 has class id 9, which is not in class table 'semantic_kitti'; all ids"))
      << error;
}

TEST_F(Predictions, OfFloatsAndOtherSizesAreNamed)
{
  std::vector<float> floats(kScanPoints, 40.0F);
  floats[0] = 0.0F, floats[1] = 10.0F;
  write(floats);
  EXPECT_TRUE(
      has(errorOfReading(), "000000.label: expected uint32 labels, found float32 numbers, the first of them 10"))
      << errorOfReading();
  write(std::vector<std::uint8_t>(kScanPoints, 40));
  EXPECT_TRUE(has(errorOfReading(), "found 24 bytes, as many as uint8 has")) << errorOfReading();
  write(std::vector<std::uint16_t>(kScanPoints, 40));
  EXPECT_TRUE(has(errorOfReading(), "as many as uint16 has")) << errorOfReading();
  write(std::vector<std::uint64_t>(kScanPoints, 40));
  EXPECT_TRUE(has(errorOfReading(), "as many as int64 has")) << errorOfReading();
  write(std::vector<std::uint32_t>(kScanPoints, 0));
  EXPECT_EQ(errorOfReading(), "") << "all of class 0 is no float";
}

TEST(RecordedPredictions, AreTakenForRawIdsWithoutDoubt)
{
  REQUIRE_RECORDED_DATA(data);
  const std::string root = data + "/semantickitti";
  for (const std::string& name : semanticKittiSequences(root))
    for (const char* network : {"mininet"})
    {
      const SemanticKittiSequence sequence(root, name, root + "/predictions/" + network);
      const PredictedClasses predicted(sequence, kittiTable(), "");
      EXPECT_EQ(predicted.doubt(), "") << name;
      EXPECT_NE(errorOf([&] { PredictedClasses(sequence, kittiTable(), "semantic_kitti_training"); }), "") << name;
    }
}
}  // namespace
}  // namespace lidar_panoptic_clustering

#include "lidar_panoptic_clustering/scan_to_objects/scan_to_objects.h"

#include "scan_fixture.h"
#include "unordered_clouds.h"

#include <gtest/gtest.h>

namespace lidar_panoptic_clustering
{
namespace
{
ScanToObjectsConfig configOf(const std::string& labels)
{
  ScanToObjectsConfig config;
  config.labeller.labels = labels;
  return config;
}

/// The pixels of `image` row after row, NaN where nothing returned, as a cloud of rows and columns.
RawMessage organisedMessage(const LabelledCloud& image)
{
  std::uint32_t step = 0;
  constexpr auto kF32 = NumberType::kFloat32;
  const auto fields = packed({{"x", kF32}, {"y", kF32}, {"z", kF32}, {"label", NumberType::kUint32}}, step);
  RawMessage message(image.height, image.width, fields, step);
  for (std::uint32_t row = 0; row < image.height; ++row)
    for (std::uint32_t column = 0; column < image.width; ++column)
    {
      const LabelledPoint& p = image.points[row * image.width + column];
      message.setPoint(row, column, p.x, p.y, p.z);
      message.set(row, column, "label", p.label);
    }
  return message;
}

TEST(ScanToObjects, isWhatTheStepsGiveOneByOne)
{
  const LabelledCloud street = simulatedScan("hdl64e");
  const RawMessage message = organisedMessage(street);
  for (const std::string& algorithm : algorithmNames())
  {
    ScanToObjectsConfig config = configOf("field");
    config.algorithm = algorithm;
    ScanToObjects chain(config);
    chain.process(message.view());

    const PanopticCloud expected = runAlgorithm(algorithm, street);
    ASSERT_EQ(chain.instanceIds().size(), street.size()) << algorithm;
    EXPECT_EQ(chain.instanceIds(), instancesOf(expected)) << algorithm;
    for (std::size_t i = 0; i < street.size(); ++i)
      ASSERT_EQ(chain.labels()[i], expected.points[i].label) << algorithm << " " << i;
    EXPECT_GT(chain.instances().count(), 5U) << algorithm;
    EXPECT_EQ(chain.boxes().size(), chain.instances().count()) << algorithm;
    EXPECT_EQ(chain.classTable().name(), "semantic_kitti") << algorithm;
  }
}

TEST(ScanToObjects, everyPointAsSentGetsItsInstance)
{
  const LabelledCloud street = simulatedScan("vlp16");
  const Order order = shuffled(returnsOf(street));
  ScanToObjects chain(configOf("field"));
  chain.process(oneRow(street, order, Rings::kFromTheBottom).view());
  ASSERT_EQ(chain.labels().size(), order.size());
  ASSERT_EQ(chain.instanceIds().size(), order.size());
  for (std::size_t i = 0; i < order.size(); ++i)
  {
    const bool thing = (*kittiTable())[kittiTable()->find(chain.labels()[i])].isThing();
    ASSERT_EQ(chain.instanceIds()[i] != 0, thing) << i;
  }
}

TEST(ScanToObjects, geometryGivesGroundStructureAndObjects)
{
  const LabelledCloud street = simulatedScan("hdl64e");
  ScanToObjects chain(configOf("none"));
  chain.process(organisedMessage(street).view());
  EXPECT_EQ(chain.classTable().name(), "object");
  const std::uint32_t ground = chain.classTable()[chain.classTable().findByName("ground")].ids.at(0);
  std::size_t road = 0, road_as_ground = 0;
  for (std::size_t i = 0; i < street.size(); ++i)
    if (hasReturn(street.points[i]) && street.points[i].label == kRoad)
    {
      ++road;
      road_as_ground += chain.labels()[i] == ground ? 1 : 0;
    }
  EXPECT_GT(road, 10000U);
  EXPECT_GT(road_as_ground, road * 9 / 10);
  EXPECT_GT(chain.instances().count(), 5U);
}

TEST(ScanToObjects, labelsMayComeInACloudOrAPictureOfTheirOwn)
{
  const LabelledCloud street = simulatedScan("os1_64");
  const RawMessage message = organisedMessage(street);
  ScanToObjects own(configOf("field")), cloud(configOf("cloud")), image(configOf("image"));
  own.process(message.view());
  cloud.process(message.view(), message.view());
  EXPECT_EQ(cloud.instanceIds(), own.instanceIds());
  EXPECT_EQ(cloud.labels(), own.labels());

  std::vector<std::uint16_t> pixels;
  for (const LabelledPoint& p : street.points) pixels.push_back(static_cast<std::uint16_t>(p.label));
  RawImage picture;
  picture.width = street.width, picture.height = street.height;
  picture.step = street.width * 2;
  picture.encoding = "mono16";
  picture.data = reinterpret_cast<const std::uint8_t*>(pixels.data());
  picture.data_size = pixels.size() * 2;
  image.process(message.view(), picture);
  EXPECT_EQ(image.instanceIds(), own.instanceIds());
  EXPECT_EQ(image.labels(), own.labels());
}

TEST(ScanToObjects, refusesLabelsFromElsewhereThanConfigured)
{
  const RawMessage message = simpleMessage();
  ScanToObjects field(configOf("field")), cloud(configOf("cloud"));
  EXPECT_EQ(errorOf([&] { field.process(message.view(), message.view()); }),
            "labels: expected 'cloud' for what was given, found 'field'");
  EXPECT_EQ(errorOf([&] { cloud.process(message.view()); }),
            "labels: expected 'field' for what was given, found 'cloud'");
  EXPECT_EQ(errorOf([&] { cloud.process(message.view(), RawImage{}); }),
            "labels: expected 'image' for what was given, found 'cloud'");
  EXPECT_NE(errorOf(
                []
                {
                  ScanToObjectsConfig config;
                  config.algorithm = "depht";
                  ScanToObjects chain(config);
                }),
            "");
}

TEST(ScanToObjects, anEmptyScanHasNoObjects)
{
  ScanToObjects chain(configOf("none"));
  EXPECT_EQ(chain.boxes().size(), 0U);
  const std::vector<ScanPoint> none;
  chain.process(viewOf(none));
  EXPECT_EQ(chain.labels().size(), 0U);
  EXPECT_EQ(chain.instances().count(), 0U);
}
}  // namespace
}  // namespace lidar_panoptic_clustering

// Labels of streams of clouds, as ScanToObjects takes them.
#include "lidar_panoptic_clustering/scan_to_objects/scan_to_objects.h"

#include "scan_fixture.h"
#include "unordered_clouds.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstdio>

namespace lidar_panoptic_clustering
{
namespace
{
ScanToObjectsConfig configOf(const std::string& labels, const std::string& label_table = "")
{
  ScanToObjectsConfig config;
  config.labeller.labels = labels;
  config.labeller.label_table = label_table;
  config.labeller.class_table = labels == "none" ? "" : "semantic_kitti";
  return config;
}

LabelledCloud numberedBy(const std::string& table, LabelledCloud scan)
{
  const ClassMapping mapping(*kittiTable(), ClassTable::load(table));
  for (LabelledPoint& p : scan.points) p.label = mapping(p.label);
  return scan;
}

RawMessage asSent(const LabelledCloud& scan)
{
  return oneRow(scan, byFiring(returnsOf(scan), scan.width), Rings::kFromTheTop);
}

TEST(ScanLabeller, TrainingIdsGiveTheObjectsOfRawIds)
{
  const LabelledCloud street = simulatedScan("vlp16");
  ScanToObjects raw(configOf("field")), training(configOf("field", "semantic_kitti_training")),
      less_one(configOf("field", "semantic_kitti_training_less_one"));
  raw.process(asSent(street).view());
  training.process(asSent(numberedBy("semantic_kitti_training", street)).view());
  less_one.process(asSent(numberedBy("semantic_kitti_training_less_one", street)).view());
  EXPECT_GT(raw.instances().count(), 5U);
  EXPECT_EQ(training.instanceIds(), raw.instanceIds());
  EXPECT_EQ(less_one.instanceIds(), raw.instanceIds());
  EXPECT_EQ(training.labels(), less_one.labels());
  const std::string error = errorOf(
      [&] { ScanToObjects(configOf("field")).process(asSent(numberedBy("semantic_kitti_training", street)).view()); });
  EXPECT_NE(error.find("'semantic_kitti_training'"), std::string::npos) << error;
}

TEST(ScanLabeller, OfALabelFileTheLowHalfIsTheClass)
{
  const LabelledCloud street = simulatedScan("vlp16");
  LabelledCloud packed = street;
  std::uint32_t instance = 0;
  for (LabelledPoint& p : packed.points) p.label |= ++instance % 40000 << 16U;
  ScanToObjects plain(configOf("field")), with_instances(configOf("field"));
  plain.process(asSent(street).view());
  with_instances.process(asSent(packed).view());
  EXPECT_EQ(with_instances.labels(), plain.labels());
  EXPECT_EQ(with_instances.instanceIds(), plain.instanceIds());
}

TEST(ScanLabeller, WhatIsNoReturnIsNoCarWhereZeroIsOne)
{
  LabelledCloud street = numberedBy("semantic_kitti_training_less_one", simulatedScan("vlp16"));
  Order all(street.size());
  std::iota(all.begin(), all.end(), 0U);
  std::size_t missing = 0;
  for (LabelledPoint& p : street.points)
    if (!hasReturn(p)) p.label = 0, ++missing;
  ASSERT_GT(missing, 1000U);
  ScanToObjects chain(configOf("field", "semantic_kitti_training_less_one"));
  chain.process(oneRow(street, byFiring(all, street.width), Rings::kFromTheTop).view());
  const Order order = byFiring(all, street.width);
  for (std::size_t i = 0; i < order.size(); ++i)
    ASSERT_TRUE(hasReturn(street.points[order[i]]) || chain.instanceIds()[i] == 0) << i;
}

using Box = std::array<float, 4>;  // least and largest x, then y

float lengthOf(const Box& box)
{
  return std::max(box[1] - box[0], box[3] - box[2]);
}

/// The extent of each id's points.
template <class IdOf>
std::map<std::uint32_t, Box> extents(const std::vector<ScanPoint>& points, IdOf id_of)
{
  std::map<std::uint32_t, Box> boxes;
  for (std::uint32_t i = 0; i < points.size(); ++i)
  {
    const std::uint32_t id = id_of(i);
    if (id == 0) continue;
    const ScanPoint& p = points[i];
    Box& box = boxes.emplace(id, Box{p.x, p.x, p.y, p.y}).first->second;
    box = {std::min(box[0], p.x), std::max(box[1], p.x), std::min(box[2], p.y), std::max(box[3], p.y)};
  }
  return boxes;
}

/// 2250 firings a turn in 2048 columns: a tenth of the returns are hidden. Whatever is behind an object is none of it.
TEST(ScanLabeller, NoObjectGrowsByWhatItHides)
{
  for (const char* sensor : {"hdl64e", "os1_64"})
    for (const std::string labels : {"none", "image"})
    {
      SensorModel model = SensorModel::load(sensor);
      model.columns = 2250;
      LidarSimulator simulator(model);
      PanopticCloud truth;
      simulator.scan(30, truth);
      LabelledCloud scan(truth.width, truth.height);
      for (std::size_t i = 0; i < truth.size(); ++i)
      {
        scan.points[i].getVector4fMap() = truth.points[i].getVector4fMap();
        scan.points[i].label = truth.points[i].label;
      }
      const RawMessage message = asSent(scan);
      ScanToObjectsConfig config = configOf(labels);
      config.organizer.columns = 2048;
      ScanToObjects chain(config);
      if (labels == "none")
      {
        chain.process(message.view());
      }
      else
      {
        OrganizerConfig organizer;
        organizer.columns = 2048;
        const OrganizedScan image = organized(message, organizer);
        std::vector<std::int32_t> pixels;
        for (const LabelledPoint& p : image.image.cloud.points) pixels.push_back(static_cast<std::int32_t>(p.label));
        RawImage picture;
        picture.width = image.image.cloud.width, picture.height = image.image.cloud.height;
        picture.step = picture.width * 4, picture.encoding = "32SC1";
        picture.data = reinterpret_cast<const std::uint8_t*>(pixels.data());
        picture.data_size = pixels.size() * 4;
        chain.process(message.view(), picture);
      }
      const OrganizedScan& scanned = chain.scan();
      const auto isShown = [&](std::uint32_t i)
      { return scanned.image.owner_of_pixel[scanned.image.pixel_of_point[i]] == i; };
      const auto& ids = chain.instanceIds();
      // the object of an instance is that of its first point shown; its own hidden points may reach farther
      const Order order = byFiring(returnsOf(scan), scan.width);
      std::map<std::uint32_t, std::uint32_t> object_of;
      for (std::uint32_t i = 0; i < ids.size(); ++i)
        if (isShown(i)) object_of.emplace(ids[i], truth.points[order[i]].instance);
      const auto isOwn = [&](std::uint32_t i)
      { return object_of.count(ids[i]) > 0 && truth.points[order[i]].instance == object_of[ids[i]]; };
      const auto grown = extents(scanned.points, [&](std::uint32_t i) { return ids[i]; });
      const auto shown = extents(scanned.points, [&](std::uint32_t i) { return isShown(i) || isOwn(i) ? ids[i] : 0U; });
      std::size_t hidden = 0, with_class = 0;
      for (std::uint32_t i = 0; i < ids.size(); ++i)
        if (!isShown(i)) ++hidden, with_class += chain.labels()[i] != 0 ? 1 : 0;
      float most = 0.0F;
      for (const auto& [id, box] : grown)
        if (shown.count(id) > 0) most = std::max(most, lengthOf(box) - lengthOf(shown.at(id)));
      std::printf("%s, %s: %zu objects, %zu of %zu hidden returns with a class, most growth %.3f m\n", sensor,
                  labels.c_str(), grown.size(), with_class, hidden, most);
      EXPECT_GT(hidden, ids.size() / 20);
      EXPECT_GT(with_class, hidden * 8 / 10);
      EXPECT_EQ(grown.size(), shown.size()) << "nothing hidden is an object of its own";
      EXPECT_LT(most, 0.2F);
    }
}
}  // namespace
}  // namespace lidar_panoptic_clustering

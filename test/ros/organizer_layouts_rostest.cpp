// Clouds as drivers publish them, through organizer and cluster nodelet and back.
#include "organizer_fixture.h"
#include "recorded_data.h"
#include "recorded_message.h"

#include <algorithm>
#include <map>

namespace lidar_panoptic_clustering
{
namespace
{
/// An organizer and a cluster nodelet, wired as sensor.launch does it.
class Chain
{
public:
  using Load = std::function<bool(const std::string&, const std::string&, const nodelet::M_string&)>;

  Chain(const Load& load, std::string organizer, const std::string& cluster_nodelet, const std::string& clusterer,
        bool separate_labels = false)
      : name(std::move(organizer)),
        panoptic(clusterer + "/output"),
        input(advertise<sensor_msgs::PointCloud2>(name + "/input"))
  {
    if (separate_labels) labels = advertise<sensor_msgs::Image>(name + "/label_input");
    EXPECT_TRUE(load(name, "OrganizerNodelet", {{name + "/panoptic", clusterer + "/output"}}));
    EXPECT_TRUE(load(clusterer, cluster_nodelet, {{clusterer + "/input", name + "/output"}}));
    original = std::make_unique<Probe<sensor_msgs::PointCloud2>>(name + "/output_original");
    waitForSubscriber(input);
    if (separate_labels) waitForSubscriber(labels);
    waitForListener(clusterer + "/output");  // one for both who listen: roscpp has one a topic and process
  }

  const std::string name;
  Probe<PanopticCloud> panoptic;
  ros::Publisher input, labels;
  std::unique_ptr<Probe<sensor_msgs::PointCloud2>> original;
};

class OrganizerLayouts : public Graph
{
protected:
  Chain makeChain(const std::string& cluster_nodelet, bool separate_labels = false)
  {
    return Chain([this](const auto& name, const auto& type, const auto& remappings)
                 { return tryLoad(name, type, remappings); },
                 name_, cluster_nodelet, newName(), separate_labels);
  }

  const std::string name_ = newName();
};

/// velodyne_pointcloud with organize_cloud: a row a firing, ring 0 the lowest beam, 22 bytes without gaps, NaN.
RawMessage fromVelodyneDriver(const LabelledCloud& scan)
{
  std::uint32_t step = 0;
  constexpr auto kF32 = NumberType::kFloat32;
  auto fields = packed(
      {{"x", kF32}, {"y", kF32}, {"z", kF32}, {"intensity", kF32}, {"ring", NumberType::kUint16}, {"time", kF32}},
      step);
  RawMessage raw(scan.width, scan.height, std::move(fields), step);
  for (std::uint32_t row = 0; row < scan.height; ++row)
    for (std::uint32_t column = 0; column < scan.width; ++column)
    {
      const LabelledPoint& p = scan.points[row * scan.width + column];
      const std::uint32_t ring = scan.height - 1 - row;
      raw.setPoint(column, ring, p.x, p.y, p.z);
      raw.set(column, ring, "intensity", 7.0);
      raw.set(column, ring, "ring", ring);
      raw.set(column, ring, "time", 1e-5 * column);
    }
  return raw;
}

/// ouster_ros: a row a ring from the highest, 48 bytes with gaps, zeros for no return.
RawMessage fromOusterDriver(const LabelledCloud& scan)
{
  const std::vector<RawField> fields = {
      rawField("x", 0, NumberType::kFloat32),    rawField("y", 4, NumberType::kFloat32),
      rawField("z", 8, NumberType::kFloat32),    rawField("intensity", 16, NumberType::kFloat32),
      rawField("t", 20, NumberType::kUint32),    rawField("reflectivity", 24, NumberType::kUint16),
      rawField("ring", 26, NumberType::kUint16), rawField("ambient", 28, NumberType::kUint16),
      rawField("range", 32, NumberType::kUint32)};
  RawMessage raw(scan.height, scan.width, fields, 48);
  for (std::uint32_t row = 0; row < scan.height; ++row)
    for (std::uint32_t column = 0; column < scan.width; ++column)
    {
      const LabelledPoint& p = scan.points[row * scan.width + column];
      const bool back = hasReturn(p);
      raw.setPoint(row, column, back ? p.x : 0.0, back ? p.y : 0.0, back ? p.z : 0.0);
      raw.set(row, column, "ring", row);
    }
  return raw;
}

/// Every point that is shown in the image has the instance of its pixel; `index` tells the point of a pixel.
template <class Index>
void expectInstances(const sensor_msgs::PointCloud2& back, const PanopticCloud& expected, Index index)
{
  const auto instance = idsIn(back, "instance"), label = idsIn(back, "label");
  ASSERT_EQ(instance.size(), expected.size());
  std::size_t things = 0;
  for (std::uint32_t row = 0; row < expected.height; ++row)
    for (std::uint32_t column = 0; column < expected.width; ++column)
    {
      const PanopticPoint& p = expected.points[row * expected.width + column];
      const std::size_t i = index(row, column);
      ASSERT_EQ(instance[i], p.instance) << row << ", " << column;
      if (std::isfinite(p.x))
      {
        ASSERT_EQ(label[i], p.label) << row << ", " << column;
      }
      things += p.instance > 0 ? 1 : 0;
    }
  EXPECT_GT(things, 100U);
}

TEST_F(OrganizerLayouts, VelodyneDriverIsTransposedAndBeginsAtTheLowestRing)
{
  const LabelledCloud scan = simulatedScan("vlp16");
  ros::param::set(name_ + "/labels", "image");
  const Chain chain = makeChain("ScanLineRunClusterNodelet", true);
  chain.input.publish(toRosMessage(fromVelodyneDriver(scan)));
  chain.labels.publish(labelImage<std::uint16_t>(scan, sensor_msgs::image_encodings::MONO16));
  const auto back = chain.original->next();
  ASSERT_TRUE(back);
  EXPECT_EQ(back->width, 16U);
  expectInstances(*back, runAlgorithm("scan_line_run", scan),
                  [&](std::uint32_t row, std::uint32_t column)
                  { return column * scan.height + (scan.height - 1 - row); });
}

TEST_F(OrganizerLayouts, OusterDriverHasRingsAndZeros)
{
  const LabelledCloud scan = simulatedScan("os1_128");
  ros::param::set(name_ + "/labels", "image");
  const Chain chain = makeChain("DepthClusterNodelet", true);
  chain.input.publish(toRosMessage(fromOusterDriver(scan)));
  chain.labels.publish(labelImage<std::uint16_t>(scan, sensor_msgs::image_encodings::MONO16));
  const auto back = chain.original->next();
  ASSERT_TRUE(back);
  EXPECT_EQ(back->point_step, 56U);
  expectInstances(*back, runAlgorithm("depth", scan),
                  [&](std::uint32_t row, std::uint32_t column) { return row * scan.width + column; });
}

TEST_F(OrganizerLayouts, EachCloudMayHaveAnotherResolutionAndTheTenthAnotherLayout)
{
  const Chain chain = makeChain("BirdsEyeClusterNodelet");
  const LabelledCloud vlp = simulatedScan("vlp16"), ouster = simulatedScan("os1_64"), scene = labelledScene();
  std::uint32_t second = 100;
  for (int pass = 0; pass < 2; ++pass)
  {
    for (const LabelledCloud& scan : {vlp, ouster, scene})
    {
      chain.input.publish(
          toRosMessage(laidOut(scan, pass == 0 ? kPlainLayout : kOddLayout), "lidar", ros::Time(++second)));
      const auto back = chain.original->next();
      ASSERT_TRUE(back);
      EXPECT_EQ(back->header.stamp, ros::Time(second));
      expectInstances(*back, runAlgorithm("birds_eye", scan),
                      [&](std::uint32_t row, std::uint32_t column) { return row * scan.width + column; });
    }
  }
  // the same sensor with its driver's organised output off: taken for the new stream when ten in a row are so
  const Order order = byFiring(returnsOf(vlp), vlp.width);
  const RawMessage one_row = oneRow(vlp, order, Rings::kFromTheBottom);
  for (int i = 0; i < 9; ++i)
  {
    chain.input.publish(toRosMessage(one_row, "lidar", ros::Time(++second)));
    ros::WallDuration(0.1).sleep();  // so that none is dropped
  }
  chain.input.publish(toRosMessage(one_row, "lidar", ros::Time(++second)));
  const auto back = chain.original->next();
  ASSERT_TRUE(back);
  EXPECT_EQ(back->header.stamp, ros::Time(second)) << "the nine before were refused";
  EXPECT_EQ(back->width, order.size());
  const auto instance = idsIn(*back, "instance"), label = idsIn(*back, "label");
  for (std::size_t i = 0; i < order.size(); ++i)
    EXPECT_EQ(instance[i] > 0, (*kittiTable())[kittiTable()->find(label[i])].isThing()) << i;
}

TEST_F(OrganizerLayouts, TwoSensorsInOneProcessDoNotDisturbEachOther)
{
  const auto load = [this](const auto& name, const auto& type, const auto& remappings)
  { return tryLoad(name, type, remappings); };
  const Chain roof(load, newName(), "BirdsEyeClusterNodelet", newName());
  const Chain bumper(load, newName(), "BirdsEyeClusterNodelet", newName());
  const LabelledCloud wide = simulatedScan("os1_64"), narrow = simulatedScan("vlp16");
  const PanopticCloud of_wide = runAlgorithm("birds_eye", wide), of_narrow = runAlgorithm("birds_eye", narrow);
  for (std::uint32_t frame = 0; frame < 5; ++frame)
  {
    roof.input.publish(toRosMessage(laidOut(wide, kOddLayout), "roof", ros::Time(100 + frame)));
    bumper.input.publish(toRosMessage(transposed(laidOut(narrow, kPlainLayout)), "bumper", ros::Time(100 + frame)));
    const auto from_roof = roof.original->next(), from_bumper = bumper.original->next();
    ASSERT_TRUE(from_roof && from_bumper);
    EXPECT_EQ(from_roof->header.frame_id, "roof");
    EXPECT_EQ(from_bumper->header.frame_id, "bumper");
    expectInstances(*from_roof, of_wide,
                    [&](std::uint32_t row, std::uint32_t column) { return row * wide.width + column; });
    expectInstances(*from_bumper, of_narrow,
                    [&](std::uint32_t row, std::uint32_t column) { return column * narrow.height + row; });
  }
}

/// Two lidars a metre apart in one cloud without an order.
RawMessage mergedCloud()
{
  LabelledCloud both = simulatedScan("vlp16"), other = both;
  for (LabelledPoint& p : other.points) p.y += 1.0F;
  both.points.insert(both.points.end(), other.points.begin(), other.points.end());
  both.height *= 2;
  return oneRow(both, shuffled(returnsOf(both)), Rings::kNone);
}

TEST_F(OrganizerLayouts, MergedLidarsAreClusteredByPointsAlone)
{
  ros::param::set(name_ + "/layout", "merged");
  const Chain chain = makeChain("BirdsEyeClusterNodelet");
  const RawMessage merged = mergedCloud();
  chain.input.publish(toRosMessage(merged));
  const auto back = chain.original->next();
  ASSERT_TRUE(back);
  EXPECT_EQ(back->width, merged.header.width);
  const auto instance = idsIn(*back, "instance"), label = idsIn(*back, "label");
  for (std::size_t i = 0; i < instance.size(); ++i)
    ASSERT_EQ(instance[i] > 0, (*kittiTable())[kittiTable()->find(label[i])].isThing()) << i;
}

TEST_F(OrganizerLayouts, MergedLidarsAreRefusedWhereScanLinesAreNeeded)
{
  ros::param::set(name_ + "/layout", "merged");
  LogProbe log;
  const Chain chain = makeChain("DepthClusterNodelet");
  chain.input.publish(toRosMessage(mergedCloud()));
  EXPECT_NE(log.waitFor("dropped: expected scan lines").find("birds_eye"), std::string::npos);
}

class RecordedSensors : public OrganizerLayouts
{
};

TEST_F(RecordedSensors, WithoutLabelsGiveObjectsOnTheGround)
{
  REQUIRE_RECORDED_DATA(data);
  ros::param::set(name_ + "/labels", "none");
  const std::string clusterer = newName();
  ros::param::set(clusterer + "/class_table", "object");
  Chain chain([this](const auto& name, const auto& type, const auto& remappings)
              { return tryLoad(name, type, remappings); },
              name_, "BirdsEyeClusterNodelet", clusterer);
  std::uint32_t second = 100;
  for (const std::string file : {"pandaset/0001.pcd", "pandaset/0002.pcd", "pandaset/0003.pcd",
                                 "ouster/os1_128_1024_0.pcd", "ouster/os1_128_1024_1.pcd"})
  {
    SCOPED_TRACE(file);
    const RawMessage recorded = recordedMessage(data + "/" + file);
    const auto sent = toRosMessage(recorded, "lidar", ros::Time(++second));
    chain.input.publish(sent);
    const auto panoptic = chain.panoptic.next();
    const auto back = chain.original->next();
    ASSERT_TRUE(panoptic && back);
    EXPECT_EQ(panoptic->width, sent->width);
    EXPECT_EQ(panoptic->height, sent->height);
    std::map<std::uint32_t, std::size_t> points_of_label;
    std::uint32_t instances = 0;
    std::size_t returns = 0;
    for (const auto& p : panoptic->points)
    {
      if (!std::isfinite(p.x)) continue;
      ++returns, ++points_of_label[p.label];
      instances = std::max(instances, p.instance);
    }
    std::cout << file << ": " << returns << " returns, ground " << points_of_label[1] << ", structure "
              << points_of_label[2] << ", objects " << points_of_label[3] << " in " << instances << " instances\n";
    EXPECT_GT(points_of_label[1], returns / 20);
    EXPECT_GT(points_of_label[2], returns / 20);
    EXPECT_GT(instances, 3U);
    EXPECT_LT(points_of_label[3], returns * 6 / 10);
    // the recorded cloud has a label of its own, of one byte, which stays
    const auto own = idsIn(*back, "label"), carried = idsIn(*back, "panoptic_label");
    EXPECT_EQ(own, idsIn(*sent, "label"));
    std::size_t ground = 0;
    for (const std::uint32_t label : carried) ground += label == 1 ? 1 : 0;
    EXPECT_EQ(ground, points_of_label[1]);
  }
}
}  // namespace
}  // namespace lidar_panoptic_clustering

int main(int argc, char** argv)
{
  return lidar_panoptic_clustering::runGraphTests(argc, argv, "organizer_layouts_test");
}

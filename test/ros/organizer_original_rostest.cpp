// The driver's own cloud comes back with labels and instances.
#include "organizer_fixture.h"

#include <algorithm>
#include <map>
#include <numeric>
#include <random>
#include <string>
#include <tuple>
#include <vector>

namespace lidar_panoptic_clustering
{
namespace
{
/// An organizer, the cluster nodelet behind it, and the way back.
class OriginalGraph : public OrganizerGraph
{
protected:
  void startWithClusterer(const std::string& labels = "field")
  {
    ASSERT_TRUE(tryLoad(clusterer_, "BirdsEyeClusterNodelet", {{clusterer_ + "/input", name_ + "/output"}}));
    set("labels", labels);
    input_ = advertise<sensor_msgs::PointCloud2>(name_ + "/input");
    if (labels == "image") labels_ = advertise<sensor_msgs::Image>(name_ + "/label_input");
    diagnostics_ = std::make_unique<DiagnosticsProbe>(name_);
    ASSERT_TRUE(tryLoad(name_, "OrganizerNodelet", {{name_ + "/panoptic", clusterer_ + "/output"}}));
    original_ = std::make_unique<Probe<sensor_msgs::PointCloud2>>(name_ + "/output_original");
    waitForSubscriber(input_);
    if (labels_) waitForSubscriber(labels_);
    waitForListener(clusterer_ + "/output");
    waitForListener(name_ + "/output");
  }

  /// An organizer whose instances come from the test.
  void startAlone()
  {
    panoptic_ = advertise<PanopticCloud>(name_ + "/panoptic");
    input_ = advertise<sensor_msgs::PointCloud2>(name_ + "/input");
    diagnostics_ = std::make_unique<DiagnosticsProbe>(name_);
    ASSERT_TRUE(tryLoad(name_, "OrganizerNodelet"));
    original_ = std::make_unique<Probe<sensor_msgs::PointCloud2>>(name_ + "/output_original");
    waitForSubscriber(input_);
    waitForSubscriber(panoptic_);
  }

  const std::string clusterer_ = newName();
  ros::Publisher panoptic_;
  std::unique_ptr<Probe<sensor_msgs::PointCloud2>> original_;
};

/// The scene as no other sensor sends it: a label of one byte first, float64 coordinates, bytes of no field, a field of
/// several elements, rows padded.
RawMessage oddMessage(const LabelledCloud& scene)
{
  const std::vector<RawField> fields = {
      rawField("class_id", 0, NumberType::kUint8), rawField("z", 3, NumberType::kFloat64),
      rawField("x", 11, NumberType::kFloat64),     rawField("y", 19, NumberType::kFloat64),
      rawField("t", 27, NumberType::kUint32),      rawField("echoes", 31, NumberType::kUint16, 3)};
  RawMessage raw(scene.height, scene.width, fields, 41, 7);
  std::uint32_t t = 0;
  for (std::uint32_t row = 0; row < scene.height; ++row)
    for (std::uint32_t column = 0; column < scene.width; ++column)
    {
      const LabelledPoint& p = scene.points[row * scene.width + column];
      raw.setPoint(row, column, p.x, p.y, p.z);
      raw.set(row, column, "class_id", p.label);
      raw.set(row, column, "t", t++ * 77777.0);
      raw.set(row, column, "echoes", t % 1000);
    }
  return raw;
}

/// All that `sent` says of its points, their bytes of no field included, is in `back`, and its header.
void expectSameBytes(const sensor_msgs::PointCloud2& back, const sensor_msgs::PointCloud2& sent)
{
  EXPECT_EQ(back.header.seq, sent.header.seq);
  EXPECT_EQ(back.header.stamp, sent.header.stamp);
  EXPECT_EQ(back.header.frame_id, sent.header.frame_id);
  EXPECT_EQ(back.is_dense, sent.is_dense);
  ASSERT_EQ(back.width, sent.width);
  ASSERT_EQ(back.height, sent.height);
  ASSERT_GE(back.fields.size(), sent.fields.size());
  for (std::size_t i = 0; i < sent.fields.size(); ++i)
  {
    EXPECT_EQ(back.fields[i].name, sent.fields[i].name);
    EXPECT_EQ(back.fields[i].offset, sent.fields[i].offset);
    EXPECT_EQ(back.fields[i].datatype, sent.fields[i].datatype);
    EXPECT_EQ(back.fields[i].count, sent.fields[i].count);
  }
  const RawCloud to = viewOf(back), from = viewOf(sent);
  checkLayout(to, {"label", "instance"});
  for (std::size_t row = 0; row < sent.height; ++row)
    for (std::size_t column = 0; column < sent.width; ++column)
      ASSERT_EQ(std::memcmp(to.point(row, column), from.point(row, column), sent.point_step), 0)
          << row << ", " << column;
}

TEST_F(OriginalGraph, ComesBackByteForByteWithLabelsAndInstances)
{
  startWithClusterer();
  const LabelledCloud scene = labelledScene();
  const PanopticCloud expected = runAlgorithm("birds_eye", scene);
  for (int frame = 0; frame < 3; ++frame)
  {
    const auto sent = toRosMessage(oddMessage(scene), "roof", ros::Time(1700000000 + frame, 123456789));
    sent->header.seq = 4711;
    sent->is_dense = true;
    input_.publish(sent);
    const auto back = original_->next();
    ASSERT_TRUE(back);
    expectSameBytes(*back, *sent);
    const auto label = idsIn(*back, "label"), instance = idsIn(*back, "instance");
    EXPECT_EQ(canonical(instance), canonical(instancesOf(expected)));
    for (std::size_t i = 0; i < scene.size(); ++i) ASSERT_EQ(label[i], expected.points[i].label) << i;
  }
}

TEST_F(OriginalGraph, CarriesTrackIdsThatStayWhereInstancesAreRenumbered)
{
  ASSERT_TRUE(tryLoad(clusterer_, "BirdsEyeClusterNodelet", {{clusterer_ + "/input", name_ + "/output"}}));
  const std::string tracker = newName();
  ros::param::set(tracker + "/fixed_frame", "");
  ASSERT_TRUE(tryLoad(tracker, "TrackerNodelet", {{tracker + "/input", clusterer_ + "/output"}}));
  set("labels", "field");
  set("lasting_ids", true);
  input_ = advertise<sensor_msgs::PointCloud2>(name_ + "/input");
  ASSERT_TRUE(tryLoad(name_, "OrganizerNodelet", {{name_ + "/panoptic", tracker + "/output"}}));
  original_ = std::make_unique<Probe<sensor_msgs::PointCloud2>>(name_ + "/output_original");
  waitForSubscriber(input_);
  for (const std::string& topic : {tracker + "/output", clusterer_ + "/output", name_ + "/output"})
    waitForListener(topic);

  LabelledCloud scene = labelledScene();
  LabelledCloud without_first = scene;
  const PanopticCloud whole = runAlgorithm("birds_eye", scene);
  for (std::size_t i = 0; i < scene.size(); ++i)
    if (whole.points[i].instance == 1) without_first.points[i].label = 40;  // road
  const PanopticCloud rest = runAlgorithm("birds_eye", without_first);

  std::vector<std::uint32_t> first, second;
  for (const auto& [cloud, ids, stamp_s] :
       {std::tuple(&scene, &first, 10.0), std::tuple(&without_first, &second, 10.1)})
  {
    input_.publish(toRosMessage(oddMessage(*cloud), "roof", ros::Time(stamp_s)));
    const auto back = original_->next();
    ASSERT_TRUE(back);
    *ids = idsIn(*back, "instance");
  }
  std::size_t renumbered = 0;
  for (std::size_t i = 0; i < scene.size(); ++i)
  {
    if (rest.points[i].instance == 0) continue;
    renumbered += whole.points[i].instance != rest.points[i].instance ? 1 : 0;
    ASSERT_GT(first[i], 0U) << i;
    ASSERT_EQ(second[i], first[i]) << i;
  }
  EXPECT_GT(renumbered, 0U);
}

TEST_F(OriginalGraph, TransposedCloudComesBackInItsOwnOrder)
{
  set("orientation", "rows_are_firings");
  startWithClusterer();
  const LabelledCloud scene = labelledScene();
  const PanopticCloud expected = runAlgorithm("birds_eye", scene);
  const auto sent = toRosMessage(transposed(oddMessage(scene)));
  input_.publish(sent);
  const auto back = original_->next();
  ASSERT_TRUE(back);
  expectSameBytes(*back, *sent);
  const auto instance = idsIn(*back, "instance");
  for (std::uint32_t row = 0; row < scene.height; ++row)
    for (std::uint32_t column = 0; column < scene.width; ++column)
      ASSERT_EQ(instance[column * scene.height + row], expected.points[row * scene.width + column].instance);
}

TEST_F(OriginalGraph, LabelsOfAnImageAndOfAnotherTableComeBackInTheTableClusteredWith)
{
  set("label_table", "nuscenes");
  set("class_table", "semantic_kitti");
  startWithClusterer("image");
  LabelledCloud cars = twoCars(2.0F), ids = cars;
  for (auto& p : ids.points) p.label = p.label == kCar ? 17 : 24;
  const auto sent = toRosMessage(withoutLabels(cars));
  input_.publish(sent);
  labels_.publish(labelImage(ids));
  const auto back = original_->next();
  ASSERT_TRUE(back);
  expectSameBytes(*back, *sent);
  const auto label = idsIn(*back, "label"), instance = idsIn(*back, "instance");
  for (std::size_t i = 0; i < cars.size(); ++i)
  {
    const bool car = hasReturn(cars.points[i]);
    EXPECT_EQ(instance[i], !car ? 0U : i % 64 > 30 ? instance[40] : instance[20]) << i;
    EXPECT_EQ(label[i], car ? kCar : kRoad) << i;
  }
  EXPECT_NE(instance[40], instance[20]);
}

/// The points of a scan in no order, every one sent twice, the second time 3 cm farther along its beam.
RawMessage shuffledTwice(const LabelledCloud& scan)
{
  std::vector<std::size_t> order(2 * scan.size());
  std::iota(order.begin(), order.end(), 0);
  std::shuffle(order.begin(), order.end(), std::mt19937(5));
  std::uint32_t step = 0;
  auto fields = packed({{"x", NumberType::kFloat32},
                        {"y", NumberType::kFloat32},
                        {"z", NumberType::kFloat32},
                        {"label", NumberType::kUint16},
                        {"ring", NumberType::kUint8}},
                       step);
  RawMessage raw(1, static_cast<std::uint32_t>(order.size()), std::move(fields), step);
  for (std::size_t i = 0; i < order.size(); ++i)
  {
    const std::size_t pixel = order[i] % scan.size();
    const LabelledPoint& p = scan.points[pixel];
    const double range = std::hypot(p.x, p.y, p.z);
    const double farther = order[i] < scan.size() ? 1.0 : 1.0 + 0.03 / range;
    raw.setPoint(0, i, p.x * farther, p.y * farther, p.z * farther);
    raw.set(0, i, "label", p.label);
    raw.set(0, i, "ring", static_cast<double>(pixel / scan.width));
  }
  return raw;
}

TEST_F(OriginalGraph, HiddenPointsOfAnUnorganisedCloudHaveTheInstanceOfTheirObject)
{
  set("columns", 64);
  startWithClusterer();
  const LabelledCloud cars = twoCars(3.0F);
  const auto sent = toRosMessage(shuffledTwice(cars));
  input_.publish(sent);
  const auto back = original_->next();
  ASSERT_TRUE(back);
  const auto instance = idsIn(*back, "instance");
  std::map<std::uint32_t, std::size_t> points_of_instance;
  const RawCloud cloud = viewOf(*sent);
  for (std::size_t i = 0; i < instance.size(); ++i)
  {
    float y = 0.0F;
    readFloats({cloud.point(0, i), cloud.point_step, 1}, *findField(cloud, "y"), &y, sizeof(y));
    if (std::isnan(y))
    {
      EXPECT_EQ(instance[i], 0U);
      continue;
    }
    EXPECT_EQ(instance[i] == 1, y > 2.0F) << "columns go clockwise: the car on the left comes first";
    ++points_of_instance[instance[i]];
  }
  EXPECT_EQ(points_of_instance.size(), 2U);
  EXPECT_EQ(points_of_instance[1], 32U);
  EXPECT_EQ(points_of_instance[2], 32U);
}

TEST_F(OriginalGraph, TakesInstancesOnlyWhileSomebodyListens)
{
  panoptic_ = advertise<PanopticCloud>(name_ + "/panoptic");
  input_ = advertise<sensor_msgs::PointCloud2>(name_ + "/input");
  ASSERT_TRUE(tryLoad(name_, "OrganizerNodelet"));
  Probe<LabelledCloud> output(name_ + "/output");
  waitForSubscriber(input_);
  EXPECT_EQ(panoptic_.getNumSubscribers(), 0U);
  {
    Probe<sensor_msgs::PointCloud2> original(name_ + "/output_original");
    waitForSubscriber(panoptic_);
  }
  EXPECT_TRUE(eventually([&] { return panoptic_.getNumSubscribers() == 0; }));
  EXPECT_EQ(input_.getNumSubscribers(), 1U);
}

TEST_F(OriginalGraph, InstancesFindTheirCloudByStampWhereOthersWereLeftOut)
{
  startAlone();
  LabelledCloud scene = twoCars(2.0F);
  for (int frame = 0; frame < 4; ++frame)
  {
    input_.publish(toRosMessage(laidOut(scene, kPlainLayout), "lidar", ros::Time(100 + frame)));
    diagnostics_->waitFor("scans processed", std::to_string(frame + 1));
  }
  const auto answer = [&](int frame)
  {
    scene.header.stamp = (100 + frame) * 1000000ULL;
    panoptic_.publish(boost::make_shared<PanopticCloud>(runAlgorithm("birds_eye", scene)));
  };
  answer(1);
  auto back = original_->next();
  ASSERT_TRUE(back);
  EXPECT_EQ(back->header.stamp, ros::Time(101));
  answer(0);
  EXPECT_EQ(diagnostics_->waitFor("instances without scan", "1")["scans refused"], "0");
  answer(3);
  back = original_->next();
  ASSERT_TRUE(back);
  EXPECT_EQ(back->header.stamp, ros::Time(103));
}

TEST_F(OriginalGraph, InstancesOfAnotherSizeAreRefused)
{
  startAlone();
  const LabelledCloud scene = twoCars(2.0F);
  const auto send = [&] { input_.publish(toRosMessage(laidOut(scene, kPlainLayout), "lidar", ros::Time(100))); };
  const auto answer = [&](LabelledCloud cloud)
  {
    cloud.header.stamp = 100000000ULL;
    panoptic_.publish(boost::make_shared<PanopticCloud>(runAlgorithm("birds_eye", cloud)));
  };
  send();
  diagnostics_->waitFor("scans processed", "1");
  answer(labelledScene());
  const std::string error = diagnostics_->waitFor("scans refused", "1")["last error"];
  EXPECT_NE(error.find("cloud on " + name_ + "/panoptic dropped: "), std::string::npos) << error;
  EXPECT_NE(error.find("expected"), std::string::npos) << error;
  send();
  diagnostics_->waitFor("scans processed", "2");
  answer(scene);
  EXPECT_TRUE(original_->next());
}
}  // namespace
}  // namespace lidar_panoptic_clustering

int main(int argc, char** argv)
{
  return lidar_panoptic_clustering::runGraphTests(argc, argv, "organizer_original_test");
}

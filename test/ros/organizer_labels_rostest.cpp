// Where the organizer's labels come from.
#include "organizer_fixture.h"

namespace lidar_panoptic_clustering
{
namespace
{
namespace encodings = sensor_msgs::image_encodings;

ros::Time sceneStamp(int frame)
{
  return kSceneStamp + ros::Duration(0.1 * frame);
}

sensor_msgs::PointCloud2Ptr unlabelledScene(ros::Time stamp = kSceneStamp)
{
  return toRosMessage(withoutLabels(labelledScene()), "lidar", stamp);
}

class LabelsFromImage : public OrganizerGraph
{
protected:
  void expectNextIsScene(ros::Time stamp = kSceneStamp)
  {
    const auto cloud = output_->next();
    ASSERT_TRUE(cloud);
    expectScene(*cloud);
    EXPECT_EQ(cloud->header.stamp, stamp.toNSec() / 1000);
  }

  /// `spoil` makes labels that cannot be used: they are refused with `reason`, and the next pair is taken.
  void expectRefused(const std::function<void(sensor_msgs::Image&)>& spoil, const std::string& reason)
  {
    start("image");
    LogProbe log;
    const auto bad = labelImage(labelledScene());
    spoil(*bad);
    input_.publish(unlabelledScene());
    labels_.publish(bad);
    const std::string message = log.waitFor("dropped");
    EXPECT_NE(message.find("cloud on " + name_ + "/input dropped: labels on " + name_ + "/label_input: "),
              std::string::npos)
        << message;
    EXPECT_NE(message.find(reason), std::string::npos) << message;
    EXPECT_EQ(diagnostics_->waitFor("scans refused", "1")["last error"], message);

    input_.publish(unlabelledScene(sceneStamp(1)));
    labels_.publish(labelImage(labelledScene(), sceneStamp(1)));
    expectNextIsScene(sceneStamp(1));
  }
};

TEST_F(LabelsFromImage, OfEachEncodingBeforeOrAfterTheCloud)
{
  start("image");
  const LabelledCloud scene = labelledScene();
  int frame = 0;
  for (const auto& image : {labelImage<std::uint8_t>(scene, encodings::MONO8, sceneStamp(0)),
                            labelImage<std::uint8_t>(scene, encodings::TYPE_8UC1, sceneStamp(1)),
                            labelImage<std::uint16_t>(scene, encodings::MONO16, sceneStamp(2)),
                            labelImage<std::uint16_t>(scene, encodings::TYPE_16UC1, sceneStamp(3)),
                            labelImage<std::int32_t>(scene, encodings::TYPE_32SC1, sceneStamp(4))})
  {
    SCOPED_TRACE(image->encoding);
    const auto cloud = unlabelledScene(image->header.stamp);
    if (frame % 2 == 0) input_.publish(cloud);
    labels_.publish(image);
    if (frame % 2 == 1) input_.publish(cloud);
    expectNextIsScene(sceneStamp(frame++));
  }
}

TEST_F(LabelsFromImage, StampMayLackWhatIsBelowAMicrosecond)
{
  start("image");
  const ros::Time stamp(1700000000, 123456789);
  for (const std::uint32_t nanoseconds : {123456000U, 123457000U})  // cut off, rounded
  {
    input_.publish(unlabelledScene(stamp));
    labels_.publish(labelImage(labelledScene(), ros::Time(1700000000, nanoseconds)));
    expectNextIsScene(stamp);
  }
}

TEST_F(LabelsFromImage, WithinTheToleranceGoToTheNearestCloud)
{
  set("sync_tolerance_s", 0.04);
  start("image");
  for (int frame = 0; frame < 3; ++frame) input_.publish(unlabelledScene(sceneStamp(frame)));
  labels_.publish(labelImage(labelledScene(), sceneStamp(1) - ros::Duration(0.03)));
  expectNextIsScene(sceneStamp(1));
  labels_.publish(labelImage(labelledScene(), sceneStamp(2) + ros::Duration(0.05)));
  EXPECT_EQ(diagnostics_->waitFor("scans waiting for labels", "1")["scans dropped"], "1") << "the first one";
}

TEST_F(LabelsFromImage, LateOnesAreUsedInTheirOrder)
{
  start("image");
  for (int frame = 0; frame < 4; ++frame) input_.publish(unlabelledScene(sceneStamp(frame)));
  diagnostics_->waitFor("scans waiting for labels", "4");
  EXPECT_FALSE(output_->takeIfThere());
  for (int frame = 0; frame < 4; ++frame) labels_.publish(labelImage(labelledScene(), sceneStamp(frame)));
  for (int frame = 0; frame < 4; ++frame) expectNextIsScene(sceneStamp(frame));
  EXPECT_EQ(diagnostics_->waitFor("scans waiting for labels", "0")["scans dropped"], "0");
}

TEST_F(LabelsFromImage, ThatNeverComeCostTheirCloudsAndThatIsSaid)
{
  set("queue_size", 2);
  start("image");
  LogProbe log;
  for (int frame = 0; frame < 5; ++frame)
  {
    input_.publish(unlabelledScene(sceneStamp(frame)));
    diagnostics_->waitFor("scans waiting for labels", frame == 0 ? "1" : "2");
  }
  const std::string message = log.waitFor("dropped");
  EXPECT_NE(message.find("cloud on " + name_ + "/input dropped: expected labels on " + name_ + "/label_input"),
            std::string::npos)
      << message;
  EXPECT_NE(message.find("no labels"), std::string::npos) << message;
  auto report = diagnostics_->waitFor("scans dropped", "3");
  EXPECT_EQ(report["scans refused"], "0");
  EXPECT_NE(report["last error"].find("found clouds up to stamp"), std::string::npos) << report["last error"];

  labels_.publish(labelImage(labelledScene(), sceneStamp(4)));
  expectNextIsScene(sceneStamp(4));
  EXPECT_EQ(diagnostics_->waitFor("scans dropped", "4")["scans processed"], "1");
}

TEST_F(LabelsFromImage, OneRowShortIsRefused)
{
  expectRefused(
      [](sensor_msgs::Image& image)
      {
        image.height -= 1;
        image.data.resize(std::size_t{image.height} * image.step);
      },
      "expected a label image of the range image's 8 rows x 64 columns, found 7 rows x 64 columns");
}

TEST_F(LabelsFromImage, OfColoursAreRefused)
{
  expectRefused([](sensor_msgs::Image& image) { image.encoding = encodings::BGR8; }, "64FC1, found 'bgr8'");
}

TEST_F(LabelsFromImage, WithLessDataThanTheyClaimAreRefused)
{
  expectRefused([](sensor_msgs::Image& image) { image.data.resize(100); }, "found 100");
}

TEST_F(LabelsFromImage, OfAnotherTableAreRefused)
{
  // nuScenes' car and driveable surface, which are no ids of SemanticKITTI's
  expectRefused(
      [](sensor_msgs::Image& image)
      {
        for (auto& id : image.data) id = id == kRoad ? 24 : 17;
      },
      "expected class ids of the table 'semantic_kitti' (parameter label_table, which is not set)");
}

TEST_F(LabelsFromImage, OfAnotherTableAreTurnedIntoTheOneClusteredWith)
{
  set("label_table", "nuscenes");
  set("class_table", "semantic_kitti");
  start("image");
  LabelledCloud nuscenes = labelledScene(), kitti = nuscenes;
  for (std::size_t i = 0; i < kitti.points.size(); ++i)
  {
    auto &from = nuscenes.points[i].label, &to = kitti.points[i].label;
    const bool car = to == kCar || to == kMovingCar;
    from = car ? 17 : to == kPerson ? 2 : to == kTruck ? 23 : 24;
    to = car ? kCar : to;
  }
  input_.publish(unlabelledScene());
  labels_.publish(labelImage(nuscenes));
  const auto cloud = output_->next();
  ASSERT_TRUE(cloud);
  expectScene(*cloud, kitti);
}

class LabelsFromCloud : public OrganizerGraph
{
};

TEST_F(LabelsFromCloud, OfAnyLayoutInTheSameOrder)
{
  start("cloud");
  const LabelledCloud scene = labelledScene();
  // as a semantic node sends it: the class alone, a byte at an odd offset, all points in one row
  RawMessage flat(1, static_cast<std::uint32_t>(scene.size()), {rawField("label", 1, NumberType::kUint8)}, 3);
  for (std::size_t i = 0; i < scene.size(); ++i) flat.set(0, i, "label", scene.points[i].label);
  int frame = 0;
  for (const RawMessage& labels : {laidOut(scene, kPlainLayout), laidOut(scene, kOddLayout), flat})
  {
    labels_.publish(toRosMessage(labels, "elsewhere", sceneStamp(frame)));
    input_.publish(unlabelledScene(sceneStamp(frame)));
    const auto cloud = output_->next();
    ASSERT_TRUE(cloud);
    expectScene(*cloud);
    ++frame;
  }
}

TEST_F(LabelsFromCloud, AreTakenAsSentWhereTheSensorSendsTheTranspose)
{
  set("orientation", "rows_are_firings");
  start("cloud");
  input_.publish(toRosMessage(transposed(withoutLabels(labelledScene()))));
  labels_.publish(toRosMessage(transposed(laidOut(labelledScene(), kPlainLayout))));
  const auto cloud = output_->next();
  ASSERT_TRUE(cloud);
  expectScene(*cloud);
}

TEST_F(LabelsFromCloud, OfOtherPointsOrWithoutTheFieldAreRefused)
{
  set("label_field", "class_id");
  start("cloud");
  RawMessage labels = laidOut(labelledScene(), kPlainLayout);
  input_.publish(unlabelledScene());
  labels_.publish(toRosMessage(labels));
  EXPECT_NE(diagnostics_->waitFor("scans refused", "1")["last error"].find("expected a field 'class_id'"),
            std::string::npos);

  for (auto& field : labels.header.fields)
    if (field.name == "label") field.name = "class_id";
  input_.publish(unlabelledScene());
  labels_.publish(toRosMessage(transposed(labels)));
  EXPECT_NE(diagnostics_->waitFor("scans refused", "2")["last error"].find("found 64 rows x 8 columns"),
            std::string::npos);

  input_.publish(unlabelledScene());
  labels_.publish(toRosMessage(labels));
  const auto cloud = output_->next();
  ASSERT_TRUE(cloud);
  expectScene(*cloud);
}

class LabelsFromField : public OrganizerGraph
{
};

TEST_F(LabelsFromField, OfTheUsualNames)
{
  start();
  for (const std::string name : {"label", "class_id", "semantic", "class"})
  {
    SCOPED_TRACE(name);
    RawMessage raw = laidOut(labelledScene(), kPlainLayout);
    for (auto& field : raw.header.fields)
      if (field.name == "label") field.name = name;
    input_.publish(toRosMessage(raw));
    const auto cloud = output_->next();
    ASSERT_TRUE(cloud);
    expectScene(*cloud);
  }
}

class NoLabels : public OrganizerGraph
{
};

TEST_F(NoLabels, ObjectsComeFromTheGeometry)
{
  const std::string clusterer = newName();
  ros::param::set(clusterer + "/class_table", "object");
  ASSERT_TRUE(tryLoad(clusterer, "BirdsEyeClusterNodelet", {{clusterer + "/input", name_ + "/output"}}));
  Probe<PanopticCloud> panoptic(clusterer + "/output");
  start("none");

  const LabelledCloud truth = simulatedScan("hdl64e");
  input_.publish(toRosMessage(withoutLabels(truth)));
  const auto out = panoptic.next();
  ASSERT_TRUE(out);
  ASSERT_EQ(out->size(), truth.size());
  std::size_t road = 0, road_as_ground = 0, cars = 0, cars_as_objects = 0;
  for (std::size_t i = 0; i < truth.size(); ++i)
  {
    if (!hasReturn(truth.points[i])) continue;
    const bool is_car = truth.points[i].label == kCar || truth.points[i].label == kMovingCar;
    if (truth.points[i].label == kRoad) ++road, road_as_ground += out->points[i].label == 1 ? 1 : 0;
    if (is_car) ++cars, cars_as_objects += out->points[i].instance > 0 ? 1 : 0;
  }
  ASSERT_GT(road, 1000U);
  ASSERT_GT(cars, 100U);
  EXPECT_GT(road_as_ground, road * 9 / 10);
  EXPECT_GT(cars_as_objects, cars * 7 / 10);
}

TEST_F(NoLabels, TheGroundIsReported)
{
  ros::param::set(name_ + "/height_as_intensity", true);
  start("none");
  const LabelledCloud truth = simulatedScan("hdl64e");
  input_.publish(toRosMessage(withoutLabels(truth)));
  const auto out = output_->next();
  ASSERT_TRUE(out);
  std::size_t road = 0, low = 0;
  for (std::size_t i = 0; i < truth.size(); ++i)
    if (hasReturn(truth.points[i]) && truth.points[i].label == kRoad)
      ++road, low += std::abs(out->points[i].intensity) < 0.15F ? 1U : 0U;
  EXPECT_GT(low, road * 9 / 10);
  auto report = diagnostics_->waitFor("scans processed", "1");
  EXPECT_EQ(report["sensor"].substr(0, 3), "1.7") << report["sensor"];
  EXPECT_NE(report["ground"].find(" y + -1.7"), std::string::npos) << report["ground"];
  EXPECT_NE(report["ground"].find("sloped by 0."), std::string::npos) << report["ground"];
}

TEST_F(NoLabels, AScanWithoutGroundIsSaid)
{
  start("none");
  LabelledCloud head_down = simulatedScan("hdl64e");
  for (LabelledPoint& point : head_down.points) point.y = -point.y, point.z = -point.z;
  input_.publish(toRosMessage(withoutLabels(head_down)));
  ASSERT_TRUE(output_->next());
  auto report = diagnostics_->waitFor("scans without ground", "1");
  EXPECT_NE(report["message"].find("no ground in the last scan"), std::string::npos) << report["message"];
}

class WrongParameters : public OrganizerGraph
{
};

TEST_F(WrongParameters, KeepItFromLoading)
{
  set("labels", "anywhere");
  expectNotLoaded("'anywhere'");
  set("labels", "image");
  set("label_table", "no_such_table");
  expectNotLoaded("no_such_table");
  set("labels", "none");
  set("label_table", "nuscenes");
  expectNotLoaded("label_table: expected 'object' or nothing, as labels is 'none', found 'nuscenes'");
  set("label_table", "object");
  set("class_table", "semantic_kitti");
  expectNotLoaded("class_table: expected one with a thing class 'object', as labels is 'none', found 'semantic_kitti'");
}
}  // namespace
}  // namespace lidar_panoptic_clustering

int main(int argc, char** argv)
{
  return lidar_panoptic_clustering::runGraphTests(argc, argv, "organizer_labels_test");
}

// What a network needs of the organizer, and a network in the loop: doc/your_network.py.
#include "organizer_fixture.h"

#include <cstring>

namespace lidar_panoptic_clustering
{
namespace
{
const ros::Time kOddStamp(1700000000, 123456789);

sensor_msgs::PointCloud2Ptr unlabelledScene(ros::Time stamp)
{
  return toRosMessage(withoutLabels(labelledScene()), "lidar", stamp);
}

class NetworkGraph : public OrganizerGraph
{
protected:
  /// Listens to what comes before the labels alone.
  void startUnlabelled(const std::string& labels)
  {
    set("labels", labels);
    input_ = advertise<sensor_msgs::PointCloud2>(name_ + "/input");
    if (labels == "image") labels_ = advertise<sensor_msgs::Image>(name_ + "/label_input");
    diagnostics_ = std::make_unique<DiagnosticsProbe>(name_);
    ASSERT_TRUE(tryLoad(name_, "OrganizerNodelet"));
    cloud_ = std::make_unique<Probe<sensor_msgs::PointCloud2>>(name_ + "/unlabelled");
    waitForSubscriber(input_);
  }

  void listenToAll()
  {
    range_ = std::make_unique<Probe<sensor_msgs::Image>>(name_ + "/range");
    intensity_ = std::make_unique<Probe<sensor_msgs::Image>>(name_ + "/intensity");
    output_ = std::make_unique<Probe<LabelledCloud>>(name_ + "/output");
    for (const char* topic : {"/unlabelled", "/range", "/intensity", "/output"}) waitForListener(name_ + topic);
    if (labels_) waitForSubscriber(labels_);
  }

  std::unique_ptr<Probe<sensor_msgs::PointCloud2>> cloud_;
  std::unique_ptr<Probe<sensor_msgs::Image>> range_, intensity_;
};

float pixelOf(const sensor_msgs::Image& image, std::size_t i)
{
  float value = 0.0F;
  std::memcpy(&value, &image.data[i * sizeof(float)], sizeof(float));
  return value;
}

TEST_F(NetworkGraph, GetsTheScanBeforeItsLabelsCome)
{
  startUnlabelled("image");
  listenToAll();
  const LabelledCloud scene = labelledScene();
  input_.publish(unlabelledScene(kOddStamp));
  const auto cloud = cloud_->next();
  const auto range = range_->next(), intensity = intensity_->next();
  ASSERT_TRUE(cloud && range && intensity);
  EXPECT_FALSE(output_->takeIfThere());
  for (const std_msgs::Header& header : {cloud->header, range->header, intensity->header})
  {
    EXPECT_EQ(header.stamp, kOddStamp) << "to the nanosecond";
    EXPECT_EQ(header.frame_id, "lidar");
  }
  ASSERT_EQ(cloud->width, scene.width);
  ASSERT_EQ(cloud->height, scene.height);
  for (const auto& image : {range, intensity})
  {
    EXPECT_EQ(image->encoding, "32FC1");
    ASSERT_EQ(image->width, scene.width);
    ASSERT_EQ(image->height, scene.height);
    ASSERT_EQ(image->data.size(), scene.size() * sizeof(float));
  }
  const RawCloud view = viewOf(*cloud);
  checkLayout(view, {"x", "y", "z", "intensity"});
  for (std::size_t i = 0; i < scene.size(); ++i)
  {
    float xyz[3];
    std::memcpy(xyz, view.point(i / scene.width, i % scene.width), sizeof(xyz));
    const LabelledPoint& p = scene.points[i];
    ASSERT_EQ(std::isnan(xyz[0]), !hasReturn(p)) << i;
    ASSERT_EQ(std::isnan(pixelOf(*range, i)), !hasReturn(p)) << i;
    EXPECT_EQ(pixelOf(*intensity, i), p.intensity);
    if (!hasReturn(p)) continue;
    ASSERT_EQ(xyz[0], p.x);
    ASSERT_EQ(xyz[2], p.z);
    EXPECT_FLOAT_EQ(pixelOf(*range, i), std::sqrt(p.x * p.x + p.y * p.y + p.z * p.z));
  }

  labels_.publish(labelImage(scene, kOddStamp));
  const auto out = output_->next();
  ASSERT_TRUE(out);
  expectScene(*out);
  EXPECT_EQ(out->header.stamp, kOddStamp.toNSec() / 1000);
}

TEST_F(NetworkGraph, MayAnswerSeveralScansLate)
{
  startUnlabelled("image");
  listenToAll();
  for (int frame = 0; frame < 6; ++frame) input_.publish(unlabelledScene(kOddStamp + ros::Duration(0.1 * frame)));
  for (int frame = 0; frame < 6; ++frame) ASSERT_TRUE(cloud_->next());
  for (const int frame : {1, 2, 5})  // as a network leaves out those for which it has no time
  {
    labels_.publish(labelImage(labelledScene(), kOddStamp + ros::Duration(0.1 * frame)));
    const auto out = output_->next();
    ASSERT_TRUE(out);
    expectScene(*out);
    EXPECT_EQ(out->header.stamp, (kOddStamp + ros::Duration(0.1 * frame)).toNSec() / 1000);
  }
}

TEST_F(NetworkGraph, IsServedWhileNobodyWantsTheRest)
{
  for (const std::string labels : {"image", "none"})
  {
    if (labels == "none") ASSERT_TRUE(loader_.unload(name_));
    startUnlabelled(labels);
    for (int frame = 1; frame <= 3; ++frame)
    {
      input_.publish(unlabelledScene(ros::Time(100 + frame)));
      ASSERT_TRUE(cloud_->next());
    }
    EXPECT_EQ(diagnostics_->waitFor("scans processed", "3")["scans dropped"], "0") << "no labels are missed";
    if (labels_) EXPECT_EQ(labels_.getNumSubscribers(), 0U);
    cloud_.reset();
    EXPECT_TRUE(eventually([&] { return input_.getNumSubscribers() == 0; }));
  }
}

TEST_F(NetworkGraph, ScansThatCannotBeOrganisedAreNotWaitedFor)
{
  startUnlabelled("image");
  listenToAll();
  const auto bad = unlabelledScene(kOddStamp);
  bad->fields.pop_back(), bad->fields.pop_back();  // no z
  input_.publish(bad);
  EXPECT_NE(diagnostics_->waitFor("scans refused", "1")["last error"].find("expected a field 'z'"), std::string::npos);
  input_.publish(unlabelledScene(kOddStamp + ros::Duration(1.0)));
  labels_.publish(labelImage(labelledScene(), kOddStamp + ros::Duration(1.0)));
  ASSERT_TRUE(output_->next());
}

/// The node of the documentation, started beside this test, by `labels`.
class YourNetwork : public NetworkGraph, public testing::WithParamInterface<std::string>
{
};

TEST_P(YourNetwork, LabelsWhatTheOrganizerShows)
{
  const std::string labels = GetParam();
  const bool as_cloud = labels == "cloud";
  set("labels", labels);
  set("label_table", std::string("semantic_kitti"));
  input_ = ros::NodeHandle().advertise<sensor_msgs::PointCloud2>(as_cloud ? "/points" : name_ + "/input", 10);
  ASSERT_TRUE(tryLoad(name_, "OrganizerNodelet",
                      {{name_ + "/input", as_cloud ? "/points" : name_ + "/input"},
                       {name_ + "/unlabelled", "/unlabelled"},
                       {name_ + "/label_input", as_cloud ? "/cloud_network/labels" : "/image_network/labels"}}));
  output_ = std::make_unique<Probe<LabelledCloud>>(name_ + "/output");
  const std::string asked = as_cloud ? "/points" : "/unlabelled";
  EXPECT_TRUE(
      eventually([&] { return ros::TopicManager::instance()->getNumSubscribers(asked) >= (as_cloud ? 2U : 1U); }));
  EXPECT_TRUE(eventually([&] { return input_.getNumSubscribers() >= (as_cloud ? 2U : 1U); }));

  const LabelledCloud truth = simulatedScan("vlp16");
  boost::shared_ptr<const LabelledCloud> out;
  std::uint32_t frame = 0;
  EXPECT_TRUE(eventually(
      [&]  // until the network's answers reach the organizer
      {
        input_.publish(toRosMessage(withoutLabels(truth), "lidar", ros::Time(1700000000 + ++frame, 123456789)));
        ros::WallDuration(0.3).sleep();
        return (out = output_->takeIfThere()) != nullptr;
      }));
  ASSERT_TRUE(out);
  ASSERT_EQ(out->size(), truth.size());
  std::size_t road = 0, right = 0;
  for (std::size_t i = 0; i < truth.size(); ++i)
  {
    if (!hasReturn(truth.points[i])) continue;
    EXPECT_TRUE(out->points[i].label == 10 || out->points[i].label == 40 || out->points[i].label == 70);
    if (truth.points[i].label != kRoad) continue;
    ++road, right += out->points[i].label == kRoad ? 1 : 0;
  }
  EXPECT_GT(road, 500U);
  EXPECT_GT(right, road * 8 / 10);
}

INSTANTIATE_TEST_SUITE_P(Labels, YourNetwork, testing::Values("image", "cloud"),
                         [](const auto& test) { return test.param; });
}  // namespace
}  // namespace lidar_panoptic_clustering

int main(int argc, char** argv)
{
  return lidar_panoptic_clustering::runGraphTests(argc, argv, "organizer_network_test");
}

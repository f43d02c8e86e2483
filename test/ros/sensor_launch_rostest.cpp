// What a user types: sensor.launch with each source of labels, loaded into the vehicle's own manager, this process.
#include "organizer_fixture.h"

namespace lidar_panoptic_clustering
{
namespace
{
/// Somebody listens to both ends of a launch called `name`; its clouds come from the test.
class Launched
{
public:
  explicit Launched(const std::string& name)
      : input(ros::NodeHandle().advertise<sensor_msgs::PointCloud2>(name + "_points", 10)),
        original_(name + "/output_original"),
        output_(name + "/output")
  {
    // for output_original the organizer listens to the instances before it listens to its input
    waitForSubscriber(input);
    waitForListener("/" + name + "_organizer/output");
    waitForListener("/" + name + "/output");
  }

  /// What comes of the cloud sent last has the instances that the algorithm finds in the scene itself.
  void expectInstances(const std::string& algorithm)
  {
    const auto expected = instancesOf(runAlgorithm(algorithm, labelledScene()));
    const auto cloud = output_.next();
    ASSERT_TRUE(cloud);
    EXPECT_EQ(instancesOf(*cloud), expected);
    const auto original = original_.next();
    ASSERT_TRUE(original);
    EXPECT_EQ(idsIn(*original, "instance"), expected);
  }

  Probe<PanopticCloud>::Ptr next() { return output_.next(); }

  const ros::Publisher input;

private:
  Probe<sensor_msgs::PointCloud2> original_;
  Probe<PanopticCloud> output_;
};

TEST(SensorLaunch, TakesLabelsFromAFieldOfTheCloud)
{
  Launched launched("by_field");
  RawMessage raw = laidOut(labelledScene(), kPlainLayout);
  for (auto& field : raw.header.fields)
    if (field.name == "label") field.name = "class_id";
  launched.input.publish(toRosMessage(raw));
  launched.expectInstances("birds_eye");
}

TEST(SensorLaunch, TakesLabelsFromAnImage)
{
  const auto labels = advertise<sensor_msgs::Image>("segmentation");
  Launched launched("by_image");
  waitForSubscriber(labels);
  launched.input.publish(toRosMessage(withoutLabels(labelledScene())));
  labels.publish(labelImage(labelledScene()));
  launched.expectInstances("scan_line_run");
}

TEST(SensorLaunch, TakesLabelsFromASecondCloud)
{
  const auto labels = advertise<sensor_msgs::PointCloud2>("labelled_points");
  Launched launched("by_cloud");
  waitForSubscriber(labels);
  launched.input.publish(toRosMessage(withoutLabels(labelledScene())));
  labels.publish(toRosMessage(laidOut(labelledScene(), kOddLayout)));
  launched.expectInstances("birds_eye");
}

TEST(SensorLaunch, NeedsNoLabels)
{
  Launched launched("by_geometry");
  const LabelledCloud street = simulatedScan("vlp16");
  launched.input.publish(toRosMessage(withoutLabels(street)));
  const auto cloud = launched.next();
  ASSERT_TRUE(cloud);
  ASSERT_EQ(cloud->size(), street.size());
  const auto object = ClassTable::load("object");
  std::size_t ground = 0, things = 0;
  for (const PanopticPoint& p : cloud->points)
  {
    ground += p.label == object[object.findByName("ground")].ids[0] ? 1 : 0;
    things += p.instance > 0 ? 1 : 0;
  }
  EXPECT_GT(ground, 1000U);
  EXPECT_GT(things, 100U);
}
/// The nodelets log in this process, as in the driver's; the launch has a node of its own that says it.
TEST(SensorLaunch, SaysItselfWhatIsWrong)
{
  LogProbe log;
  auto output = std::make_unique<Probe<PanopticCloud>>("silent/output");
  log.waitFor("/silent_organizer: no input: nobody publishes /silent_points", "/silent_echo");
  const auto input = ros::NodeHandle().advertise<sensor_msgs::PointCloud2>("silent_points", 10);
  waitForSubscriber(input);
  input.publish(toRosMessage(withoutLabels(labelledScene())));
  log.waitFor("/silent_organizer: scans refused: cloud on /silent_points dropped: ", "/silent_echo");
  output.reset();
  log.waitFor("/silent: nobody listens to /silent/output, /silent/markers or /silent/objects", "/silent_echo");
}
}  // namespace
}  // namespace lidar_panoptic_clustering

int main(int argc, char** argv)
{
  ros::init(argc, argv, "sensor_launch");
  nodelet::Loader manager;
  const int result = lidar_panoptic_clustering::runGraphTests(argc, argv, "sensor_launch");
  // at its end the loader looks up the nodelets of broken bonds in a list it has freed
  for (const std::string& name : manager.listLoadedNodelets()) manager.unload(name);
  return result;
}

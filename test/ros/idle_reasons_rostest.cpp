// Why no scan comes out is on /diagnostics: nobody listens, no input, no labels, not loaded.
#include "organizer_fixture.h"

namespace lidar_panoptic_clustering
{
namespace
{
const std::string kOk = std::to_string(diagnostic_msgs::DiagnosticStatus::OK);
const std::string kWarn = std::to_string(diagnostic_msgs::DiagnosticStatus::WARN);
const std::string kError = std::to_string(diagnostic_msgs::DiagnosticStatus::ERROR);

class IdleReasons : public Graph
{
};

TEST_F(IdleReasons, ClusterNodeletTellsNobodyListensFromNoInput)
{
  const std::string name = load("BirdsEyeClusterNodelet");
  DiagnosticsProbe diagnostics(name);
  const std::string nobody = "nobody listens to " + name + "/output, " + name + "/markers or " + name + "/objects";
  EXPECT_EQ(diagnostics.waitFor("message", nobody)["level"], kOk);

  Probe<PanopticCloud> output(name + "/output");
  EXPECT_EQ(diagnostics.waitFor("message", "no input: nobody publishes " + name + "/input")["level"], kWarn);

  const auto input = advertise<LabelledCloud>(name + "/input");
  const std::string silent = "no input: nothing comes on " + name + "/input, though it has 1 publisher";
  EXPECT_EQ(diagnostics.waitFor("message", silent)["level"], kWarn);

  waitForSubscriber(input);
  input.publish(share(labelledScene()));
  EXPECT_EQ(diagnostics.waitFor("message", "processing scans")["level"], kOk);
  EXPECT_EQ(diagnostics.waitFor("message", silent)["level"], kWarn);
}

TEST_F(IdleReasons, OrganizerTellsNoLabelsFromNoInput)
{
  const std::string name = newName();
  ros::param::set(name + "/labels", "image");
  ASSERT_TRUE(tryLoad(name, "OrganizerNodelet"));
  DiagnosticsProbe diagnostics(name);
  const std::string nobody = "nobody listens to " + name + "/output, " + name + "/output_original or ~unlabelled";
  EXPECT_EQ(diagnostics.waitFor("message", nobody)["level"], kOk);

  Probe<LabelledCloud> output(name + "/output");
  EXPECT_EQ(diagnostics.waitFor("message", "no input: nobody publishes " + name + "/input")["level"], kWarn);

  const auto input = advertise<sensor_msgs::PointCloud2>(name + "/input");
  waitForSubscriber(input);
  input.publish(toRosMessage(withoutLabels(labelledScene())));
  const std::string no_labels = "no labels: scans wait for them on " + name + "/label_input, which has 0 publishers";
  EXPECT_EQ(diagnostics.waitFor("message", no_labels)["level"], kWarn);
}

/// The nodelet itself is gone by then.
TEST_F(IdleReasons, WhyANodeletWasNotLoadedIsOnDiagnostics)
{
  for (const char* type : {"BirdsEyeClusterNodelet", "OrganizerNodelet", "EvaluatorNodelet", "LidarSimulatorNodelet",
                           "SemanticKittiPlayerNodelet", "FrameReportNodelet", "LatencyNodelet", "ScanRepeaterNodelet"})
  {
    SCOPED_TRACE(type);
    const std::string name = newName();
    ros::param::set(name + "/class_table", "no_such_table");
    ros::param::set(name + "/label_table", "no_such_table");
    ros::param::set(name + "/sensor", "no_such_sensor");
    ros::param::set(name + "/timeout_s", -1.0);
    ros::param::set(name + "/rate_hz", -1.0);
    DiagnosticsProbe diagnostics(name);
    EXPECT_FALSE(tryLoad(name, type));
    EXPECT_EQ(diagnostics.waitFor("level", kError)["message"].rfind("not loaded: ", 0), 0U);
  }
}
}  // namespace
}  // namespace lidar_panoptic_clustering

int main(int argc, char** argv)
{
  return lidar_panoptic_clustering::runGraphTests(argc, argv, "idle_reasons_test");
}

// Parameters that are set and that nobody uses.
#include "graph_fixture.h"
#include "ros/parameter_server.h"

#include <algorithm>
#include <string>
#include <vector>

namespace lidar_panoptic_clustering
{
namespace
{
using Names = std::vector<std::string>;

class UnusedParametersTest : public testing::Test
{
protected:
  template <class T>
  void set(const std::string& name, const T& value) const
  {
    ros::param::set(space_ + "/" + name, value);
  }
  UnusedParameters find() const { return findUnusedParameters(ros::NodeHandle(space_), known_, {"theta_deg"}); }

  const Names known_ = {"distance_m", "min_points", "columns"};
  const std::string space_ = std::string("/unused_") + testing::UnitTest::GetInstance()->current_test_info()->name();
};

TEST_F(UnusedParametersTest, KnownOnesAndRossOwnAreLeftAlone)
{
  EXPECT_EQ(find().unknown, Names()) << "nothing is set";
  set("distance_m", 0.5);
  set("columns", 1024);
  set("diagnostic_period", 2.0);
  set("diagnostic_updater_use_fqn", true);
  set("num_worker_threads", 4);
  EXPECT_EQ(find().unknown, Names());
  EXPECT_EQ(find().of_others, Names());
}

TEST_F(UnusedParametersTest, MisspeltOneIsNamedWithTheNearest)
{
  set("colums", 1024);
  EXPECT_EQ(find().unknown, Names{"unknown parameter " + space_ + "/colums: nobody uses it; did you mean 'columns'?"});
}

TEST_F(UnusedParametersTest, WhereNoneIsNearAllAreNamed)
{
  set("wibble", 1);
  EXPECT_EQ(find().unknown, Names{"unknown parameter " + space_ +
                                  "/wibble: nobody uses it; there are: distance_m, min_points, columns"});
}

TEST_F(UnusedParametersTest, OneLevelTooDeepIsTold)
{
  set("birds_eye/min_points", 20);
  set("birds_eye/colums", 20);
  set("birds_eye/serial_port", "of something else");
  EXPECT_EQ(find().unknown, (Names{"unknown parameter " + space_ + "/birds_eye/colums: nobody uses it; did you mean " +
                                       space_ + "/columns, one level higher?",
                                   "unknown parameter " + space_ +
                                       "/birds_eye/min_points: nobody uses it, it lies one level too deep; expected " +
                                       space_ + "/min_points"}));
}

/// A node may have a name below another's.
TEST_F(UnusedParametersTest, ParametersOfANodeBelowAreItsOwn)
{
  ros::NodeHandle nh;
  const std::string node = ros::this_node::getName();
  ros::param::set(node + "/columns", 7);
  const Names unknown = findUnusedParameters(ros::NodeHandle(node.substr(0, node.rfind('/'))), known_).unknown;
  EXPECT_EQ(std::count_if(unknown.begin(), unknown.end(),
                          [&node](const std::string& warning)
                          { return warning.find(node + "/columns") != std::string::npos; }),
            0);
  // a namespace that is no node's is looked into
  ros::param::set(node + "_settings/columns", 7);
  const Names with_settings = findUnusedParameters(ros::NodeHandle(node.substr(0, node.rfind('/'))), known_).unknown;
  EXPECT_EQ(std::count_if(with_settings.begin(), with_settings.end(),
                          [&node](const std::string& warning)
                          { return warning.find(node + "_settings/columns") != std::string::npos; }),
            1);
}

TEST_F(UnusedParametersTest, ThoseOfAlternativesAreToldApart)
{
  set("theta_deg", 10.0);
  EXPECT_EQ(find().unknown, Names());
  EXPECT_EQ(find().of_others, Names{space_ + "/theta_deg"});
}

class EachNodelet : public Graph, public testing::WithParamInterface<const char*>
{
};
INSTANTIATE_TEST_SUITE_P(Types, EachNodelet,
                         testing::Values("BirdsEyeClusterNodelet", "DepthClusterNodelet", "EuclideanClusterNodelet",
                                         "ScanLineRunClusterNodelet", "SupervoxelClusterNodelet", "OrganizerNodelet",
                                         "LidarSimulatorNodelet", "SemanticKittiPlayerNodelet", "EvaluatorNodelet",
                                         "FrameReportNodelet", "LatencyNodelet", "ScanRepeaterNodelet",
                                         "DiagnosticsEchoNodelet"),
                         [](const auto& instance) { return std::string(instance.param); });

TEST_P(EachNodelet, WarnsOfAMisspeltParameter)
{
  LogProbe log;
  const std::string name = newName();
  ros::param::set(name + "/rubbish_zzz", 1);
  tryLoad(name, GetParam());  // the player has no data set
  log.waitFor("unknown parameter " + name + "/rubbish_zzz: nobody uses it");
  if (!loader_.listLoadedNodelets().empty())
  {
    EXPECT_TRUE(loader_.unload(name));
  }
}

TEST_F(Graph, DiagnosticsShowTheMisspeltParameterToo)
{
  for (const auto& [type, wrong, right] : {std::tuple("BirdsEyeClusterNodelet", "min_point", "min_points"),
                                           std::tuple("OrganizerNodelet", "colums", "columns")})
  {
    const std::string name = newName();
    ros::param::set(name + "/" + wrong, 20);
    DiagnosticsProbe diagnostics(name);
    ASSERT_TRUE(tryLoad(name, type));
    const std::string warning =
        "unknown parameter " + name + "/" + wrong + ": nobody uses it; did you mean '" + right + "'?";
    EXPECT_EQ(diagnostics.waitFor("warning", warning)["level"],
              std::to_string(diagnostic_msgs::DiagnosticStatus::WARN));
  }
}
}  // namespace
}  // namespace lidar_panoptic_clustering

int main(int argc, char** argv)
{
  return lidar_panoptic_clustering::runGraphTests(argc, argv, "parameter_names_test");
}

#include "graph_fixture.h"
#include "labelled_scene.h"

#include "lidar_panoptic_clustering/pipeline/factory.h"

#include <dynamic_reconfigure/ConfigDescription.h>
#include <dynamic_reconfigure/Reconfigure.h>
#include <pcl_ros/point_cloud.h>

#include <algorithm>

namespace lidar_panoptic_clustering
{
namespace
{
ParameterMap valuesOf(const dynamic_reconfigure::Config& message)
{
  ParameterMap values;
  for (const auto& p : message.bools) values[p.name] = static_cast<bool>(p.value);
  for (const auto& p : message.ints) values[p.name] = p.value;
  for (const auto& p : message.doubles) values[p.name] = p.value;
  for (const auto& p : message.strs) values[p.name] = p.value;
  return values;
}

double number(const ParameterValue& value)
{
  return std::holds_alternative<int>(value) ? std::get<int>(value) : std::get<double>(value);
}

/// The choices of a parameter, as the .cfg generator writes them.
std::string editMethod(const dynamic_reconfigure::ConfigDescription& description, const std::string& parameter)
{
  for (const auto& group : description.groups)
    for (const auto& described : group.parameters)
      if (described.name == parameter) return described.edit_method;
  return "";
}

void expectCfgAgrees(const std::string& algorithm, const dynamic_reconfigure::ConfigDescription& description)
{
  SCOPED_TRACE(algorithm);
  const ParameterMap defaults = valuesOf(description.dflt);
  const ParameterMap least = valuesOf(description.min), most = valuesOf(description.max);
  const auto expected = algorithmParameters(algorithm);
  EXPECT_EQ(defaults.size(), expected.size());
  for (const auto& info : expected)
  {
    SCOPED_TRACE(info.name);
    ASSERT_EQ(defaults.count(info.name), 1U);
    EXPECT_EQ(defaults.at(info.name), info.value);  // the type too
    if (std::holds_alternative<int>(info.value) || std::holds_alternative<double>(info.value))
    {
      EXPECT_EQ(number(least.at(info.name)), info.min);
      EXPECT_EQ(number(most.at(info.name)), info.max);
    }
    for (const auto& choice : info.choices)
      EXPECT_NE(editMethod(description, info.name).find("'value': '" + choice + "'"), std::string::npos) << choice;
  }
}

class CfgFiles : public Graph
{
};

TEST_F(CfgFiles, HaveTheDefaultsAndRangesOfTheCode)
{
  for (const auto& [algorithm, type] : clusterNodelets())
  {
    const std::string name = load(type);
    Probe<dynamic_reconfigure::ConfigDescription> descriptions(name + "/parameter_descriptions");
    const auto description = descriptions.next();
    ASSERT_TRUE(description) << algorithm;
    expectCfgAgrees(algorithm, *description);
  }
}

class ClusterParameters : public Graph
{
protected:
  /// What the nodelet answers: the values it has from now on.
  static ParameterMap reconfigure(const std::string& name, const dynamic_reconfigure::Config& wanted)
  {
    dynamic_reconfigure::Reconfigure service;
    service.request.config = wanted;
    EXPECT_TRUE(ros::service::call(name + "/set_parameters", service));
    return valuesOf(service.response.config);
  }
  static ParameterMap reconfigure(const std::string& name, const std::string& parameter, double value)
  {
    dynamic_reconfigure::Config wanted;
    wanted.doubles.resize(1);
    wanted.doubles[0].name = parameter, wanted.doubles[0].value = value;
    return reconfigure(name, wanted);
  }
  static ParameterMap reconfigure(const std::string& name, const std::string& parameter, const std::string& value)
  {
    dynamic_reconfigure::Config wanted;
    wanted.strs.resize(1);
    wanted.strs[0].name = parameter, wanted.strs[0].value = value;
    return reconfigure(name, wanted);
  }

  /// How many instances the nodelet finds in two cars 2 m apart.
  static std::uint32_t instancesFound(Probe<PanopticCloud>& output, const ros::Publisher& input)
  {
    input.publish(share(twoCars(2.0F)));
    const auto out = output.next();
    if (!out) return 0;
    const auto ids = instancesOf(*out);
    return *std::max_element(ids.begin(), ids.end());
  }

  /// Expects that the nodelet refuses to load with the parameter, saying why, and loads once it is mended.
  template <class Value>
  void expectRefused(const std::string& parameter, const Value& value, const std::vector<std::string>& message_parts)
  {
    SCOPED_TRACE(parameter);
    const std::string name = newName();
    ros::param::set(name + "/" + parameter, value);
    EXPECT_FALSE(tryLoad(name, "EuclideanClusterNodelet"));
    const std::string message = log_.waitFor("not loaded");
    for (const auto& part : message_parts) EXPECT_NE(message.find(part), std::string::npos) << part << "\n" << message;
    EXPECT_TRUE(loader_.listLoadedNodelets().empty());
    EXPECT_FALSE(ros::service::exists(name + "/set_parameters", false));

    ros::param::del(name + "/" + parameter);
    EXPECT_TRUE(tryLoad(name, "EuclideanClusterNodelet"));
    EXPECT_TRUE(loader_.unload(name));
  }

private:
  LogProbe log_;  // one for all loads: on Ubuntu 20.04 a new one hears of the load before once more
};

TEST_F(ClusterParameters, OfTheLaunchFileCountFromTheFirstScan)
{
  const std::string name = newName();
  ros::param::set(name + "/link_distance_scale", 5);  // an integer where a double is expected, as launch files have it
  ASSERT_TRUE(tryLoad(name, "EuclideanClusterNodelet"));
  const auto input = advertise<LabelledCloud>(name + "/input");
  Probe<PanopticCloud> output(name + "/output");
  waitForSubscriber(input);
  EXPECT_EQ(instancesFound(output, input), 1U);
}

TEST_F(ClusterParameters, ReconfiguringTakesEffectWithTheNextScan)
{
  const std::string name = load("EuclideanClusterNodelet");
  const auto input = advertise<LabelledCloud>(name + "/input");
  Probe<PanopticCloud> output(name + "/output");
  waitForSubscriber(input);
  EXPECT_EQ(instancesFound(output, input), 2U);
  EXPECT_EQ(reconfigure(name, "link_distance_scale", 5.0).at("link_distance_scale"), ParameterValue(5.0));
  EXPECT_EQ(instancesFound(output, input), 1U);
  EXPECT_EQ(reconfigure(name, "distance_m", 0.5).at("distance_m"), ParameterValue(0.5));
  EXPECT_EQ(instancesFound(output, input), 2U);
  EXPECT_EQ(reconfigure(name, "max_range_m", 10.2).at("max_range_m"), ParameterValue(10.2));
  EXPECT_EQ(instancesFound(output, input), 1U);  // the pipeline's parameters count too: one car is farther
  double on_server = 0.0;
  EXPECT_TRUE(ros::param::get(name + "/max_range_m", on_server));
  EXPECT_EQ(on_server, 10.2);
}

TEST_F(ClusterParameters, ValueOutOfRangeIsClamped)
{
  const std::string name = load("EuclideanClusterNodelet");
  const auto input = advertise<LabelledCloud>(name + "/input");
  Probe<PanopticCloud> output(name + "/output");
  waitForSubscriber(input);
  EXPECT_EQ(reconfigure(name, "link_distance_scale", 999.0).at("link_distance_scale"), ParameterValue(100.0));
  EXPECT_EQ(instancesFound(output, input), 1U);
  EXPECT_EQ(reconfigure(name, "link_distance_scale", -1.0).at("link_distance_scale"), ParameterValue(0.05));
  EXPECT_GT(instancesFound(output, input), 1U);
}

TEST_F(ClusterParameters, ChoiceThatDoesNotExistChangesNothing)
{
  const std::string name = load("EuclideanClusterNodelet");
  const auto input = advertise<LabelledCloud>(name + "/input");
  Probe<PanopticCloud> output(name + "/output");
  waitForSubscriber(input);
  LogProbe log;
  EXPECT_EQ(reconfigure(name, "class_policy", std::string("group")).at("class_policy"),
            ParameterValue(std::string("group")));
  EXPECT_EQ(reconfigure(name, "class_policy", std::string("nonsense")).at("class_policy"),
            ParameterValue(std::string("group")));
  EXPECT_NE(log.waitFor("not reconfigured").find("'nonsense'"), std::string::npos);
  EXPECT_EQ(instancesFound(output, input), 2U);
  EXPECT_EQ(reconfigure(name, "link_distance_scale", 5.0).at("class_policy"), ParameterValue(std::string("group")));
  EXPECT_EQ(instancesFound(output, input), 1U);
}

TEST_F(ClusterParameters, NodeletRefusesToLoadWithOneItCannotUse)
{
  expectRefused("distance_m", 99.0, {"distance_m", "from 0 to 10", "99"});
  expectRefused("distance_m", std::string("wide"), {"distance_m", "expected a number", "a string wide"});
  expectRefused("min_points", 0, {"min_points", "from 1 to 10000", "0"});
  expectRefused("min_points", 2.5, {"min_points", "expected an integer", "2.5"});
  expectRefused("split", 1, {"split", "expected a bool", "an integer 1"});
  expectRefused("class_policy", std::string("nonsense"), {"class_policy", "'class' 'group' 'any'", "nonsense"});
  expectRefused("class_table", std::string("/no/such/table.yaml"), {"/no/such/table.yaml", "semantic_kitti"});
  expectRefused("class_table", 7, {"class_table", "expected a string", "an integer 7"});
}
}  // namespace
}  // namespace lidar_panoptic_clustering

int main(int argc, char** argv)
{
  return lidar_panoptic_clustering::runGraphTests(argc, argv, "cluster_parameters_test");
}

#include "lidar_panoptic_clustering/core/parameters.h"

#include "lidar_panoptic_clustering/pipeline/factory.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <stdexcept>

namespace lidar_panoptic_clustering
{
namespace
{
struct Config
{
  int lines = 3;
  double distance_m = 0.5;
  bool full_turn = true;
  std::string policy = "class";
  std::string field = "label";

  template <class Self, class Visitor>
  static void visit(Self& self, Visitor&& visitor)
  {
    visitor("lines", self.lines, 1, 16);
    visitor("distance_m", self.distance_m, 0.01, 10.0);
    visitor("full_turn", self.full_turn);
    visitor("policy", self.policy, std::vector<std::string>{"class", "group"});
    visitor("field", self.field, std::vector<std::string>{});
  }
};

Config applied(const ParameterMap& given)
{
  Config config;
  applyParameters(config, given);
  return config;
}

std::string errorOf(const ParameterMap& given)
{
  try
  {
    applied(given);
  }
  catch (const std::invalid_argument& error)
  {
    return error.what();
  }
  return "";
}

ParameterValue text(const char* value)
{
  return std::string(value);
}

TEST(Parameters, DescribeAConfigWithItsPresentValues)
{
  Config config;
  config.lines = 5;
  const auto list = describeParameters(config);
  ASSERT_EQ(list.size(), 5U);
  EXPECT_EQ(list[0].name, "lines");
  EXPECT_EQ(list[0].value, ParameterValue(5));
  EXPECT_EQ(list[0].min, 1.0);
  EXPECT_EQ(list[0].max, 16.0);
  EXPECT_EQ(list[1].value, ParameterValue(0.5));
  EXPECT_EQ(list[1].max, 10.0);
  EXPECT_EQ(list[2].value, ParameterValue(true));
  EXPECT_EQ(list[3].value, text("class"));
  EXPECT_EQ(list[3].choices, std::vector<std::string>({"class", "group"}));
  EXPECT_TRUE(list[4].choices.empty());
}

TEST(Parameters, OfTheirOwnTypesAreTakenEndsOfTheRangeToo)
{
  const Config config = applied(
      {{"lines", 16}, {"distance_m", 0.01}, {"full_turn", false}, {"policy", text("group")}, {"field", text("")}});
  EXPECT_EQ(config.lines, 16);
  EXPECT_EQ(config.distance_m, 0.01);
  EXPECT_FALSE(config.full_turn);
  EXPECT_EQ(config.policy, "group");
  EXPECT_EQ(config.field, "");
  EXPECT_EQ(applied({}).lines, 3);
}

TEST(Parameters, WholeNumbersAndTextAreTakenWhereTheyAreTheValue)
{
  EXPECT_EQ(applied({{"lines", 4.0}}).lines, 4);
  EXPECT_EQ(applied({{"lines", text("4")}}).lines, 4);
  EXPECT_EQ(applied({{"distance_m", 2}}).distance_m, 2.0);
  EXPECT_EQ(applied({{"distance_m", text("2.5")}}).distance_m, 2.5);
  EXPECT_FALSE(applied({{"full_turn", text("false")}}).full_turn);
  EXPECT_TRUE(applied({{"full_turn", text("1")}}).full_turn);
}

TEST(Parameters, WhatCannotBeUsedIsNamedWithWhatIsAllowed)
{
  EXPECT_EQ(errorOf({{"lines", 17}}), "parameter 'lines': expected a whole number from 1 to 16, got 17");
  EXPECT_EQ(errorOf({{"lines", 0}}), "parameter 'lines': expected a whole number from 1 to 16, got 0");
  EXPECT_EQ(errorOf({{"lines", 2.5}}), "parameter 'lines': expected a whole number from 1 to 16, got 2.5");
  EXPECT_EQ(errorOf({{"lines", text("4x")}}), "parameter 'lines': expected a whole number from 1 to 16, got '4x'");
  EXPECT_EQ(errorOf({{"lines", true}}), "parameter 'lines': expected a whole number from 1 to 16, got true");
  EXPECT_EQ(errorOf({{"distance_m", 11.0}}), "parameter 'distance_m': expected a number from 0.01 to 10, got 11");
  EXPECT_EQ(errorOf({{"distance_m", text("")}}), "parameter 'distance_m': expected a number from 0.01 to 10, got ''");
  EXPECT_EQ(errorOf({{"full_turn", 1}}), "parameter 'full_turn': expected true or false, got 1");
  EXPECT_EQ(errorOf({{"policy", text("any")}}), "parameter 'policy': expected one of 'class' 'group', got 'any'");
  EXPECT_EQ(errorOf({{"lines", 1e300}}).substr(0, 19), "parameter 'lines': ");
  const double nan = std::numeric_limits<double>::quiet_NaN(), infinity = std::numeric_limits<double>::infinity();
  for (const double value : {nan, infinity, -infinity})
  {
    EXPECT_NE(errorOf({{"distance_m", value}}), "");
    EXPECT_NE(errorOf({{"lines", value}}), "");
  }
}

TEST(Parameters, UnknownNamesAreAnErrorUnlessLeftToTheCaller)
{
  EXPECT_EQ(errorOf({{"lines", 4}, {"Lines", 4}}),
            "there is no parameter 'Lines'; there are: lines, distance_m, full_turn, policy, field");
  Config config;
  EXPECT_EQ(applyKnownParameters(config, {{"lines", 4}, {"Lines", 5}}), 1U);
  EXPECT_EQ(config.lines, 4);
}

TEST(Parameters, ConfigsAreValidated)
{
  Config config;
  EXPECT_NO_THROW(validateParameters(config));
  config.lines = 0;
  EXPECT_THROW(validateParameters(config), std::invalid_argument);
  config.lines = 1;
  config.distance_m = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(validateParameters(config), std::invalid_argument);
  config.distance_m = 1.0;
  config.policy = "nonsense";
  EXPECT_THROW(validateParameters(config), std::invalid_argument);
}

TEST(Algorithms, HaveDefaultsWithinTheirRangesAndRefuseWhatIsNot)
{
  for (const auto& algorithm : algorithmNames())
  {
    ParameterMap defaults;
    for (const auto& info : algorithmParameters(algorithm)) defaults[info.name] = info.value;
    EXPECT_EQ(defaults.count("min_points"), 1U) << algorithm;
    EXPECT_NE(makeAlgorithm(algorithm, defaults).clusterer, nullptr) << algorithm;
    for (const auto& info : algorithmParameters(algorithm))
    {
      SCOPED_TRACE(algorithm + " " + info.name);
      if (std::holds_alternative<bool>(info.value)) continue;
      const bool is_text = std::holds_alternative<std::string>(info.value);
      const ParameterValue beyond = is_text ? text("nonsense") : ParameterValue(info.max + 1.0);
      EXPECT_THROW(makeAlgorithm(algorithm, {{info.name, beyond}}), std::invalid_argument);
      if (is_text) continue;
      EXPECT_NO_THROW(makeAlgorithm(algorithm, {{info.name, info.max}}));
      EXPECT_NO_THROW(makeAlgorithm(algorithm, {{info.name, info.min}}));
    }
    EXPECT_THROW(makeAlgorithm(algorithm, {{"no_such_parameter", 1}}), std::invalid_argument);
  }
  EXPECT_THROW(makeAlgorithm("no_such_algorithm"), std::invalid_argument);
  EXPECT_THROW(algorithmParameters(""), std::invalid_argument);
}

TEST(Algorithms, AreNamedInAListOrAllAtOnce)
{
  EXPECT_EQ(algorithmsOfList("all"), algorithmNames());
  EXPECT_EQ(algorithmsOfList("depth"), std::vector<std::string>{"depth"});
  EXPECT_EQ(algorithmsOfList("birds_eye,depth"), (std::vector<std::string>{"birds_eye", "depth"}));
  for (const char* wrong : {"", ",", "depth,,birds_eye", "depth,sonar", "Depth"})
    EXPECT_THROW(algorithmsOfList(wrong), std::invalid_argument) << wrong;
}
}  // namespace
}  // namespace lidar_panoptic_clustering

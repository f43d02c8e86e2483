#include "lidar_panoptic_clustering/core/class_mapping.h"

#include <gtest/gtest.h>

#include <map>
#include <string>

namespace lidar_panoptic_clustering
{
namespace
{
std::string thing(const std::string& name, const std::string& ids, const std::string& more = "")
{
  return "{name: " + name + ", kind: thing, ids: [" + ids + "], color: [1, 2, 3], size: [4, 2], link: 1" + more + "}";
}

std::string stuff(const std::string& name, const std::string& ids, const std::string& more = "")
{
  return "{name: " + name + ", kind: stuff, ids: [" + ids + "], color: [1, 2, 3]" + more + "}";
}

const std::string kVoid = "{name: void, kind: ignored, ids: [7, 8], color: [0, 0, 0]}";

ClassTable tableOf(const std::string& entries)
{
  return ClassTable::parse("classes: [" + entries + "]", "test.yaml");
}

TEST(ClassMapping, GoesByName)
{
  const ClassMapping map(tableOf(thing("car", "10, 252") + ", " + stuff("road", "40") + ", " + kVoid),
                         tableOf(kVoid + ", " + stuff("road", "1, 2") + ", " + thing("car", "5, 6")));
  EXPECT_EQ(map(10), 5U);
  EXPECT_EQ(map(252), 5U);
  EXPECT_EQ(map(40), 1U);
}

TEST(ClassMapping, WhatIsIgnoredOrUnknownGoesToTheFirstIgnoredClass)
{
  const ClassTable from = tableOf(thing("car", "10") + ", " + kVoid);
  const ClassMapping to_void(from, tableOf(thing("car", "5") + ", " + kVoid));
  const ClassMapping to_none(from, tableOf(thing("car", "5")));
  for (const std::uint32_t id : {0U, 7U, 8U, 9U, 11U, 252U, 65535U, 65536U, 0x7FFFFFFFU, 0xFFFFFFFFU})
  {
    EXPECT_EQ(to_void(id), 7U) << id;
    EXPECT_EQ(to_none(id), ClassMapping::kUnmapped) << id;
  }
  EXPECT_EQ(to_none(10), 5U);
}

TEST(ClassMapping, AnAliasOfEitherSideLeads)
{
  const ClassTable plain = tableOf(thing("person", "1") + ", " + thing("bus", "2"));
  const ClassTable aliased =
      tableOf(thing("pedestrian", "30", ", aliases: [person]") + ", " + thing("other", "20", ", aliases: [tram, bus]"));
  EXPECT_EQ(ClassMapping(plain, aliased)(1), 30U);
  EXPECT_EQ(ClassMapping(plain, aliased)(2), 20U);
  EXPECT_EQ(ClassMapping(aliased, plain)(30), 1U);
  EXPECT_EQ(ClassMapping(aliased, plain)(20), 2U);
}

TEST(ClassMapping, TwoTablesMeetInACommonAlias)
{
  const ClassMapping map(tableOf(thing("walker", "1", ", aliases: [person]")),
                         tableOf(thing("pedestrian", "30", ", aliases: [person]")));
  EXPECT_EQ(map(1), 30U);
}

TEST(ClassMapping, TheNameGoesBeforeAliasesAndAnAliasOfTheTargetBeforeOnesOwn)
{
  const ClassTable to = tableOf(stuff("manmade", "1", ", aliases: [fence]") + ", " + thing("barrier", "2"));
  EXPECT_EQ(ClassMapping(tableOf(stuff("fence", "50", ", aliases: [barrier]")), to)(50), 1U);
  EXPECT_EQ(ClassMapping(tableOf(stuff("manmade", "50", ", aliases: [barrier]")), to)(50), 1U);
  const ClassTable order = tableOf(thing("b", "1") + ", " + thing("a", "2"));
  EXPECT_EQ(ClassMapping(tableOf(thing("x", "9", ", aliases: [a, b]")), order)(9), 2U);
}

TEST(ClassMapping, WithoutACounterpartThingsAreObjectsAndStuffIsStructure)
{
  const ClassTable from = tableOf(thing("tank", "1") + ", " + stuff("pond", "2"));
  const ClassMapping both(from, tableOf(stuff("structure", "8") + ", " + thing("object", "9")));
  EXPECT_EQ(both(1), 9U);
  EXPECT_EQ(both(2), 8U);
  const ClassMapping neither(from, tableOf(kVoid + ", " + thing("car", "5")));
  EXPECT_EQ(neither(1), 7U);
  EXPECT_EQ(neither(2), 7U);
}

/// Names of the classes that the shipped table's classes become.
std::map<std::string, std::string> namesFromTo(const std::string& from_name, const std::string& to_name)
{
  const ClassTable from = ClassTable::load(from_name), to = ClassTable::load(to_name);
  const ClassMapping map(from, to);
  std::map<std::string, std::string> names;
  for (std::size_t i = 1; i < from.size(); ++i)
  {
    const ClassInfo& info = from[static_cast<ClassIndex>(i)];
    for (const std::uint32_t id : info.ids) names[info.name] = to[to.find(map(id))].name;
  }
  return names;
}

using Names = std::map<std::string, std::string>;

TEST(ClassMapping, NuScenesToSemanticKitti)
{
  EXPECT_EQ(namesFromTo("nuscenes", "semantic_kitti"), (Names{{"ignored", "ignored"},
                                                              {"barrier", "fence"},
                                                              {"bicycle", "bicycle"},
                                                              {"bus", "other-vehicle"},
                                                              {"car", "car"},
                                                              {"construction_vehicle", "other-vehicle"},
                                                              {"motorcycle", "motorcycle"},
                                                              {"pedestrian", "person"},
                                                              {"traffic_cone", "ignored"},
                                                              {"trailer", "other-vehicle"},
                                                              {"truck", "truck"},
                                                              {"driveable_surface", "road"},
                                                              {"other_flat", "other-ground"},
                                                              {"sidewalk", "sidewalk"},
                                                              {"terrain", "terrain"},
                                                              {"manmade", "building"},
                                                              {"vegetation", "vegetation"}}));
}

TEST(ClassMapping, SemanticKittiToNuScenes)
{
  EXPECT_EQ(namesFromTo("semantic_kitti", "nuscenes"), (Names{{"ignored", "ignored"},
                                                              {"car", "car"},
                                                              {"bicycle", "bicycle"},
                                                              {"motorcycle", "motorcycle"},
                                                              {"truck", "truck"},
                                                              {"other-vehicle", "bus"},
                                                              {"person", "pedestrian"},
                                                              {"bicyclist", "bicycle"},
                                                              {"motorcyclist", "motorcycle"},
                                                              {"road", "driveable_surface"},
                                                              {"parking", "driveable_surface"},
                                                              {"sidewalk", "sidewalk"},
                                                              {"other-ground", "other_flat"},
                                                              {"building", "manmade"},
                                                              {"fence", "manmade"},
                                                              {"vegetation", "vegetation"},
                                                              {"trunk", "vegetation"},
                                                              {"terrain", "terrain"},
                                                              {"pole", "manmade"},
                                                              {"traffic-sign", "manmade"}}));
}

TEST(ClassMapping, AnyTableIntoObject)
{
  const std::map<std::string, std::string> ground = {
      {"road", "ground"},         {"parking", "ground"},           {"sidewalk", "ground"},  {"terrain", "ground"},
      {"other-ground", "ground"}, {"driveable_surface", "ground"}, {"other_flat", "ground"}};
  for (const char* name : {"semantic_kitti", "nuscenes"})
  {
    const ClassTable from = ClassTable::load(name);
    for (const auto& [own, mapped] : namesFromTo(name, "object"))
    {
      const ClassInfo& info = from[from.findByName(own)];
      const std::string expected = info.kind == ClassKind::kIgnored ? "ignored"
                                   : info.isThing()                 ? "object"
                                   : ground.count(own) > 0          ? "ground"
                                                                    : "structure";
      EXPECT_EQ(mapped, expected) << name << ": " << own;
    }
  }
}

TEST(ClassMapping, ATableOntoItselfKeepsAllClasses)
{
  for (const auto& name : ClassTable::shippedNames())
    for (const auto& [own, mapped] : namesFromTo(name, name)) EXPECT_EQ(own, mapped) << name;
}
}  // namespace
}  // namespace lidar_panoptic_clustering

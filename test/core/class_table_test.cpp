#include "lidar_panoptic_clustering/core/class_table.h"

#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <map>
#include <set>
#include <stdexcept>

namespace lidar_panoptic_clustering
{
namespace
{
const char* const kSmallTable = R"(
name: small
classes:
  - {name: void, kind: ignored, ids: [0], color: [0, 0, 0]}
  - {name: car, kind: thing, ids: [10, 252], color: [255, 128, 1], group: vehicle, size: [4.5, 1.8], link: 0.8}
  - {name: truck, kind: thing, ids: [18], color: [1, 2, 3], group: vehicle, size: [12, 2.5], link: 2}
  - {name: dog, kind: thing, ids: [65535], color: [1, 2, 3], size: [0.5, 0.5], link: 0.3}
  - {name: road, kind: stuff, ids: [40], color: [255, 0, 255]}
)";

TEST(ClassTable, ReadsALiteralTable)
{
  const ClassTable table = ClassTable::parse(kSmallTable, "test.yaml");
  EXPECT_EQ(table.name(), "small");
  EXPECT_EQ(table.size(), 6U);
  const ClassInfo& car = table[table.find(252)];
  EXPECT_EQ(car.name, "car");
  EXPECT_TRUE(car.isThing());
  EXPECT_EQ(car.ids, std::vector<std::uint32_t>({10, 252}));
  EXPECT_EQ(car.rgb, 0xFF8001U);
  EXPECT_EQ(car.length_m, 4.5F);
  EXPECT_EQ(car.width_m, 1.8F);
  EXPECT_EQ(car.link_distance_m, 0.8F);
  EXPECT_EQ(table.find(10), table.find(252));
  EXPECT_EQ(table.find(10), table.findByName("car"));
  EXPECT_EQ(table[table.find(40)].kind, ClassKind::kStuff);
  EXPECT_EQ(table[table.find(0)].kind, ClassKind::kIgnored);
  EXPECT_EQ(table[table.find(65535)].name, "dog");
}

TEST(ClassTable, ClassesOfAGroupShareItAndOthersHaveTheirOwn)
{
  const ClassTable table = ClassTable::parse(kSmallTable, "test.yaml");
  const auto group = [&table](const char* name) { return table[table.findByName(name)].group; };
  EXPECT_EQ(group("car"), group("truck"));
  EXPECT_NE(group("car"), group("dog"));
  EXPECT_EQ(table.groupName(group("car")), "vehicle");
  EXPECT_EQ(table.groupName(group("dog")), "dog");
  EXPECT_LT(group("dog"), table.groupCount());
}

TEST(ClassTable, AliasesLeadToTheirClass)
{
  const ClassTable table = ClassTable::parse(
      "classes: [{name: road, kind: stuff, ids: [40], color: [1, 2, 3], aliases: [street, way]}]", "test.yaml");
  EXPECT_EQ(table[1].aliases, std::vector<std::string>({"street", "way"}));
  EXPECT_EQ(table.findByAlias("way"), table.findByName("road"));
  EXPECT_EQ(table.findByAlias("road"), kUnknownClass);
  EXPECT_EQ(table.findByName("way"), kUnknownClass);
}

TEST(ClassTable, IdsOutsideAreUnknownAndNoThing)
{
  const ClassTable table = ClassTable::parse(kSmallTable, "test.yaml");
  for (const std::uint32_t id : {1U, 9U, 11U, 251U, 253U, 65534U, 65536U, 65546U, 0x7FFFFFFFU, 0xFFFFFFFFU})
    EXPECT_EQ(table.find(id), kUnknownClass) << id;
  EXPECT_FALSE(table[kUnknownClass].isThing());
  EXPECT_EQ(table.findByName("unknown"), kUnknownClass);
  EXPECT_EQ(table.findByName("cat"), kUnknownClass);
}

std::string errorOf(const std::string& yaml)
{
  try
  {
    ClassTable::parse(yaml, "my.yaml");
  }
  catch (const std::invalid_argument& error)
  {
    return error.what();
  }
  return "";
}

std::string errorOfClasses(const std::string& entries)
{
  return errorOf("classes: [" + entries + "]");
}

TEST(ClassTable, NamesFileAndClassInEachError)
{
  const std::string car = "{name: car, kind: thing, ids: [10], color: [1, 2, 3], size: [4, 2], link: 1}";
  EXPECT_EQ(errorOfClasses(car), "");
  const std::string in_car = "my.yaml: class 'car'";
  EXPECT_EQ(errorOfClasses("{name: car, ids: [10], color: [1, 2, 3]}"),
            in_car + ": has no 'kind', expected ignored, stuff or thing");
  EXPECT_EQ(errorOfClasses("{name: car, kind: Thing, ids: [10], color: [1, 2, 3]}"),
            in_car + ": kind is 'Thing', expected ignored, stuff or thing");
  EXPECT_EQ(errorOfClasses("{name: car, kind: stuff, color: [1, 2, 3]}"),
            in_car + ": has no 'ids', expected a list of raw ids");
  EXPECT_EQ(errorOfClasses("{name: car, kind: stuff, ids: [], color: [1, 2, 3]}"),
            in_car + ": ids is empty, expected at least one raw id");
  EXPECT_EQ(errorOfClasses("{name: car, kind: stuff, ids: [-1], color: [1, 2, 3]}"), in_car + ": id -1 is below 0");
  EXPECT_EQ(errorOfClasses("{name: car, kind: stuff, ids: [1.5], color: [1, 2, 3]}"),
            in_car + ": 'ids' must be a list of raw ids");
  EXPECT_EQ(errorOfClasses("{name: car, kind: stuff, ids: [5, 10, 5], color: [1, 2, 3]}"),
            in_car + ": id 5 is there twice");
  EXPECT_EQ(errorOfClasses("{name: car, kind: stuff, ids: 10, color: [1, 2, 3]}"),
            in_car + ": 'ids' must be a list of raw ids");
  EXPECT_EQ(errorOfClasses("{name: car, kind: stuff, ids: [65536], color: [1, 2, 3]}"),
            in_car + ": id 65536 is above 65535");
  EXPECT_EQ(errorOfClasses("{name: car, kind: stuff, ids: [10]}"),
            in_car + ": has no 'color', expected [red, green, blue]");
  for (const char* color : {"[1, 2]", "[1, 2, 256]", "[1, -2, 3]"})
    EXPECT_EQ(errorOfClasses(std::string("{name: car, kind: stuff, ids: [10], color: ") + color + "}"),
              in_car + ": color must be [red, green, blue], each from 0 to 255");
  EXPECT_EQ(errorOfClasses("{name: car, kind: thing, ids: [10], color: [1, 2, 3], link: 1}"),
            in_car + ": has no 'size', expected [length, width] in metres");
  for (const char* size : {"[2, 4]", "[4]", "[4, 0]", "[4, -1]", "[.nan, .nan]"})
    EXPECT_EQ(errorOfClasses(std::string("{name: car, kind: thing, ids: [10], color: [1, 2, 3], link: 1, size: ") +
                             size + "}"),
              in_car + ": size must be [length, width] in metres with length >= width > 0");
  EXPECT_EQ(errorOfClasses("{name: car, kind: thing, ids: [10], color: [1, 2, 3], size: [4, 2]}"),
            in_car + ": has no 'link', expected a distance in metres");
  EXPECT_EQ(errorOfClasses("{name: car, kind: thing, ids: [10], color: [1, 2, 3], size: [4, 2], link: 0}"),
            in_car + ": link must be from 0.05 to 100 m, found 0");
  EXPECT_EQ(errorOfClasses("{name: car, kind: thing, ids: [10], color: [1, 2, 3], size: [4, 2], link: wide}"),
            in_car + ": 'link' must be a distance in metres");
  EXPECT_EQ(errorOfClasses(car + ", " + car), in_car + " is there twice");
  EXPECT_EQ(errorOfClasses(car + ", {name: bus, kind: stuff, ids: [5, 10], color: [1, 2, 3]}"),
            "my.yaml: class 'bus': id 10 already belongs to class 'car'");
  EXPECT_EQ(errorOfClasses(car + ", {kind: stuff, ids: [5], color: [1, 2, 3]}"), "my.yaml: class 2 has no 'name'");
  const std::string road = "{name: road, kind: stuff, ids: [40], color: [1, 2, 3], aliases: ";
  EXPECT_EQ(errorOfClasses(road + "street}"), "my.yaml: class 'road': 'aliases' must be a list of class names");
  EXPECT_EQ(errorOfClasses(road + "[street, car]}, " + car),
            "my.yaml: class 'road': alias 'car' already belongs to class 'car'");
  EXPECT_EQ(errorOfClasses(road + "[way]}, {name: path, kind: stuff, ids: [5], color: [1, 2, 3], aliases: [way]}"),
            "my.yaml: class 'path': alias 'way' already belongs to class 'road'");
  EXPECT_EQ(errorOfClasses("car"), "my.yaml: class 1 has no 'name'");
}

/// What the algorithms' grids hold; a cell of nothing, or of a light-year, is none.
TEST(ClassTable, NumbersHaveARange)
{
  const std::string head = "{name: car, kind: thing, ids: [10], color: [1, 2, 3], ";
  const std::string in_car = "my.yaml: class 'car': ";
  for (const char* link : {"1e-30", "0.049", "100.5", "1e30", "1e300", ".inf", "-.inf", ".nan", "-1"})
    EXPECT_EQ(errorOfClasses(head + "size: [4, 2], link: " + link + "}").rfind(in_car + "link must be from 0.05 ", 0),
              0U)
        << link;
  for (const char* size : {"[1e30, 2]", "[.inf, 2]", "[1001, 2]"})
    EXPECT_EQ(errorOfClasses(head + "link: 1, size: " + size + "}").rfind(in_car + "length must be from 0.01 ", 0), 0U)
        << size;
  EXPECT_EQ(errorOfClasses(head + "link: 1, size: [4, 1e-30]}"),
            in_car + "width must be from 0.01 to 1000 m, found 1e-30");
  EXPECT_EQ(errorOfClasses(head + "size: [1000, 0.01], link: 0.05}"), "");
  EXPECT_EQ(errorOfClasses("{name: car, kind: stuff, ids: [99999999999999999999], color: [1, 2, 3]}"),
            in_car + "'ids' must be a list of raw ids");
}

TEST(ClassTable, NestingHasAnEnd)
{
  const std::string deep(200000, '[');
  EXPECT_EQ(errorOf("classes: " + deep), "my.yaml: nested more than 64 deep");
  std::string dashes;
  for (int i = 0; i < 100000; ++i) dashes += "- ";
  EXPECT_EQ(errorOf(dashes), "my.yaml: nested more than 64 deep");
  EXPECT_EQ(errorOf("# " + std::string(200, '-') + "\nclasses: []"), "my.yaml: the list 'classes' is empty");
}

/// yaml-cpp 0.6 reads each of these for ever.
TEST(ClassTable, ColonBeforeABracketOrTheEndIsRead)
{
  for (const std::string yaml : {"cla sses: [{name: car, kind: thing, ids: [10, 10], color:", "{a:", "[a: b:", "[:",
                                 "[a:\4", "{? a:", "- [x:", "[a\n#:\n:", "classes: [a: b:]", "[::]]"})
    EXPECT_EQ(errorOf(yaml).substr(0, 24), "my.yaml: not a YAML file") << yaml;
  for (const std::string yaml : {"[a:]", "[:]", "[,:]", "[a: ]", "[? a:]", "{classes: 1, a: [b:]}", "classes:", "a:"})
    EXPECT_EQ(errorOf(yaml), "my.yaml: expected a map with a list 'classes'") << yaml;
  EXPECT_EQ(errorOf("# [a:]\nclasses: []"), "my.yaml: the list 'classes' is empty");
}

TEST(ClassTable, OtherEncodingsThanUtf8AreRefused)
{
  std::string wide = "\xFF\xFE";
  for (const char c : std::string("classes: [a:]")) wide += {c, '\0'};
  EXPECT_EQ(errorOf(wide), "my.yaml: holds a byte of 0, expected a text in UTF-8");
}

TEST(ClassTable, WhatIsNoTableIsSaidSo)
{
  for (const char* yaml : {"", "classes", "[1, 2]", "classes: 5", "names: []", "classes: {car: 1}"})
    EXPECT_EQ(errorOf(yaml), "my.yaml: expected a map with a list 'classes'") << yaml;
  EXPECT_EQ(errorOf("classes: []"), "my.yaml: the list 'classes' is empty");
  EXPECT_EQ(errorOf("classes: [}").substr(0, 24), "my.yaml: not a YAML file");
}

TEST(ClassTable, HoldsUpTo255Classes)
{
  std::string entries;
  for (int i = 0; i < 255; ++i)
    entries += "{name: c" + std::to_string(i) + ", kind: thing, ids: [" + std::to_string(i) +
               "], color: [0, 0, 0], size: [1, 1], link: 1}, ";
  const ClassTable table = ClassTable::parse("classes: [" + entries + "]", "full.yaml");
  EXPECT_EQ(table.size(), 256U);
  EXPECT_EQ(table.find(254), 255);
  EXPECT_EQ(table.groupCount(), 256U);
  EXPECT_EQ(table.groupName(table[255].group), "c254");
  EXPECT_EQ(errorOfClasses(entries + "{name: last, kind: stuff, ids: [999], color: [0, 0, 0]}"),
            "my.yaml: class 'last': more than 255 classes");
}

TEST(ClassTable, LoadsAFileAndSaysWhatThereIsWhereItCannot)
{
  const auto file = std::filesystem::temp_directory_path() / "lidar_panoptic_class_table_test.yaml";
  std::ofstream(file) << kSmallTable;
  EXPECT_EQ(ClassTable::load(file.string()).name(), "small");
  std::filesystem::remove(file);
  for (const auto& name : {file.string(), std::filesystem::temp_directory_path().string(), std::string()}) try
    {
      ClassTable::load(name);
      ADD_FAILURE() << "'" << name << "' was loaded";
    }
    catch (const std::runtime_error& error)
    {
      EXPECT_EQ(std::string(error.what()), "class table '" + name +
                                               "': cannot be read; expected a YAML file or one of nuscenes, "
                                               "nuscenes_training, nuscenes_training_less_one, object, "
                                               "semantic_kitti, semantic_kitti_training, "
                                               "semantic_kitti_training_less_one");
    }
}

TEST(ClassTable, FilesThatNeverEndAreNotBegunWith)
{
  const auto pipe = std::filesystem::temp_directory_path() / ("class_table_pipe_" + std::to_string(getpid()));
  ASSERT_EQ(mkfifo(pipe.c_str(), 0600), 0);
  for (const std::string& name : {pipe.string(), std::string("/dev/zero")})
    EXPECT_THROW(ClassTable::load(name), std::runtime_error) << name;
  std::filesystem::remove(pipe);
  std::ofstream(pipe) << "#" << std::string(2 << 20, ' ');
  EXPECT_THROW(ClassTable::load(pipe.string()), std::runtime_error);
  std::filesystem::remove(pipe);
}

TEST(ClassTable, ShippedTablesAreTheFilesOfConfig)
{
  EXPECT_EQ(
      ClassTable::shippedNames(),
      std::vector<std::string>({"nuscenes", "nuscenes_training", "nuscenes_training_less_one", "object",
                                "semantic_kitti", "semantic_kitti_training", "semantic_kitti_training_less_one"}));
  for (const auto& name : ClassTable::shippedNames())
  {
    const ClassTable shipped = ClassTable::load(name), file = ClassTable::load("config/" + name + ".yaml");
    EXPECT_EQ(shipped.name(), name);
    ASSERT_EQ(shipped.size(), file.size());
    for (std::size_t i = 1; i < shipped.size(); ++i)
    {
      const ClassInfo &a = shipped[static_cast<ClassIndex>(i)], &b = file[static_cast<ClassIndex>(i)];
      EXPECT_EQ(a.name, b.name);
      EXPECT_EQ(a.ids, b.ids);
      EXPECT_EQ(a.rgb, b.rgb);
      EXPECT_EQ(a.aliases, b.aliases);
    }
  }
  EXPECT_EQ(ClassTable::load("nuscenes")[ClassTable::load("nuscenes").find(17)].name, "car");
}

/// The learning map of the data set's official evaluator.
TEST(ClassTable, SemanticKittiIsItsOfficialLearningMap)
{
  const std::map<std::string, std::set<std::uint32_t>> things = {
      {"car", {10, 252}},
      {"bicycle", {11}},
      {"motorcycle", {15}},
      {"truck", {18, 258}},
      {"other-vehicle", {13, 16, 20, 256, 257, 259}},
      {"person", {30, 254}},
      {"bicyclist", {31, 253}},
      {"motorcyclist", {32, 255}},
  };
  const std::map<std::string, std::set<std::uint32_t>> stuff = {
      {"road", {40, 60}}, {"parking", {44}}, {"sidewalk", {48}},     {"other-ground", {49}},
      {"building", {50}}, {"fence", {51}},   {"vegetation", {70}},   {"trunk", {71}},
      {"terrain", {72}},  {"pole", {80}},    {"traffic-sign", {81}},
  };
  const ClassTable table = ClassTable::load("semantic_kitti");
  std::map<std::string, std::set<std::uint32_t>> found_things, found_stuff;
  std::set<std::uint32_t> found_ignored;
  for (std::uint32_t id = 0; id < 70000; ++id)
  {
    const ClassIndex index = table.find(id);
    const ClassInfo& info = table[index];
    if (info.kind == ClassKind::kThing) found_things[info.name].insert(id);
    if (info.kind == ClassKind::kStuff) found_stuff[info.name].insert(id);
    if (info.kind == ClassKind::kIgnored && index != kUnknownClass) found_ignored.insert(id);
  }
  EXPECT_EQ(found_things, things);
  EXPECT_EQ(found_stuff, stuff);
  EXPECT_EQ(found_ignored, std::set<std::uint32_t>({0, 1, 52, 99}));
}

/// learning_map of semantic-kitti-api, and the order of nuScenes' challenge.
TEST(ClassTable, TrainingIdsAreTheirDataSets)
{
  const std::vector<std::string> kitti = {"car",      "bicycle",      "motorcycle",   "truck",       "other-vehicle",
                                          "person",   "bicyclist",    "motorcyclist", "road",        "parking",
                                          "sidewalk", "other-ground", "building",     "fence",       "vegetation",
                                          "trunk",    "terrain",      "pole",         "traffic-sign"};
  const std::vector<std::string> nuscenes = {
      "barrier",    "bicycle",      "bus",     "car",       "construction_vehicle", "motorcycle",
      "pedestrian", "traffic_cone", "trailer", "truck",     "driveable_surface",    "other_flat",
      "sidewalk",   "terrain",      "manmade", "vegetation"};
  for (const auto& [name, classes] : {std::make_pair(std::string("semantic_kitti"), kitti), {"nuscenes", nuscenes}})
  {
    const ClassTable raw = ClassTable::load(name), from_one = ClassTable::load(name + "_training"),
                     from_zero = ClassTable::load(name + "_training_less_one");
    ASSERT_EQ(raw.size(), classes.size() + 2) << name;
    for (std::uint32_t i = 0; i < classes.size(); ++i)
      for (const ClassInfo& info : {from_one[from_one.find(i + 1)], from_zero[from_zero.find(i)]})
      {
        EXPECT_EQ(info.name, classes[i]) << name << " " << i;
        const ClassInfo& same = raw[raw.findByName(classes[i])];
        EXPECT_EQ(info.kind, same.kind) << info.name;
        EXPECT_EQ(info.rgb, same.rgb) << info.name;
        EXPECT_EQ(info.length_m, same.length_m) << info.name;
        EXPECT_EQ(info.link_distance_m, same.link_distance_m) << info.name;
        EXPECT_EQ(info.aliases, same.aliases) << info.name;
      }
    EXPECT_EQ(from_one[from_one.find(0)].name, "ignored");
    EXPECT_EQ(from_zero[from_zero.find(255)].name, "ignored");
    EXPECT_FALSE(raw.ignoresMinusOne() || from_one.ignoresMinusOne());
    EXPECT_TRUE(from_zero.ignoresMinusOne());
  }
}

TEST(ClassTable, MinusOneIsIgnoredOrNothing)
{
  const std::string classes = "classes: [{name: road, kind: stuff, ids: [40], color: [1, 2, 3]}]";
  EXPECT_TRUE(ClassTable::parse("minus_one: ignored\n" + classes, "my.yaml").ignoresMinusOne());
  EXPECT_EQ(errorOf("minus_one: road\n" + classes), "my.yaml: minus_one must be 'ignored', or not there");
}
}  // namespace
}  // namespace lidar_panoptic_clustering

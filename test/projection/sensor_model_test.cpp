#include "lidar_panoptic_clustering/projection/sensor_model.h"

#include "recorded_data.h"

#include <gtest/gtest.h>

#include <pcl/io/pcd_io.h>
#include <pcl/point_types.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <limits>
#include <numeric>
#include <stdexcept>

namespace lidar_panoptic_clustering
{
namespace
{
float degrees(float radians)
{
  return radians * 57.2957795F;
}

TEST(SensorModel, ReadsALiteralFile)
{
  const SensorModel model = SensorModel::parse(R"(
name: mine
elevations_deg: [10, 0.5, -30]
columns: 90
horizontal_fov_deg: 90
min_range_m: 0.25
max_range_m: 40
range_noise_m: 0.125
dropout: 0.5
mount_height_m: 2
)",
                                               "mine.yaml");
  EXPECT_EQ(model.name, "mine");
  ASSERT_EQ(model.rows(), 3U);
  EXPECT_FLOAT_EQ(model.elevations_rad[0], 0.174532925F);
  EXPECT_FLOAT_EQ(model.elevations_rad[1], 0.00872664626F);
  EXPECT_FLOAT_EQ(model.elevations_rad[2], -0.523598776F);
  EXPECT_EQ(model.columns, 90U);
  EXPECT_FALSE(model.fullTurn());
  EXPECT_NEAR(degrees(model.azimuth(0)), 44.5F, 1e-4F);
  EXPECT_NEAR(degrees(model.azimuth(89)), -44.5F, 1e-4F);
  EXPECT_EQ(model.min_range_m, 0.25F);
  EXPECT_EQ(model.max_range_m, 40.0F);
  EXPECT_EQ(model.range_noise_m, 0.125F);
  EXPECT_EQ(model.dropout, 0.5F);
  EXPECT_EQ(model.mount_height_m, 2.0F);
}

TEST(SensorModel, NeedsOnlyElevationsAndColumns)
{
  const SensorModel model = SensorModel::parse("{elevations_deg: [0], columns: 4}", "mine.yaml");
  EXPECT_EQ(model.name, "mine.yaml");
  EXPECT_TRUE(model.fullTurn());
  EXPECT_NEAR(degrees(model.azimuth(0)), 135.0F, 1e-4F);
  EXPECT_NEAR(degrees(model.azimuth(3)), -135.0F, 1e-4F);
  EXPECT_EQ(model.max_range_m, SensorModel().max_range_m);
}

struct Shipped
{
  const char* file;
  const char* name;
  std::uint32_t rows, columns;
  float highest_deg, second_deg, lowest_deg, max_range_m;
};

TEST(SensorModel, ShippedSensorsHaveTheirMakersFigures)
{
  const std::vector<Shipped> sensors = {
      {"hdl32e", "HDL-32E", 32, 2170, 10.67F, 9.33F, -30.67F, 100.0F},
      {"hdl64e", "HDL-64E", 64, 2048, 2.0F, 1.667F, -24.33F, 120.0F},
      {"os1_128", "OS1-128", 128, 1024, 20.95F, 20.67F, -21.82F, 120.0F},
      {"os1_64", "OS1-64", 64, 1024, 16.611F, 16.084F, -16.611F, 120.0F},
      {"pandar64", "Pandar64", 64, 1800, 14.882F, 11.032F, -24.897F, 200.0F},
      {"vlp16", "VLP-16", 16, 1808, 15.0F, 13.0F, -15.0F, 100.0F},
      {"vlp32c", "VLP-32C", 32, 1808, 15.0F, 10.333F, -25.0F, 200.0F},
  };
  std::vector<std::string> names;
  for (const Shipped& expected : sensors)
  {
    names.push_back(expected.file);
    const SensorModel model = SensorModel::load(expected.file);
    EXPECT_EQ(model.name, expected.name);
    ASSERT_EQ(model.rows(), expected.rows) << expected.name;
    EXPECT_EQ(model.columns, expected.columns) << expected.name;
    EXPECT_NEAR(degrees(model.elevations_rad[0]), expected.highest_deg, 1e-3F) << expected.name;
    EXPECT_NEAR(degrees(model.elevations_rad[1]), expected.second_deg, 1e-3F) << expected.name;
    EXPECT_NEAR(degrees(model.elevations_rad.back()), expected.lowest_deg, 1e-3F) << expected.name;
    EXPECT_EQ(model.max_range_m, expected.max_range_m) << expected.name;
    EXPECT_TRUE(model.fullTurn()) << expected.name;
  }
  EXPECT_EQ(SensorModel::shippedNames(), names);
}

TEST(SensorModel, TablesThatAreNotRegularAreCopiedWhole)
{
  const auto sum = [](const char* name)
  {
    const SensorModel model = SensorModel::load(name);
    return degrees(std::accumulate(model.elevations_rad.begin(), model.elevations_rad.end(), 0.0F));
  };
  // the sums of vert_correction in the calibration files of velodyne_pointcloud
  EXPECT_NEAR(sum("vlp32c"), -62.528F, 0.01F);
  EXPECT_NEAR(sum("hdl32e"), -320.01F, 0.02F);
  EXPECT_NEAR(sum("vlp16"), 0.0F, 1e-3F);
  EXPECT_NEAR(sum("os1_64"), 0.0F, 1e-3F);
}

std::string errorOf(const std::string& yaml)
{
  try
  {
    SensorModel::parse(yaml, "my.yaml");
  }
  catch (const std::invalid_argument& error)
  {
    return error.what();
  }
  return "";
}

TEST(SensorModel, NamesFileKeyExpectedAndFoundInEachError)
{
  EXPECT_EQ(errorOf("{elevations_deg: [1, 0], columns: 4}"), "");
  EXPECT_EQ(errorOf("[1, 2]"), "my.yaml: expected a map with 'elevations_deg' and 'columns'");
  EXPECT_EQ(errorOf(""), "my.yaml: expected a map with 'elevations_deg' and 'columns'");
  EXPECT_EQ(errorOf("{columns: 4").find("my.yaml: not a YAML file: "), 0U);
  EXPECT_EQ(errorOf("{columns: 4}"), "my.yaml: has no 'elevations_deg', expected a list of angles, the highest first");
  EXPECT_EQ(errorOf("{elevations_deg: [1, up], columns: 4}"),
            "my.yaml: 'elevations_deg': expected a list of angles, the highest first, found [1, up]");
  EXPECT_EQ(errorOf("{elevations_deg: [], columns: 4}"), "my.yaml: number of elevations: expected 1 to 4096, found 0");
  EXPECT_EQ(errorOf("{elevations_deg: [1, 2], columns: 4}"),
            "my.yaml: elevation of ring 1: expected less than the ring's before, 1, found 2");
  EXPECT_EQ(errorOf("{elevations_deg: [1, 1], columns: 4}"),
            "my.yaml: elevation of ring 1: expected less than the ring's before, 1, found 1");
  EXPECT_EQ(errorOf("{elevations_deg: [100], columns: 4}"),
            "my.yaml: elevation of ring 0: expected an angle between -90 and 90 degrees, found 100");
  EXPECT_EQ(errorOf("{elevations_deg: [.nan], columns: 4}"),
            "my.yaml: elevation of ring 0: expected an angle between -90 and 90 degrees, found nan");
  EXPECT_EQ(errorOf("{elevations_deg: [0]}"), "my.yaml: has no 'columns', expected the number of firings");
  EXPECT_EQ(errorOf("{elevations_deg: [0], columns: -1}"), "my.yaml: columns: expected 1 to 65536, found -1");
  EXPECT_EQ(errorOf("{elevations_deg: [0], columns: 4294967296}"),
            "my.yaml: columns: expected 1 to 65536, found 4294967296");
  EXPECT_EQ(errorOf("{elevations_deg: [0], columns: 1e3}"),
            "my.yaml: 'columns': expected the number of firings, found 1e3");
  EXPECT_EQ(errorOf("{elevations_deg: [0], columns: 0}"), "my.yaml: columns: expected 1 to 65536, found 0");
  EXPECT_EQ(errorOf("{elevations_deg: [0], columns: 4, horizontal_fov_deg: 0}"),
            "my.yaml: horizontal field of view: expected 0.1 to 360 degrees, found 0");
  EXPECT_EQ(errorOf("{elevations_deg: [0], columns: 4, horizontal_fov_deg: 400}"),
            "my.yaml: horizontal field of view: expected 0.1 to 360 degrees, found 400");
  EXPECT_EQ(errorOf("{elevations_deg: [0], columns: 4, max_range_m: 0.1}"),
            "my.yaml: max_range_m: expected more than min_range_m and at most 10000, found 0.1");
  EXPECT_EQ(errorOf("{elevations_deg: [0], columns: 4, max_range_m: far}"),
            "my.yaml: 'max_range_m': expected a distance, found far");
  EXPECT_EQ(errorOf("{elevations_deg: [0], columns: 4, dropout: 2}"),
            "my.yaml: dropout: expected a probability, found 2");
  EXPECT_EQ(errorOf("{elevations_deg: [0], columns: 4, mount_height_m: 0}"),
            "my.yaml: mount_height_m: expected 0.01 to 1000, found 0");
  for (const std::string key : {"horizontal_fov_deg", "min_range_m", "max_range_m", "range_noise_m", "mount_height_m"})
    for (const std::string number : {"-1", ".nan", ".inf", "1e30"})
      EXPECT_NE(errorOf("{elevations_deg: [0], columns: 4, " + key + ": " + number + "}").find(": expected "),
                std::string::npos)
          << key << " " << number;
  for (const std::string key : {"horizontal_fov_deg", "max_range_m", "mount_height_m"})
    EXPECT_NE(errorOf("{elevations_deg: [0], columns: 4, " + key + ": 1e-30}"), "") << key;
  EXPECT_EQ(errorOf("{elevations_deg: [0], columns: 4, colums: 5}"),
            "my.yaml: unknown key 'colums', expected one of name, elevations_deg, columns, horizontal_fov_deg, "
            "min_range_m, max_range_m, range_noise_m, dropout, mount_height_m");
}

TEST(SensorModel, SaysWhichSensorsThereAre)
{
  try
  {
    SensorModel::load("vlp17");
    FAIL() << "nothing was thrown";
  }
  catch (const std::runtime_error& error)
  {
    EXPECT_EQ(std::string(error.what()),
              "sensor 'vlp17': cannot be read; expected a YAML file or one of hdl32e, hdl64e, os1_128, os1_64, "
              "pandar64, vlp16, vlp32c");
  }
}

TEST(SensorModel, LoadsAFile)
{
  const std::string path = testing::TempDir() + "sensor_model_test.yaml";
  std::ofstream(path) << "{elevations_deg: [3, 1], columns: 7}";
  EXPECT_EQ(SensorModel::load(path).columns, 7U);
  std::ofstream(path) << "{elevations_deg: [3, 1], columns: many}";
  try
  {
    SensorModel::load(path);
    FAIL() << "nothing was thrown";
  }
  catch (const std::invalid_argument& error)
  {
    EXPECT_EQ(error.what(), path + ": 'columns': expected the number of firings, found many");
  }
  std::filesystem::remove(path);
}

/// The middle one of a ring's elevations [deg], seen from a point on the sensor's axis `up_m` above its frame's origin
/// and `out_m` away from the axis; NaN where it has fewer than 20 returns.
float medianElevation(const pcl::PointCloud<pcl::PointXYZ>& cloud, std::uint32_t row, float up_m, float out_m)
{
  std::vector<float> elevations;
  for (std::uint32_t column = 0; column < cloud.width; ++column)
  {
    const auto& p = cloud.at(column, row);
    const float out = std::hypot(p.x, p.y);
    if (std::isfinite(p.x) && out > 0.5F) elevations.push_back(degrees(std::atan2(p.z - up_m, out - out_m)));
  }
  if (elevations.size() < 20) return std::numeric_limits<float>::quiet_NaN();
  const auto middle = elevations.begin() + static_cast<std::ptrdiff_t>(elevations.size() / 2);
  std::nth_element(elevations.begin(), middle, elevations.end());
  return *middle;
}

pcl::PointCloud<pcl::PointXYZ> readPcd(const std::string& path)
{
  pcl::PCLPointCloud2 file;
  if (pcl::io::loadPCDFile(path, file) != 0) throw std::runtime_error(path + ": cannot be read");
  pcl::PointCloud<pcl::PointXYZ> cloud(file.width, file.height);
  const bool wide = file.fields.at(0).datatype == pcl::PCLPointField::FLOAT64;
  const auto coordinate = [&](std::size_t i, std::size_t axis)
  {
    const std::uint8_t* at = &file.data[i * file.point_step + file.fields.at(axis).offset];
    double number;
    float small;
    std::memcpy(&number, at, wide ? sizeof number : 0);
    std::memcpy(&small, at, sizeof small);
    return wide ? static_cast<float>(number) : small;
  };
  for (std::size_t i = 0; i < cloud.size(); ++i)
    cloud.points[i] = pcl::PointXYZ(coordinate(i, 0), coordinate(i, 1), coordinate(i, 2));
  return cloud;
}

TEST(RecordedSensors, OusterRingsLieWhereTheFileSays)
{
  REQUIRE_RECORDED_DATA(data);
  const SensorModel model = SensorModel::load("os1_128");
  for (const std::string name : {"os1_128_1024_0.pcd", "os1_128_1024_1.pcd"})
  {
    const auto cloud = readPcd(data + "/ouster/" + name);
    ASSERT_EQ(cloud.height, model.rows());
    EXPECT_EQ(cloud.width, model.columns);
    for (std::uint32_t row = 0; row < model.rows(); ++row)
      EXPECT_NEAR(medianElevation(cloud, row, 0.03618F, 0.015806F), degrees(model.elevations_rad[row]), 0.006F)
          << name << " row " << row;
  }
}

// The recording's own sensor differs from the maker's table by up to 0.17 degrees, and it was sorted into rows by
// elevation, whereby sparse rings (1 degree apart and more) took in each other's points: only the dense ones are
// compared.
TEST(RecordedSensors, PandarRingsLieWhereTheFileSays)
{
  REQUIRE_RECORDED_DATA(data);
  const SensorModel model = SensorModel::load("pandar64");
  for (const std::string name : {"0001.pcd", "0002.pcd", "0003.pcd"})
  {
    const auto cloud = readPcd(data + "/pandaset/" + name);
    ASSERT_EQ(cloud.height, model.rows());
    for (std::uint32_t row = 6; row < 53; ++row)
      EXPECT_NEAR(medianElevation(cloud, row, 0.0F, 0.0F), degrees(model.elevations_rad[row]), 0.2F)
          << name << " row " << row;
  }
}
}  // namespace
}  // namespace lidar_panoptic_clustering

// The classes of points that the range image hides, where its labels come by pixel.
#include "lidar_panoptic_clustering/projection/organized_scan.h"

#include "scan_fixture.h"
#include "unordered_clouds.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <optional>
#include <random>

namespace lidar_panoptic_clustering
{
namespace
{
using Labels = std::vector<std::uint32_t>;
constexpr std::uint32_t kNoClass = 99;

OrganizedScan projected(const std::vector<ScanPoint>& points, const std::vector<std::uint32_t>& rows,
                        std::uint32_t height, std::uint32_t width)
{
  OrganizedScan scan;
  scan.points = points;
  scan.labels.assign(points.size(), 0);
  scan.organized_input = false;
  std::vector<PointDirection> directions;
  for (std::size_t i = 0; i < points.size(); ++i)
    directions.push_back({hasDirection(points[i]) ? fastAzimuth(points[i].x, points[i].y) : NAN, rows[i]});
  DirectionProjector().project(points, {}, directions, height, width, 0xFFFFFFFFU, scan.image);
  return scan;
}

bool isShown(const OrganizedScan& scan, std::uint32_t i)
{
  return scan.image.owner_of_pixel[scan.image.pixel_of_point[i]] == i;
}

/// The label by the rule, over all points; nothing where two of different labels are as near to float's precision.
std::optional<std::uint32_t> expectedLabel(const OrganizedScan& scan, const Labels& label_of_pixel, std::uint32_t i)
{
  const auto width = static_cast<int>(scan.image.cloud.width);
  const ScanPoint& p = scan.points[i];
  const auto pixelOf = [&](std::uint32_t j) { return static_cast<int>(scan.image.pixel_of_point[j]); };
  const double limit = std::min(0.2, std::max(0.1, 2.0 * std::hypot(p.x, p.y) * 2.0 * M_PI / width));
  double least = limit, second = limit;
  std::uint32_t label = kNoClass, second_label = kNoClass;
  for (std::uint32_t j = 0; j < scan.points.size(); ++j)
  {
    if (!isShown(scan, j)) continue;
    const int rows = std::abs(pixelOf(i) / width - pixelOf(j) / width);
    int columns = std::abs(pixelOf(i) % width - pixelOf(j) % width);
    columns = std::min(columns, width - columns);
    if (rows > 2 || columns > 2) continue;
    const ScanPoint& q = scan.points[j];
    const double distance = std::hypot(double{p.x} - q.x, double{p.y} - q.y, double{p.z} - q.z);
    if (distance < least)
      second = least, second_label = label, least = distance, label = label_of_pixel[scan.image.pixel_of_point[j]];
    else if (distance < second)
      second = distance, second_label = label_of_pixel[scan.image.pixel_of_point[j]];
  }
  if (second - least < 1e-4 && second_label != label) return std::nullopt;
  return label;
}

TEST(HiddenClasses, AreThoseOfTheNearestShownPoints)
{
  // one row of 36 columns, 10 degrees each: a car at 5 m hides points of a wall at 9 m that the next column shows, a
  // point far behind both, a return that is none, and a second point of its own
  const auto at = [](double degrees, double range)
  {
    const double azimuth = degrees * M_PI / 180.0;
    return ScanPoint{static_cast<float>(range * std::cos(azimuth)), static_cast<float>(range * std::sin(azimuth)), 0,
                     0};
  };
  const std::vector<ScanPoint> points = {at(95, 5),  at(99.5, 9),        at(100.5, 9),
                                         at(95, 40), {NAN, NAN, NAN, 0}, at(95, 5.2)};
  OrganizedScan scan = projected(points, Labels(points.size(), 0), 1, 36);
  Labels pixels(36, 7);
  pixels[scan.image.pixel_of_point[0]] = kCar;
  pixels[scan.image.pixel_of_point[2]] = 50;
  labelPixels(scan, pixels, kNoClass);
  EXPECT_EQ(scan.labels, (Labels{kCar, 50, 50, kNoClass, kNoClass, kCar}));
}

TEST(HiddenClasses, FollowTheRuleOnRandomScans)
{
  std::mt19937 random(3);
  std::uniform_real_distribution<float> unit(0.0F, 1.0F);
  for (int round = 0; round < 40; ++round)
  {
    const std::uint32_t height = 1 + round % 6, width = round % 5 == 0 ? 16 : 40 + static_cast<std::uint32_t>(round);
    std::vector<ScanPoint> points;
    Labels rows, pixels;
    for (std::uint32_t i = 0; i < 3 * height * width; ++i)
    {
      const float azimuth = 6.2831853F * unit(random), range = 0.3F + 6.0F * unit(random) * unit(random);
      points.push_back({range * std::cos(azimuth), range * std::sin(azimuth), 0.3F * unit(random), 0.0F});
      if (i % 50 == 0) points.back().x = NAN;
      rows.push_back(i % height);
    }
    for (std::uint32_t i = 0; i < height * width; ++i) pixels.push_back(1 + static_cast<std::uint32_t>(random() % 5));
    OrganizedScan scan = projected(points, rows, height, width);
    labelPixels(scan, pixels, kNoClass);
    std::size_t hidden = 0, near = 0;
    for (std::uint32_t i = 0; i < points.size(); ++i)
    {
      if (isShown(scan, i))
      {
        ASSERT_EQ(scan.labels[i], pixels[scan.image.pixel_of_point[i]]);
        continue;
      }
      ++hidden, near += scan.labels[i] != kNoClass ? 1 : 0;
      const auto expected = expectedLabel(scan, pixels, i);
      ASSERT_EQ(scan.labels[i], expected.value_or(scan.labels[i])) << "round " << round << ", point " << i;
    }
    EXPECT_GT(near, hidden / 20);
    EXPECT_LT(near, hidden);
  }
}

TEST(HiddenClasses, OrganisedCloudsHideNothing)
{
  const LabelledCloud scene = randomScan(3, 8, 64);
  std::uint32_t step = 0;
  constexpr auto kF32 = NumberType::kFloat32;
  RawMessage raw(8, 64, packed({{"x", kF32}, {"y", kF32}, {"z", kF32}}, step), step);
  for (std::uint32_t i = 0; i < scene.size(); ++i)
    raw.setPoint(i / 64, i % 64, scene.points[i].x, scene.points[i].y, scene.points[i].z);
  OrganizerConfig config;
  config.labels = false;
  OrganizedScan scan = organized(raw, config);
  Labels pixels(scene.size());
  for (std::uint32_t i = 0; i < pixels.size(); ++i) pixels[i] = i;
  labelPixels(scan, pixels, kNoClass);
  EXPECT_EQ(scan.labels, pixels) << "pixels without a return included";
}

/// 2250 firings a turn, as a sensor fires that is not in step with the image's 2048 columns.
TEST(HiddenClasses, AreRightInTheSimulatedStreet)
{
  for (const char* sensor : {"hdl64e", "vlp16"})
  {
    SensorModel model = SensorModel::load(sensor);
    model.columns = 2250;
    LidarSimulator simulator(model);
    PanopticCloud truth;
    std::size_t hidden = 0, right = 0, none = 0, by_pixel = 0;
    for (const std::uint64_t frame : {0, 70})
    {
      simulator.scan(frame, truth);
      std::vector<ScanPoint> points;
      Labels rows, labels;
      for (std::uint32_t i = 0; i < truth.size(); ++i)
      {
        const PanopticPoint& p = truth.points[i];
        if (!std::isfinite(p.x)) continue;
        points.push_back({p.x, p.y, p.z, 0.0F});
        rows.push_back(i / truth.width);
        labels.push_back(p.label);
      }
      OrganizedScan scan = projected(points, rows, truth.height, 2048);
      Labels pixels(scan.image.cloud.size(), 0);
      for (std::uint32_t pixel = 0; pixel < pixels.size(); ++pixel)
        if (scan.image.owner_of_pixel[pixel] != Projection::kNone)
          pixels[pixel] = labels[scan.image.owner_of_pixel[pixel]];
      labelPixels(scan, pixels, kNoClass);
      for (std::uint32_t i = 0; i < points.size(); ++i)
      {
        if (isShown(scan, i)) continue;
        ++hidden;
        right += scan.labels[i] == labels[i] ? 1 : 0;
        none += scan.labels[i] == kNoClass ? 1 : 0;
        by_pixel += pixels[scan.image.pixel_of_point[i]] == labels[i] ? 1 : 0;
      }
    }
    const auto percent = [hidden](std::size_t count)
    { return 100.0 * static_cast<double>(count) / static_cast<double>(hidden); };
    std::printf("%s: %zu hidden, %.2f %% right, %.2f %% without a class, %.2f %% wrong, by pixel %.2f %% right\n",
                sensor, hidden, percent(right), percent(none), percent(hidden - right - none), percent(by_pixel));
    EXPECT_GT(hidden, 1000U);
    EXPECT_LT(percent(hidden - right - none), 1.0);
    EXPECT_GT(percent(right), 90.0);
  }
}
}  // namespace
}  // namespace lidar_panoptic_clustering

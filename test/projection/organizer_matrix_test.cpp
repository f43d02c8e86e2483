// Every sequence of points x every declared shape x every field set x every layout setting: an image with the right
// rows, or a refusal; never an image with wrong ones.
#include "synthetic_scans.h"

#include <gtest/gtest.h>

#include <chrono>
#include <map>
#include <optional>

namespace lidar_panoptic_clustering
{
namespace
{
constexpr double kLeastRight = 0.97, kMostHidden = 0.02;

std::vector<double> elevationsOf(const std::string& sensor)
{
  std::vector<double> degrees;
  for (const float elevation : SensorModel::load(sensor).elevations_rad) degrees.push_back(elevation * 180.0 / M_PI);
  return degrees;
}

/// A sensor with the same scan in `firings` a turn, for image columns that fit.
OrganizerConfig configOf(const std::string& layout, const std::string& sensor, std::uint32_t firings)
{
  OrganizerConfig config;
  config.layout = layout;
  config.labels = false;
  if (sensor.empty()) return config;
  config.sensor = sensor;
  config.columns = static_cast<int>(firings);
  return config;
}

struct Case
{
  SyntheticOrder order;
  std::string layout;
  bool right_sensor = false, wrong_sensor = false;

  bool isOneRow() const
  {
    return order.declared == Declared::kOneRow || order.declared == Declared::kOneRowDense ||
           order.declared == Declared::kOneColumn;
  }

  /// What the README promises.
  bool mustBeTaken() const
  {
    const bool ring = order.ring != RingField::kNone, along = order.laid == Laid::kRingAfterRing;
    const bool grid = !isOneRow() && (along || order.laid == Laid::kFiringAfterFiring);
    if (wrong_sensor) return false;
    if (layout == "ring") return ring || grid;
    if (layout == "organized") return grid;
    if (layout == "unfold") return along;
    if (layout == "beams") return right_sensor;
    return ring || grid || (isOneRow() && (along || right_sensor));
  }

  std::string text() const
  {
    return "channels " + std::to_string(static_cast<int>(order.channels)) + " laid " +
           std::to_string(static_cast<int>(order.laid)) + " declared " +
           std::to_string(static_cast<int>(order.declared)) + " ring " + std::to_string(static_cast<int>(order.ring)) +
           " layout " + layout + (right_sensor ? " sensor" : "") + (wrong_sensor ? " wrong sensor" : "");
  }
};

std::vector<SyntheticOrder> allOrders()
{
  std::vector<SyntheticOrder> orders;
  for (const auto channels :
       {Channels::kHighestFirst, Channels::kLowestFirst, Channels::kRoboSense, Channels::kAlternating})
    for (const auto laid : {Laid::kRingAfterRing, Laid::kFiringAfterFiring, Laid::kFiringsShuffled, Laid::kShuffled})
      for (const auto declared : {Declared::kOneRowDense, Declared::kOneRow, Declared::kOneColumn,
                                  Declared::kRingsByFirings, Declared::kFiringsByRings})
        for (const auto ring : {RingField::kNone, RingField::kFromTheBottom, RingField::kChannel})
          orders.push_back({channels, laid, declared, ring});
  return orders;
}

/// Organizers as they are before the first cloud: making one reads a sensor file.
using Makers = std::map<std::pair<std::string, std::string>, Organizer>;

Makers makeOrganizers(const std::vector<std::string>& sensors, std::uint32_t firings)
{
  Makers makers;
  for (const std::string& sensor : sensors)
    for (const std::string& layout : layoutNames())
      if (layout != "merged" && (layout != "beams" || !sensor.empty()))
        makers.emplace(std::make_pair(sensor, layout), Organizer(configOf(layout, sensor, firings)));
  return makers;
}

class OrganizerMatrix : public testing::TestWithParam<std::string>
{
protected:
  void holdToTheRule(const SyntheticScan& scan, const SyntheticCloud& cloud, const Case& c, const Organizer& maker)
  {
    Organizer organizer = maker;
    ++cases_;
    const std::string error = errorOf([&] { organizer.organize(cloud.message.view(), image_); });
    if (!error.empty())
    {
      ++refused_;
      EXPECT_FALSE(c.mustBeTaken()) << c.text() << ": " << error;
      EXPECT_EQ(error.find("destaggering"), std::string::npos) << c.text() << ": " << error;
      EXPECT_NE(error.find("found"), std::string::npos) << c.text() << ": " << error;
      return;
    }
    const ImageFigures figures = figuresOf(image_, cloud, scan);
    const double unavoidable = std::max(0.0, 1.0 - static_cast<double>(figures.columns) / scan.firings);
    EXPECT_GE(figures.right_rows, kLeastRight) << c.text() << ": " << describe(organizer.found());
    EXPECT_LE(figures.hidden, unavoidable + kMostHidden) << c.text() << ": " << describe(organizer.found());
    EXPECT_EQ(organizer.found().rows, figures.rows);
    if (c.right_sensor)
    {
      EXPECT_EQ(figures.rows, scan.rows) << c.text();
    }
  }

  OrganizedScan image_;
  int cases_ = 0, refused_ = 0;
};

TEST_P(OrganizerMatrix, GivesTheRightRowsOrRefuses)
{
  const std::string sensor = GetParam(), wrong = sensor == "vlp32c" ? "hdl32e" : "vlp32c";
  SyntheticLidar lidar;
  lidar.elevations_deg = elevationsOf(sensor);
  lidar.firings = 150;
  const Makers makers = makeOrganizers({"", sensor, wrong}, lidar.firings);
  const std::vector<std::pair<double, bool>> sweeps = {{0.0, false}, {180.0, true}, {77.0, true}, {-133.0, false}};
  std::size_t next = 0;
  for (const SyntheticOrder& order : allOrders())
  {
    // each order begins another way; two ways where they decide
    const std::size_t ways = order.laid == Laid::kRingAfterRing ? sweeps.size() : 1;
    for (std::size_t way = 0; way < ways; ++way, ++next)
    {
      std::tie(lidar.start_deg, lidar.clockwise) = sweeps[next % sweeps.size()];
      const SyntheticScan scan = scanOf(lidar);
      const SyntheticCloud cloud = cloudOf(scan, order);
      for (const auto& [key, maker] : makers)
        holdToTheRule(scan, cloud, {order, key.second, key.first == sensor, key.first == wrong}, maker);
      if (testing::Test::HasFailure() && cases_ > 500) return;  // hundreds of lines say no more
    }
  }
  RecordProperty("cases", cases_);
  RecordProperty("refused", refused_);
  std::cout << sensor << ": " << cases_ << " cases, " << refused_ << " refused\n";
}

INSTANTIATE_TEST_SUITE_P(All, OrganizerMatrix, testing::ValuesIn(SensorModel::shippedNames()),
                         [](const auto& test) { return test.param; });
}  // namespace
}  // namespace lidar_panoptic_clustering

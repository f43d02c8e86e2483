// Points ring after ring in a frame that is tilted against the sensor's: the right rows, or a refusal that says so.
#include "synthetic_scans.h"

#include <gtest/gtest.h>
#include <Eigen/Geometry>

namespace lidar_panoptic_clustering
{
namespace
{
const SyntheticOrder kRingAfterRing{Channels::kHighestFirst, Laid::kRingAfterRing, Declared::kOneRowDense,
                                    RingField::kNone};

OrganizerConfig withoutLabels()
{
  OrganizerConfig config;
  config.labels = false;
  return config;
}

void tilt(SyntheticScan& scan, double degrees, const Eigen::Vector3d& about)
{
  const Eigen::Matrix3d rotation = Eigen::AngleAxisd(degrees * M_PI / 180.0, about.normalized()).toRotationMatrix();
  for (ScanPoint& p : scan.points)
  {
    const Eigen::Vector3d turned = rotation * Eigen::Vector3d(p.x, p.y, p.z);
    p.x = static_cast<float>(turned.x()), p.y = static_cast<float>(turned.y()), p.z = static_cast<float>(turned.z());
  }
}

/// Whole turns and sectors that begin at `start_deg` or have it in their middle, in either sense.
std::vector<SyntheticLidar> sweepsOf(const std::string& sensor)
{
  std::vector<SyntheticLidar> sweeps;
  for (const double field_of_view_deg : {360.0, 120.0, 40.0})
    for (const auto& [start_deg, clockwise] : {std::pair(0.0, false), std::pair(180.0, true), std::pair(77.0, true)})
    {
      SyntheticLidar lidar;
      for (const float elevation : SensorModel::load(sensor).elevations_rad)
        lidar.elevations_deg.push_back(elevation * 180.0 / M_PI);
      lidar.field_of_view_deg = field_of_view_deg;
      lidar.firings = static_cast<std::uint32_t>(256.0 * field_of_view_deg / 360.0);
      lidar.clockwise = clockwise;
      lidar.start_deg = start_deg;
      if (field_of_view_deg < 360.0) lidar.start_deg += (clockwise ? 0.5 : -0.5) * field_of_view_deg;
      sweeps.push_back(lidar);
    }
  return sweeps;
}

class OrganizerTilt : public testing::TestWithParam<std::string>
{
};

TEST_P(OrganizerTilt, GivesTheRightRowsOrRefuses)
{
  OrganizedScan image;
  int taken = 0, refused = 0;
  for (const SyntheticLidar& lidar : sweepsOf(GetParam()))
    for (const Eigen::Vector3d& about : {Eigen::Vector3d(1, 0, 0), Eigen::Vector3d(1, 1, 0)})
      for (const double degrees : {0.0, 5.0, 12.0, 20.0, 30.0, 45.0})
      {
        SyntheticScan scan = scanOf(lidar);
        tilt(scan, degrees, about);
        const SyntheticCloud cloud = cloudOf(scan, kRingAfterRing);
        Organizer organizer(withoutLabels());
        const std::string error = errorOf([&] { organizer.organize(cloud.message.view(), image); });
        const std::string text = std::to_string(degrees) + " degrees, " + std::to_string(lidar.field_of_view_deg) +
                                 " from " + std::to_string(lidar.start_deg);
        ++(error.empty() ? taken : refused);
        if (degrees == 0.0)
        {
          EXPECT_EQ(error, "") << text;
        }
        if (!error.empty()) continue;
        const ImageFigures figures = figuresOf(image, cloud, scan);
        EXPECT_GE(figures.right_rows, 0.97) << text << ": " << describe(organizer.found());
        EXPECT_LE(figures.hidden, degrees == 0.0 ? 0.0 : 0.04) << text;
      }
  std::cout << GetParam() << ": " << taken << " taken, " << refused << " refused\n";
}

INSTANTIATE_TEST_SUITE_P(All, OrganizerTilt, testing::ValuesIn(SensorModel::shippedNames()),
                         [](const auto& test) { return test.param; });

TEST(OrganizerTilts, AreNamed)
{
  SyntheticLidar lidar{{15, 13, 11, 9, 7, 5, 3, 1, -1, -3, -5, -7, -9, -11, -13, -15}};
  lidar.firings = 170, lidar.field_of_view_deg = 120.0, lidar.start_deg = 137.0;
  SyntheticScan scan = scanOf(lidar);
  tilt(scan, 30.0, Eigen::Vector3d(1, 0, 0));
  OrganizedScan image;
  Organizer organizer(withoutLabels());
  EXPECT_EQ(errorOf([&] { organizer.organize(cloudOf(scan, kRingAfterRing).message.view(), image); }),
            "expected a cloud in the sensor's own frame or one that is little tilted against it, found the sensor's "
            "axis 30 degrees from the cloud's z: publish the cloud in the sensor's frame");
}
}  // namespace
}  // namespace lidar_panoptic_clustering

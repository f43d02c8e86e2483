// Organised clouds whose rows or columns are not what a scan's are, and clouds in other frames than the sensor's: the
// right rows, or a refusal that says what was found.
#include "synthetic_scans.h"

#include <gtest/gtest.h>
#include <Eigen/Geometry>

#include <array>
#include <functional>

namespace lidar_panoptic_clustering
{
namespace
{
constexpr std::uint32_t kRows = 32, kColumns = 1024;

OrganizerConfig withoutLabels(const std::string& layout = "auto")
{
  OrganizerConfig config;
  config.layout = layout;
  config.labels = false;
  return config;
}

/// What a lidar 1.8 m above the street sees in a direction [rad].
ScanPoint seen(double azimuth, double elevation)
{
  const double x = std::cos(elevation) * std::cos(azimuth), y = std::cos(elevation) * std::sin(azimuth);
  const double z = std::sin(elevation), range = syntheticRange(x, y, z, 1.8);
  if (std::isinf(range)) return {NAN, NAN, NAN, 0.0F};
  return {static_cast<float>(range * x), static_cast<float>(range * y), static_cast<float>(range * z), 0.5F};
}

double elevationOf(std::uint32_t row)
{
  return (15.0 - 30.0 * row / (kRows - 1)) * M_PI / 180.0;
}

double azimuthOf(double firing)
{
  return -2.0 * M_PI * firing / kColumns;
}

using PointOf = std::function<ScanPoint(std::uint32_t row, std::uint32_t column)>;

RawMessage cloudOf(std::uint32_t rows, std::uint32_t columns, const PointOf& point)
{
  std::uint32_t step = 0;
  constexpr auto kF32 = NumberType::kFloat32;
  const auto fields = packed({{"x", kF32}, {"y", kF32}, {"z", kF32}}, step);
  RawMessage message(rows, columns, fields, step);
  for (std::uint32_t row = 0; row < rows; ++row)
    for (std::uint32_t column = 0; column < columns; ++column)
    {
      const ScanPoint p = point(row, column);
      message.setPoint(row, column, p.x, p.y, p.z);
    }
  return message;
}

std::string refusalOf(const RawMessage& message, const std::string& layout = "auto")
{
  OrganizedScan scan;
  return errorOf([&] { Organizer(withoutLabels(layout)).organize(message.view(), scan); });
}

std::vector<std::uint32_t> shuffledColumns()
{
  std::vector<std::uint32_t> columns(kColumns);
  std::iota(columns.begin(), columns.end(), 0U);
  std::shuffle(columns.begin(), columns.end(), std::mt19937(5));
  return columns;
}

TEST(OrganizerColumns, InNoSequenceOfAzimuth)
{
  const auto shuffled = shuffledColumns();
  const PointOf in_no_sequence = [&](std::uint32_t row, std::uint32_t column)
  { return seen(azimuthOf(shuffled[column]), elevationOf(row)); };
  const PointOf to_and_fro = [](std::uint32_t row, std::uint32_t column)
  {
    const std::uint32_t block = column / 64, within = column % 64;
    return seen(azimuthOf(block * 64 + (block % 2 == 0 ? within : 63 - within)), elevationOf(row));
  };
  for (const PointOf& point : {in_no_sequence, to_and_fro})
  {
    const RawMessage message = cloudOf(kRows, kColumns, point);
    EXPECT_NE(
        refusalOf(message).find("expected columns in the sequence of their azimuth, found that it goes to and fro"),
        std::string::npos)
        << refusalOf(message);
    EXPECT_EQ(refusalOf(message, "ring"), "") << "what the text says helps";
  }
}

TEST(OrganizerColumns, OfSeveralTurns)
{
  // two scans, two returns of each firing, two lidars side by side; every fourth firing, then those beside it
  const PointOf two_scans = [](std::uint32_t row, std::uint32_t column)
  { return seen(azimuthOf(column), elevationOf(row)); };
  const PointOf in_blocks = [](std::uint32_t row, std::uint32_t column)
  { return seen(azimuthOf(column % 512 * 4 + column / 512), elevationOf(row)); };
  for (const PointOf& point : {two_scans, in_blocks})
    EXPECT_NE(
        refusalOf(cloudOf(kRows, 2 * kColumns, point)).find("expected at most one turn of the sensor, found columns"),
        std::string::npos);
  for (const std::uint32_t columns : {kColumns, kColumns + 9, kColumns * 5 / 4})  // drivers' packets end when they end
    EXPECT_EQ(refusalOf(cloudOf(kRows, columns, two_scans)), "") << columns;
}

TEST(OrganizerColumns, RowsThatShareTheirElevation)
{
  const std::string expected =
      "expected scan lines that each have an elevation of their own, found 64 rows x 1024 columns";
  const PointOf returns_side_by_side = [](std::uint32_t row, std::uint32_t column)
  { return seen(azimuthOf(column), elevationOf(row / 2)); };
  const PointOf first_then_second_returns = [](std::uint32_t row, std::uint32_t column)
  { return seen(azimuthOf(column), elevationOf(row % kRows)); };
  const PointOf all_flat = [](std::uint32_t row, std::uint32_t column)
  {
    ScanPoint p = seen(azimuthOf(column), elevationOf(row % kRows));
    p.z = 0.0F;
    return p;
  };
  for (const PointOf& point : {returns_side_by_side, first_then_second_returns, all_flat})
    EXPECT_NE(refusalOf(cloudOf(2 * kRows, kColumns, point)).find(expected), std::string::npos);
  const PointOf two_lidars = [&](std::uint32_t row, std::uint32_t column)
  {
    ScanPoint p = first_then_second_returns(row, column);
    p.y += row < kRows ? -1.0F : 1.0F;
    return p;
  };
  EXPECT_NE(refusalOf(cloudOf(2 * kRows, kColumns, two_lidars)).find("expected scan lines sorted by elevation"),
            std::string::npos);
}

/// RoboSense's M1: five lasers, each over a region of its own to and fro; the driver sends a column or a row a laser.
TEST(OrganizerColumns, OfALidarWithoutScanLines)
{
  const auto shot = [](std::uint32_t laser, std::uint32_t at)
  {
    const std::uint32_t line = at / 125, within = line % 2 == 0 ? at % 125 : 124 - at % 125;
    return seen((60.0 - 24.0 * laser - within / 5.0) * M_PI / 180.0, (12.5 - at / 630.0) * M_PI / 180.0);
  };
  const RawMessage by_shot =
      cloudOf(15750, 5, [&](std::uint32_t row, std::uint32_t column) { return shot(column, row); });
  const RawMessage by_laser = cloudOf(5, 15750, shot);
  for (const RawMessage* message : {&by_shot, &by_laser})
    for (const char* layout : {"auto", "organized", "ring"})
      EXPECT_NE(
          refusalOf(*message, layout)
              .find("expected at most 1024 scan lines, found 15750: set layout to 'merged' where the lidar has no "
                    "scan lines (RoboSense M1, Livox)"),
          std::string::npos)
          << refusalOf(*message, layout);
}

class OrganizerFrames : public testing::TestWithParam<std::string>
{
};

/// Of the sensor in the cloud's frame: forward, up [m], rolled by [rad].
using Mount = std::array<double, 3>;

void moveTo(const Mount& mount, SyntheticScan& scan)
{
  const auto roll = Eigen::AngleAxisd(mount[2], Eigen::Vector3d::UnitX()).toRotationMatrix();
  for (ScanPoint& p : scan.points)
  {
    const Eigen::Vector3f moved = (roll * Eigen::Vector3d(p.x + mount[0], p.y, p.z + mount[1])).cast<float>();
    p.x = moved.x(), p.y = moved.y(), p.z = moved.z();
  }
}

/// As a driver sends it that turns its clouds into the vehicle's frame.
TEST_P(OrganizerFrames, GiveTheRightRowsOrARefusal)
{
  SyntheticLidar lidar;
  for (const float elevation : SensorModel::load(GetParam()).elevations_rad)
    lidar.elevations_deg.push_back(elevation * 180.0 / M_PI);
  lidar.firings = 256;
  OrganizedScan image;
  int taken = 0, refused = 0;
  for (const Mount& mount : {Mount{0, 0, 0},
                             {0, 0.3, 0},
                             {0, 1.0, 0},
                             {0, 1.8, 0},
                             {1.5, 1.8, 0},
                             {2.5, 0.5, 0},
                             {3.0, 0, 0},
                             {0, -1.0, 0},
                             {0, 0, 0.1},
                             {0, 0, 0.3},
                             {0, 0, 0.5},
                             {1.0, 1.8, 0.1}})
  {
    SyntheticScan scan = scanOf(lidar);
    moveTo(mount, scan);
    for (const auto channels :
         {Channels::kHighestFirst, Channels::kLowestFirst, Channels::kRoboSense, Channels::kAlternating})
      for (const auto& [declared, laid, ring] :
           {std::tuple(Declared::kRingsByFirings, Laid::kRingAfterRing, RingField::kNone),
            std::tuple(Declared::kFiringsByRings, Laid::kFiringAfterFiring, RingField::kNone),
            std::tuple(Declared::kOneRowDense, Laid::kFiringAfterFiring, RingField::kFromTheBottom),
            std::tuple(Declared::kOneRowDense, Laid::kFiringAfterFiring, RingField::kChannel)})
      {
        const auto cloud = cloudOf(scan, {channels, laid, declared, ring});
        Organizer organizer(withoutLabels());
        const std::string error = errorOf([&] { organizer.organize(cloud.message.view(), image); });
        const bool sorted = channels == Channels::kHighestFirst || channels == Channels::kLowestFirst;
        const std::string text = GetParam() + " at " + std::to_string(mount[0]) + ' ' + std::to_string(mount[1]) + ' ' +
                                 std::to_string(mount[2]) + " channels " + std::to_string(static_cast<int>(channels)) +
                                 " declared " + std::to_string(static_cast<int>(declared));
        ++(error.empty() ? taken : refused);
        if (mount == Mount{0, 0, 0} || (sorted && mount[0] == 0.0 && std::abs(mount[1]) < 0.5 && mount[2] < 0.2))
        {
          EXPECT_EQ(error, "") << text;
        }
        if (error.empty())
        {
          EXPECT_GE(figuresOf(image, cloud, scan).right_rows, 0.97) << text << ": " << describe(organizer.found());
        }
      }
  }
  std::cout << GetParam() << ": " << taken << " taken, " << refused << " refused\n";
}

INSTANTIATE_TEST_SUITE_P(All, OrganizerFrames, testing::ValuesIn(SensorModel::shippedNames()),
                         [](const auto& test) { return test.param; });
}  // namespace
}  // namespace lidar_panoptic_clustering

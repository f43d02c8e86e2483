#include "projection/layout_errors.h"

#include "lidar_panoptic_clustering/projection/azimuth.h"
#include "lidar_panoptic_clustering/projection/row_finder.h"

#include <cmath>
#include <stdexcept>

namespace lidar_panoptic_clustering
{
namespace
{
std::string percent(double share)
{
  return std::to_string(std::lround(100.0 * share)) + " %";
}

std::string size(const RawCloud& raw)
{
  return std::to_string(raw.height) + " rows x " + std::to_string(raw.width) + " columns";
}
}  // namespace

std::string sequenceOf(const std::vector<ScanPoint>& points)
{
  constexpr std::size_t kPairs = 1024;
  constexpr float kFullTurn = 6.28318530717959F, kAlong = 0.1F;
  const std::size_t step = (points.size() / kPairs) | 1U;
  std::size_t pairs = 0, climbs = 0, near = 0;
  const auto elevation = [](const ScanPoint& p) { return p.z / std::sqrt(p.x * p.x + p.y * p.y + p.z * p.z); };
  for (std::size_t i = 0; i + 1 < points.size(); i += step)
  {
    if (!hasDirection(points[i]) || !hasDirection(points[i + 1])) continue;
    const ScanPoint &a = points[i], &b = points[i + 1];
    const float turned = std::abs(std::remainder(fastAzimuth(b.x, b.y) - fastAzimuth(a.x, a.y), kFullTurn));
    near += turned < kAlong;
    climbs += turned < kAlong && std::abs(elevation(b) - elevation(a)) > turned;
    ++pairs;
  }
  if (pairs == 0 || 3 * near < 2 * pairs) return "in no order of scan lines";
  return 2 * climbs > near ? "firing after firing" : "in neighbouring directions";
}

void throwStaggered(double columns, double angle)
{
  constexpr double kMostOfBeams = 0.26;  // 15 degrees; an Ouster's beams look up to 9 degrees aside
  throw std::invalid_argument("expected columns of one azimuth, found neighbouring scan lines " +
                              std::to_string(std::lround(columns)) + " columns apart in the mean: " +
                              (angle < kMostOfBeams
                                   ? "switch on destaggering in the driver (ouster_ros: destagger:=true)"
                                   : "publish the cloud in the sensor's own frame") +
                              ", or set the parameter layout to 'ring', which places the points by their azimuth");
}

void throwNoSequence()
{
  throw NoGrid(
      "expected columns in the sequence of their azimuth, found that it goes to and fro along the scan lines: set the "
      "parameter layout to 'ring', which places the points by their azimuth");
}

void throwTurnsTwice(double turned)
{
  throw NoGrid("expected at most one turn of the sensor, found columns that span " +
               std::to_string(std::lround(std::abs(turned) * 57.29577951308232)) +
               " degrees: publish one scan a message, or set layout to 'merged'");
}

void throwManyLines(std::uint32_t lines)
{
  throw NoGrid("expected at most " + std::to_string(RowFinder::kMaxRings) + " scan lines, found " +
               std::to_string(lines) +
               ": set layout to 'merged' where the lidar has no scan lines (RoboSense M1, Livox)");
}

void throwSharedElevations(const RawCloud& raw)
{
  throw NoGrid("expected scan lines that each have an elevation of their own, found " + size(raw) +
               " in which several share one, as of two lidars or of two returns of each laser: publish them one by "
               "one, or set layout to 'merged'");
}

void throwUnsorted(const RawCloud& raw)
{
  throw NoGrid(
      "expected scan lines sorted by elevation, or in the sensor's own frame, in which they can be sorted, found " +
      size(raw) +
      " that are neither: publish the cloud in the sensor's frame, or one row of points with a field 'ring'");
}

void throwUnsortedRings()
{
  throw std::invalid_argument(
      "expected rings numbered by their elevation, or in the sensor's own frame, in which they can be sorted, found "
      "neither: publish the cloud in the sensor's frame");
}

void throwTilted(double tilt)
{
  throw std::invalid_argument(
      "expected a cloud in the sensor's own frame or one that is little tilted against it, found "
      "the sensor's axis " +
      std::to_string(std::lround(tilt * 57.29577951308232)) +
      " degrees from the cloud's z: publish the cloud in the sensor's frame");
}

void throwNoScanLines(const RawCloud& raw, const std::vector<ScanPoint>& points)
{
  throw std::invalid_argument(
      "expected an organised cloud (rows and columns), or points with a field 'ring', in the order of rings, or of a "
      "sensor that is named, found one " +
      std::string(raw.height == 1 ? "row, " : "column, ") + sequenceOf(points) + ", of " +
      std::to_string(raw.width * std::size_t{raw.height}) + " points with " + describeFields(raw) +
      ": switch on organised output in the driver (velodyne_pointcloud: organize_cloud:=true; rslidar_sdk: "
      "dense_points: false), set the parameter sensor, or set layout to 'merged' where the lidar has no scan lines "
      "(Livox) or the points are several lidars");
}

void throwNoRing(const RawCloud& raw)
{
  throw std::invalid_argument("expected a field 'ring', 'channel' or one named by the parameter ring_field, found " +
                              describeFields(raw));
}

void throwNoGrid(const RawCloud& raw, const std::vector<ScanPoint>& points)
{
  throw NoGrid("expected rows or columns that are scan lines, each of one elevation, found " + size(raw) +
               " whose points come " + sequenceOf(points) +
               " and whose elevation varies within a row and a column as in the whole cloud: publish one "
               "row of points with a field 'ring', or set layout to 'ring', 'beams' (and sensor) or "
               "'merged'");
}

void throwNotUnfolded(const std::vector<ScanPoint>& points, std::uint32_t sensor_rows)
{
  throw std::invalid_argument(
      "expected points ring after ring, each ring a sweep of one elevation" +
      (sensor_rows > 0 ? ", as many as the sensor's " + std::to_string(sensor_rows) + " beams" : std::string()) +
      ", found points " + sequenceOf(points) + " that make no such rings");
}

void throwHidden(double share, double unavoidable)
{
  throw std::invalid_argument(
      "expected at most " + percent(unavoidable) + " of the returns behind others of their pixel, found " +
      percent(share) +
      ": the cloud is no single scan of one lidar (for several lidars or scans in one cloud set "
      "layout to 'merged'), or it is not in the sensor's own frame");
}
}  // namespace lidar_panoptic_clustering

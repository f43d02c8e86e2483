#include "lidar_panoptic_clustering/projection/layout_probe.h"

#include "lidar_panoptic_clustering/projection/azimuth.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <stdexcept>

namespace lidar_panoptic_clustering
{
namespace
{
constexpr float kPi = 3.14159265358979F;

std::uint32_t readRing(const PointRun& run, const RawField& field)
{
  std::uint32_t ring = 0;
  readIds(run, field, &ring, sizeof(ring));
  return ring;
}

/// The rows are rings when what is constant on a ring varies less along rows than along columns, and by a clear
/// factor, for a wrong guess costs more than none: elevation varies 17 times less and more in recorded PandaSet and
/// Ouster clouds, still 2.4 times with the frame tilted by 30 degrees.
std::optional<Orientation> decide(double along_rows, double along_columns)
{
  constexpr double kClearly = 0.5;
  if (along_rows < kClearly * along_columns) return Orientation::kRowsAreRings;
  if (along_columns < kClearly * along_rows) return Orientation::kRowsAreFirings;
  return std::nullopt;
}
}  // namespace

const std::vector<std::string>& orientationNames()
{
  static const std::vector<std::string> names = {"auto", "rows_are_rings", "rows_are_firings"};
  return names;
}

std::optional<Orientation> orientationFromName(const std::string& name)
{
  if (name == "auto") return std::nullopt;
  if (name == "rows_are_rings") return Orientation::kRowsAreRings;
  if (name == "rows_are_firings") return Orientation::kRowsAreFirings;
  throw std::invalid_argument("orientation: expected one of auto, rows_are_rings, rows_are_firings, found '" + name +
                              "'");
}

struct LayoutProbe::Pixel
{
  float azimuth = 0.0F;    ///< [rad]
  float sine = 0.0F;       ///< of the elevation
  std::uint32_t ring = 0;  ///< 0 where none is sent
  bool is_return = false;

  Pixel(const RawCloud& cloud, const ScanFields& fields, std::size_t row, std::size_t column)
  {
    const PointRun run{cloud.point(row, column), cloud.point_step, 1};
    float x = 0.0F, y = 0.0F, z = 0.0F;
    readFloats(run, *fields.x, &x, sizeof(float));
    readFloats(run, *fields.y, &y, sizeof(float));
    readFloats(run, *fields.z, &z, sizeof(float));
    const float range = std::sqrt(x * x + y * y + z * z);
    is_return = range > 0.0F && range < std::numeric_limits<float>::infinity();
    if (!is_return) return;
    azimuth = fastAzimuth(x, y);
    sine = z / range;
    if (fields.ring != nullptr) ring = readRing(run, *fields.ring);
  }
};

void LayoutProbe::Direction::reset(std::size_t lines)
{
  pairs.assign(lines > 1 ? lines - 1 : 0, Pair());
  elevation = azimuth = net_azimuth = 0.0;
  other_rings = count = 0;
}

void LayoutProbe::Direction::add(std::size_t line, const Pixel& here, const Pixel& there)
{
  float turned = there.azimuth - here.azimuth;
  if (turned > kPi) turned -= 2.0F * kPi;
  if (turned < -kPi) turned += 2.0F * kPi;
  pairs[line].azimuth += turned;
  pairs[line].elevation += there.sine - here.sine;
  ++pairs[line].count;
  elevation += std::abs(there.sine - here.sine);
  azimuth += std::abs(turned);
  net_azimuth += turned;
  other_rings += here.ring != there.ring;
  ++count;
}

void LayoutProbe::look(const RawCloud& cloud, const ScanFields& fields)
{
  has_ring_ = fields.ring != nullptr;
  // visits all columns whichever way the points are laid, for it shares no factor with rows or columns
  constexpr std::size_t kPixels = 1024;
  std::size_t stride = (std::size_t{cloud.width} * cloud.height / kPixels) | 1U;
  while (std::gcd(stride, std::size_t{cloud.width} * cloud.height) > 1) ++stride;
  gather(cloud, fields, stride);
  if (!enough() && stride > 1) gather(cloud, fields, 1);
}

bool LayoutProbe::enough() const
{
  constexpr std::size_t kEnoughPairs = 16;
  return right_.count >= kEnoughPairs && down_.count >= kEnoughPairs;
}

/// Compares pixels, evenly spread over the cloud, `stride` apart in row-major order, with their neighbours.
void LayoutProbe::gather(const RawCloud& cloud, const ScanFields& fields, std::size_t stride)
{
  const std::size_t width = cloud.width, height = cloud.height;
  right_.reset(width);
  down_.reset(height);
  for (std::size_t i = 0; i < width * height; i += stride)
  {
    const std::size_t row = i / width, column = i % width;
    const Pixel here(cloud, fields, row, column);
    if (!here.is_return) continue;
    if (column + 1 < width)
      if (const Pixel other(cloud, fields, row, column + 1); other.is_return) right_.add(column, here, other);
    if (row + 1 < height)
      if (const Pixel other(cloud, fields, row + 1, column); other.is_return) down_.add(row, here, other);
  }
}

std::optional<Orientation> LayoutProbe::orientation() const
{
  if (!enough()) return std::nullopt;
  if (has_ring_)
  {
    const auto share = [](const Direction& d)
    { return static_cast<double>(d.other_rings) / static_cast<double>(d.count); };
    if (const auto by_ring = decide(share(right_), share(down_))) return by_ring;
  }
  return decide(right_.meanElevation(), down_.meanElevation());
}

std::optional<bool> LayoutProbe::highestFirst(Orientation orientation) const
{
  int falls = 0, rises = 0;
  for (const Pair& pair : across(orientation).pairs)
  {
    falls += pair.elevation < 0.0F;
    rises += pair.elevation > 0.0F;
  }
  // a frame lifted off the sensor's turns the order of beams that hit the ground nearby, never that of most beams
  if (std::abs(falls - rises) * 4 <= falls + rises) return std::nullopt;
  return falls > rises;
}

double LayoutProbe::azimuthStep(Orientation orientation) const
{
  const Direction& d = along(orientation);
  return d.count > 0 ? d.azimuth / static_cast<double>(d.count) : 0.0;
}

double LayoutProbe::elevationStep(Orientation orientation) const
{
  const Direction& d = along(orientation);
  return d.count > 0 ? d.meanElevation() : 0.0;
}

double LayoutProbe::progress(Orientation orientation) const
{
  const Direction& d = along(orientation);
  return enough() && d.azimuth > 0.0 ? std::abs(d.net_azimuth) / d.azimuth : 1.0;
}

double LayoutProbe::turned(Orientation orientation) const
{
  const Direction& d = along(orientation);
  return enough() ? d.net_azimuth / static_cast<double>(d.count) * static_cast<double>(d.pairs.size()) : 0.0;
}

double LayoutProbe::agreement(Orientation orientation, const std::vector<std::uint32_t>& row_of_line) const
{
  int agree = 0, seen = 0;
  const auto& pairs = across(orientation).pairs;
  for (std::size_t line = 0; line < pairs.size(); ++line)
  {
    if (pairs[line].elevation == 0.0F) continue;
    agree += (pairs[line].elevation < 0.0F) == (row_of_line[line] < row_of_line[line + 1]);
    ++seen;
  }
  return seen > 0 ? static_cast<double>(agree) / seen : 1.0;
}

double LayoutProbe::staggeredColumns(Orientation orientation) const
{
  if (!enough()) return 0.0;
  const Direction& lines = across(orientation);
  double sum = 0.0;
  std::size_t pairs = 0;
  for (const Pair& pair : lines.pairs)
  {
    if (pair.count == 0) continue;
    sum += std::abs(pair.azimuth) / static_cast<float>(pair.count);
    ++pairs;
  }
  const double column = along(orientation).azimuth / static_cast<double>(along(orientation).count);
  return column > 0.0 ? sum / static_cast<double>(pairs) / column : 0.0;
}
}  // namespace lidar_panoptic_clustering

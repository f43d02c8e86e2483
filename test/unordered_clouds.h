#pragma once

#include "lidar_panoptic_clustering/core/sensor_model.h"
#include "lidar_panoptic_clustering/projection/azimuth.h"
#include "lidar_panoptic_clustering/projection/organizer.h"
#include "lidar_panoptic_clustering/simulation/lidar_simulator.h"
#include "raw_message.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <random>
#include <string>
#include <utility>
#include <vector>

namespace lidar_panoptic_clustering
{
/// A simulated scan of the street by a sensor of config/sensors: organised, row 0 the highest beam.
inline LabelledCloud simulatedScan(const std::string& sensor, std::uint64_t frame = 40)
{
  LidarSimulator simulator(SensorModel::load(sensor));
  PanopticCloud scan;
  simulator.scan(frame, scan);
  LabelledCloud cloud(scan.width, scan.height);
  for (std::size_t i = 0; i < scan.points.size(); ++i)
  {
    cloud.points[i].getVector4fMap() = scan.points[i].getVector4fMap();
    cloud.points[i].intensity = scan.points[i].intensity;
    cloud.points[i].label = scan.points[i].label;
  }
  return cloud;
}

using Order = std::vector<std::uint32_t>;

inline bool hasReturn(const LabelledPoint& p)
{
  return std::isfinite(p.x) && (p.x != 0.0F || p.y != 0.0F || p.z != 0.0F);
}

/// The pixels with a return, row after row.
inline Order returnsOf(const LabelledCloud& image)
{
  Order order;
  for (std::uint32_t i = 0; i < image.size(); ++i)
    if (hasReturn(image.points[i])) order.push_back(i);
  return order;
}

inline Order shuffled(Order order)
{
  std::mt19937 random(5);
  std::shuffle(order.begin(), order.end(), random);
  return order;
}

/// Firing after firing, as drivers publish what they do not organise.
inline Order byFiring(Order order, std::uint32_t columns)
{
  std::stable_sort(order.begin(), order.end(),
                   [columns](std::uint32_t a, std::uint32_t b) { return a % columns < b % columns; });
  return order;
}

/// Ring after ring, each counter-clockwise from straight ahead, as KITTI's files have them.
inline Order asKittiHasIt(Order order, const LabelledCloud& image)
{
  const auto key = [&](std::uint32_t i)
  {
    const float azimuth = fastAzimuth(image.points[i].x, image.points[i].y);
    return std::make_pair(i / image.width, azimuth < 0.0F ? azimuth + 6.2831853F : azimuth);
  };
  std::sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) { return key(a) < key(b); });
  return order;
}

/// How a driver numbers its rings.
enum class Rings
{
  kNone,
  kFromTheTop,
  kFromTheBottom,
  kInBlocks,  ///< from the top: 0, rows / 2, 1, rows / 2 + 1 ...
  kAsFired    ///< every other beam downwards from the top, in between the others: 0, 2, 4 ... 5, 3, 1
};

/// The pixels of an image as one row of points in the order given: x y z label, and ring uint16 where it is numbered.
inline RawMessage oneRow(const LabelledCloud& image, const Order& order, Rings rings)
{
  std::uint32_t step = 0;
  constexpr auto kF32 = NumberType::kFloat32;
  auto fields = packed({{"x", kF32}, {"y", kF32}, {"z", kF32}, {"label", NumberType::kUint32}}, step);
  if (rings != Rings::kNone)
  {
    fields.push_back(rawField("ring", step, NumberType::kUint16));
    step += 2;
  }
  RawMessage message(1, static_cast<std::uint32_t>(order.size()), fields, step);
  const std::uint32_t rows = image.height;
  for (std::uint32_t i = 0; i < order.size(); ++i)
  {
    const LabelledPoint& p = image.points[order[i]];
    const std::uint32_t row = order[i] / image.width;
    message.setPoint(0, i, p.x, p.y, p.z);
    message.set(0, i, "label", p.label);
    if (rings == Rings::kFromTheTop) message.set(0, i, "ring", row);
    if (rings == Rings::kFromTheBottom) message.set(0, i, "ring", rows - 1 - row);
    if (rings == Rings::kInBlocks) message.set(0, i, "ring", row / 2 + (row % 2) * ((rows + 1) / 2));
    if (rings == Rings::kAsFired) message.set(0, i, "ring", 2 * row < rows ? 2 * row : 2 * (rows - 1 - row) + 1);
  }
  return message;
}

/// What the Organizer makes of a message.
inline OrganizedScan organized(const RawMessage& message, const OrganizerConfig& config = {})
{
  OrganizedScan scan;
  Organizer(config).organize(message.view(), scan);
  return scan;
}
}  // namespace lidar_panoptic_clustering

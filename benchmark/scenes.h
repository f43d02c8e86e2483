// The scenes of all benchmarks, by name; each is made when it is asked for first.
#pragma once

#include "recorded_data.h"
#include "unordered_clouds.h"
#include "worst_scans.h"

#include "lidar_panoptic_clustering/datasets/semantic_kitti.h"
#include "lidar_panoptic_clustering/projection/point_projection.h"
#include "lidar_panoptic_clustering/simulation/lidar_simulator.h"

#include <algorithm>
#include <functional>
#include <map>
#include <memory>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace lidar_panoptic_clustering
{
using Scans = std::vector<LabelledCloud>;

/// Every `step`-th scan of the street.
inline Scans simulatedScans(const SensorModel& model, std::size_t count, std::size_t step = 10)
{
  LidarSimulator simulator(model);
  Scans scans(count);
  PanopticCloud scan;
  for (std::size_t i = 0; i < count; ++i)
  {
    simulator.scan(step * i, scan);
    scans[i] = LabelledCloud(scan.width, scan.height);
    for (std::size_t k = 0; k < scan.points.size(); ++k)
    {
      scans[i].points[k].getVector4fMap() = scan.points[k].getVector4fMap();
      scans[i].points[k].label = scan.points[k].label;
    }
  }
  return scans;
}

/// Twice the beams: one more between every two.
inline SensorModel hdl128e()
{
  SensorModel model = SensorModel::load("hdl64e");
  std::vector<float> elevations;
  for (std::size_t i = 0; i < model.elevations_rad.size(); ++i)
  {
    const float here = model.elevations_rad[i];
    const float step =
        i + 1 < model.elevations_rad.size() ? model.elevations_rad[i + 1] - here : here - model.elevations_rad[i - 1];
    elevations.push_back(here);
    elevations.push_back(here + 0.5F * step);
  }
  model.elevations_rad = elevations;
  return model;
}

/// The shared SemanticKITTI scans with their true classes; none where there are none.
inline Scans recordedScans()
{
  Scans scans;
  const std::string data = recordedData();
  if (data.empty()) return scans;
  PointProjector projector{ProjectionConfig{}};
  Projection projection;
  std::vector<ScanPoint> points;
  std::vector<std::uint32_t> labels;
  for (const std::string name : {"00", "05", "07"})
  {
    const SemanticKittiSequence sequence(data + "/semantickitti", name);
    for (std::size_t i = 0; i < sequence.size(); ++i)
    {
      sequence.readScan(i, points);
      sequence.readLabels(i, points.size(), labels);
      projector.project(points, labels, projection);
      scans.push_back(projection.cloud);
    }
  }
  return scans;
}

inline ThingScan thingsOf(const LabelledCloud& cloud, const SelectionConfig& config = {})
{
  ThingScan things;
  selectThings(cloud, *kittiTable(), config, things);
  return things;
}

/// Every return a car.
inline Scans allThings(Scans scans)
{
  for (auto& scan : scans)
    for (auto& p : scan.points) p.label = kCar;
  return scans;
}

/// Those of at least `count` things, with the things beyond `count` made road: a sector's, column by column.
inline Scans withThings(Scans scans, std::size_t count)
{
  scans.erase(std::remove_if(scans.begin(), scans.end(),
                             [&](const LabelledCloud& scan) { return thingsOf(scan).size() < count; }),
              scans.end());
  for (auto& scan : scans)
  {
    const ThingScan things = thingsOf(scan);
    std::vector<std::pair<std::uint32_t, std::uint32_t>> pixels;  // column and row
    for (std::uint32_t row = 0; row < things.rows; ++row)
      for (std::uint32_t i = things.line_begin[row]; i < things.line_begin[row + 1]; ++i)
        pixels.emplace_back(things.points[i].column, row);
    std::sort(pixels.begin(), pixels.end());
    for (std::size_t k = count; k < pixels.size(); ++k)
      scan.at(static_cast<int>(pixels[k].first), static_cast<int>(pixels[k].second)).label = kRoad;
  }
  return scans;
}

/// Returns and missing returns in the order of the organised cloud.
inline RawMessage organisedMessage(const LabelledCloud& image)
{
  std::vector<std::uint32_t> all(image.size());
  std::iota(all.begin(), all.end(), 0U);
  RawMessage message = oneRow(image, all, Rings::kFromTheTop);
  message.header.height = image.height;
  message.header.width = image.width;
  message.header.row_step = image.width * message.header.point_step;
  return message;
}

/// A sensor of `rings` rings and `columns` columns with the field of view of the HDL-64E.
inline SensorModel sensorOf(std::uint32_t rings, std::uint32_t columns)
{
  SensorModel model = SensorModel::load("hdl64e");
  const float top = model.elevations_rad.front(), bottom = model.elevations_rad.back();
  model.elevations_rad.clear();
  for (std::uint32_t ring = 0; ring < rings; ++ring)
    model.elevations_rad.push_back(top + (bottom - top) * static_cast<float>(ring) / static_cast<float>(rings - 1));
  model.columns = columns;
  return model;
}

/// The scenes there are: what a benchmark measures on, and how it is made.
inline const std::map<std::string, std::function<Scans()>>& sceneList()
{
  static const auto list = []
  {
    std::map<std::string, std::function<Scans()>> scenes = {
        {"street", [] { return simulatedScans(SensorModel::load("hdl64e"), 10); }},  // 26,000 things
        {"street_128", [] { return simulatedScans(hdl128e(), 4); }},                 // 60,000
        {"recorded", [] { return recordedScans(); }},                                // 5,000 to 10,000
        {"ten_thousand", [] { return withThings(recordedScans(), 10000); }},
        {"all_things", [] { return allThings(recordedScans()); }},  // 114,000
        {"street_all_things", [] { return allThings(simulatedScans(SensorModel::load("hdl64e"), 4)); }},
        {"street_128_all_things", [] { return allThings(simulatedScans(hdl128e(), 4)); }},  // 249,000
    };
    for (const auto& worst : worstScans())
      scenes["worst/" + worst.name] = [worst] { return Scans{worst.build(64, 2048)}; };
    for (const std::uint32_t rings : {8U, 16U, 32U, 64U, 128U, 256U})
      for (const bool all : {false, true})
        scenes[(all ? "size_all_things/" : "size/") + std::to_string(rings)] = [rings, all]
        {
          Scans scans = simulatedScans(sensorOf(rings, 16 * rings), 2, 60);
          return all ? allThings(std::move(scans)) : scans;
        };
    return scenes;
  }();
  return list;
}

/// A scene by name, the same object each time. Without recorded scans it is empty where it is made of them.
inline const Scans& scene(const std::string& name)
{
  static std::map<std::string, Scans> made;
  const auto known = sceneList().find(name);
  if (known == sceneList().end()) throw std::invalid_argument("there is no scene '" + name + "'");
  const auto [at, is_new] = made.try_emplace(name);
  if (is_new) at->second = known->second();
  return at->second;
}
}  // namespace lidar_panoptic_clustering

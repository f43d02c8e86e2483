#pragma once

#include "lidar_panoptic_clustering/clusterers/factory.h"
#include "lidar_panoptic_clustering/core/frame_pipeline.h"

#include <cmath>
#include <cstdint>
#include <functional>
#include <limits>
#include <map>
#include <memory>
#include <random>
#include <string>
#include <vector>

namespace lidar_panoptic_clustering
{
constexpr std::uint32_t kCar = 10, kMovingCar = 252, kPerson = 30, kTruck = 18, kRoad = 40;
constexpr float kNoReturn = std::numeric_limits<float>::quiet_NaN();

inline std::shared_ptr<const ClassTable> kittiTable()
{
  static const auto table = std::make_shared<const ClassTable>(ClassTable::load("semantic_kitti"));
  return table;
}

inline LabelledPoint labelled(float x, float y, float z, std::uint32_t label)
{
  LabelledPoint p;
  p.x = x, p.y = y, p.z = z, p.label = label;
  return p;
}

inline LabelledCloud emptyCloud(std::uint32_t rows, std::uint32_t columns)
{
  LabelledCloud cloud(columns, rows, labelled(kNoReturn, kNoReturn, kNoReturn, kRoad));
  cloud.is_dense = false;
  return cloud;
}

/// The point a beam of a sensor that spreads `rows` over 30 degrees and `columns` over a full turn hits at `range`.
inline LabelledPoint onBeam(std::uint32_t rows, std::uint32_t columns, float row, float column, float range,
                            std::uint32_t label)
{
  const float elevation = 0.05F - 0.5F * row / static_cast<float>(rows);
  const float azimuth = 3.14159265F - 6.2831853F * column / static_cast<float>(columns);
  return labelled(range * std::cos(elevation) * std::cos(azimuth), range * std::cos(elevation) * std::sin(azimuth),
                  range * std::sin(elevation), label);
}

/// A scan of random patches of several classes at random ranges, with holes and jitter.
inline LabelledCloud randomScan(unsigned seed, std::uint32_t rows, std::uint32_t columns)
{
  std::mt19937 random(seed);
  const auto upTo = [&](unsigned n) { return static_cast<std::uint32_t>(random() % n); };
  const auto uniform = [&](float a, float b) { return a + (b - a) * static_cast<float>(random() % 10000) / 10000.0F; };
  LabelledCloud cloud = emptyCloud(rows, columns);
  const std::uint32_t labels[] = {kCar, kMovingCar, kPerson, kTruck, kRoad};
  for (std::uint32_t patch = 0; patch < 4 + columns * rows / 20; ++patch)
  {
    const std::uint32_t top = upTo(rows), left = upTo(columns), height = 1 + upTo(4), width = 1 + upTo(6);
    const std::uint32_t label = labels[upTo(5)];
    const float range = uniform(2.0F, 15.0F);
    for (std::uint32_t r = top; r < std::min(rows, top + height); ++r)
      for (std::uint32_t c = left; c < left + width; ++c)
        cloud.points[r * columns + c % columns] =
            onBeam(rows, columns, static_cast<float>(r), static_cast<float>(c % columns) + uniform(-0.3F, 0.3F),
                   range + uniform(-0.2F, 0.2F), label);
  }
  for (auto& p : cloud.points)
    if (upTo(8) == 0) p.x = p.y = p.z = upTo(2) == 0 ? 0.0F : kNoReturn;
  return cloud;
}

/// Instance ids by pixel.
inline std::vector<std::uint32_t> instancesOf(const PanopticCloud& cloud)
{
  std::vector<std::uint32_t> ids;
  for (const auto& p : cloud.points) ids.push_back(p.instance);
  return ids;
}

inline PanopticCloud runAlgorithm(const std::string& algorithm, const LabelledCloud& cloud,
                                  const ParameterMap& parameters = {})
{
  Algorithm made = makeAlgorithm(algorithm, parameters);
  FramePipeline pipeline(kittiTable(), made.pipeline, std::move(made.clusterer));
  PanopticCloud out;
  pipeline.segment(cloud);
  pipeline.paint(cloud, out);
  return out;
}

/// The algorithm's rule by itself, with the survey's settings: no class sizes, no refinement.
inline PanopticCloud runRule(const std::string& algorithm, const LabelledCloud& cloud, ParameterMap parameters = {})
{
  parameters.merge(surveyParameters(algorithm));
  return runAlgorithm(algorithm, cloud, parameters);
}

/// The same partition with numbers by first occurrence; 0 stays 0.
inline std::vector<std::uint32_t> canonical(const std::vector<std::uint32_t>& ids)
{
  std::map<std::uint32_t, std::uint32_t> number;
  std::vector<std::uint32_t> result;
  for (const std::uint32_t id : ids)
    result.push_back(id == 0 ? 0 : number.emplace(id, static_cast<std::uint32_t>(number.size() + 1)).first->second);
  return result;
}

/// The components of a graph over 0..n-1, numbered 1.. by first member; plain breadth-first search.
inline std::vector<std::uint32_t> components(std::size_t n, const std::vector<std::vector<std::size_t>>& neighbours)
{
  std::vector<std::uint32_t> component(n, 0);
  std::uint32_t count = 0;
  for (std::size_t seed = 0; seed < n; ++seed)
  {
    if (component[seed] != 0) continue;
    std::vector<std::size_t> open = {seed};
    component[seed] = ++count;
    while (!open.empty())
    {
      const std::size_t i = open.back();
      open.pop_back();
      for (const std::size_t j : neighbours[i])
        if (component[j] == 0) component[j] = count, open.push_back(j);
    }
  }
  return component;
}
}  // namespace lidar_panoptic_clustering

#pragma once

#include "recorded_data.h"

#include "lidar_panoptic_clustering/datasets/semantic_kitti.h"
#include "lidar_panoptic_clustering/pipeline/factory.h"
#include "lidar_panoptic_clustering/pipeline/frame_pipeline.h"
#include "lidar_panoptic_clustering/projection/point_projection.h"
#include "lidar_panoptic_clustering/simulation/lidar_simulator.h"

#include <benchmark/benchmark.h>

#include <algorithm>
#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace lidar_panoptic_clustering
{
using Scans = std::vector<LabelledCloud>;
constexpr std::uint32_t kCarLabel = 10, kRoadLabel = 40;

inline std::shared_ptr<const ClassTable> table()
{
  static const auto loaded = std::make_shared<const ClassTable>(ClassTable::load("semantic_kitti"));
  return loaded;
}

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
  selectThings(cloud, *table(), config, things);
  return things;
}

/// Every return a car.
inline Scans allThings(Scans scans)
{
  for (auto& scan : scans)
    for (auto& p : scan.points) p.label = kCarLabel;
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
      scan.at(static_cast<int>(pixels[k].first), static_cast<int>(pixels[k].second)).label = kRoadLabel;
  }
  return scans;
}

/// A frame that is not in the cache, into one that was touched before: what everything is measured against. With
/// `fresh`, into new memory.
inline void plainCopy(benchmark::State& state, const Scans& scans, bool fresh = false)
{
  auto out = std::make_unique<LabelledCloud>();
  std::size_t i = 0;
  for (auto _ : state)
  {
    if (fresh) out = std::make_unique<LabelledCloud>();
    *out = scans[i++ % scans.size()];
    benchmark::DoNotOptimize(out->points.data());
    benchmark::ClobberMemory();
  }
}

inline void setThings(benchmark::State& state, std::size_t found)
{
  state.counters["things"] = benchmark::Counter(static_cast<double>(found), benchmark::Counter::kAvgIterations);
}

/// Clustering alone.
inline void cluster(benchmark::State& state, const Scans& scans, const std::string& algorithm)
{
  const Algorithm made = makeAlgorithm(algorithm);
  std::vector<ThingScan> things;
  for (const auto& scan : scans) things.push_back(thingsOf(scan, made.pipeline.selection));
  std::vector<std::uint32_t> component;
  std::size_t i = 0, found = 0;
  for (auto _ : state)
  {
    const ThingScan& scan = things[i++ % things.size()];
    made.clusterer->cluster(scan, component);
    found += scan.size();
  }
  setThings(state, found);
}

/// Organised labelled cloud in, panoptic cloud out: one that was written before, or with `fresh`, new memory each time.
inline void pipeline(benchmark::State& state, const Scans& scans, const std::string& algorithm, bool fresh = false)
{
  Algorithm made = makeAlgorithm(algorithm);
  FramePipeline frames(table(), made.pipeline, std::move(made.clusterer));
  auto out = std::make_unique<PanopticCloud>();
  std::size_t i = 0, found = 0;
  for (auto _ : state)
  {
    const LabelledCloud& scan = scans[i++ % scans.size()];
    if (fresh) out = std::make_unique<PanopticCloud>();
    frames.segment(scan);
    frames.paint(scan, *out);
    found += frames.things().size();
  }
  setThings(state, found);
}

template <class Body>
void add(const std::string& name, const Body& body)
{
  benchmark::RegisterBenchmark(name.c_str(), body)->Unit(benchmark::kMillisecond);
}

/// The whole of main(): reads Google Benchmark's options, lets `add_all` add what there is to measure and keep the
/// scans it needs in the object it returns, and runs it. Exit status 2 for an option nobody knows.
template <class AddAll>
int runBenchmarks(int argc, char** argv, AddAll add_all)
{
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 2;
  [[maybe_unused]] const auto kept = add_all();
  benchmark::RunSpecifiedBenchmarks();
  return 0;
}
}  // namespace lidar_panoptic_clustering

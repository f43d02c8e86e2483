// Time of each stage and algorithm, one thread, beside a plain copy of the frame. Figures are worth comparing within
// one run only.
#include "recorded_data.h"

#include "lidar_panoptic_clustering/clusterers/factory.h"
#include "lidar_panoptic_clustering/datasets/semantic_kitti.h"
#include "lidar_panoptic_clustering/projection/point_projection.h"
#include "lidar_panoptic_clustering/simulation/lidar_simulator.h"

#include <benchmark/benchmark.h>

#include <memory>
#include <string>
#include <vector>

namespace lidar_panoptic_clustering
{
namespace
{
std::shared_ptr<const ClassTable> table()
{
  static const auto loaded = std::make_shared<const ClassTable>(ClassTable::load("semantic_kitti"));
  return loaded;
}

std::vector<LabelledCloud> simulatedScans()
{
  LidarSimulator simulator;
  std::vector<LabelledCloud> scans(10);
  PanopticCloud scan;
  for (std::size_t i = 0; i < scans.size(); ++i)
  {
    simulator.scan(10 * i, scan);
    scans[i] = LabelledCloud(scan.width, scan.height);
    for (std::size_t k = 0; k < scan.points.size(); ++k)
    {
      scans[i].points[k].getVector4fMap() = scan.points[k].getVector4fMap();
      scans[i].points[k].label = scan.points[k].label;
    }
  }
  return scans;
}

std::vector<LabelledCloud> recordedScans(const std::string& data)
{
  std::vector<LabelledCloud> scans;
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

using Scans = std::vector<LabelledCloud>;

/// A frame that is not in the cache, into one that was touched before: what the pipeline is measured against.
void plainCopy(benchmark::State& state, const Scans& scans)
{
  LabelledCloud out;
  std::size_t i = 0;
  for (auto _ : state)
  {
    out = scans[i++ % scans.size()];
    benchmark::DoNotOptimize(out.points.data());
    benchmark::ClobberMemory();
  }
}

void select(benchmark::State& state, const Scans& scans)
{
  ThingScan things;
  std::size_t i = 0, found = 0;
  for (auto _ : state)
  {
    selectThings(scans[i++ % scans.size()], *table(), SelectionConfig(), things);
    found += things.size();
  }
  state.counters["things"] = benchmark::Counter(static_cast<double>(found), benchmark::Counter::kAvgIterations);
}

void cluster(benchmark::State& state, const Scans& scans, const std::string& algorithm)
{
  const Algorithm made = makeAlgorithm(algorithm);
  std::vector<ThingScan> things(scans.size());
  for (std::size_t k = 0; k < scans.size(); ++k) selectThings(scans[k], *table(), made.pipeline.selection, things[k]);
  std::vector<std::uint32_t> component;
  std::size_t i = 0;
  for (auto _ : state) made.clusterer->cluster(things[i++ % things.size()], component);
}

void pipeline(benchmark::State& state, const Scans& scans, const std::string& algorithm)
{
  Algorithm made = makeAlgorithm(algorithm);
  FramePipeline frames(table(), made.pipeline, std::move(made.clusterer));
  PanopticCloud out;
  std::size_t i = 0;
  for (auto _ : state)
  {
    const LabelledCloud& scan = scans[i++ % scans.size()];
    frames.segment(scan);
    frames.paint(scan, out);
  }
}

void registerAll(const std::string& source, const Scans& scans)
{
  const auto add = [&source](const std::string& name, const auto& body)
  { benchmark::RegisterBenchmark((source + "/" + name).c_str(), body)->Unit(benchmark::kMillisecond); };
  add("plain_copy", [&scans](benchmark::State& state) { plainCopy(state, scans); });
  add("select", [&scans](benchmark::State& state) { select(state, scans); });
  for (const auto& name : algorithmNames())
  {
    add("cluster/" + name, [&scans, name](benchmark::State& state) { cluster(state, scans, name); });
    add("pipeline/" + name, [&scans, name](benchmark::State& state) { pipeline(state, scans, name); });
  }
}
}  // namespace
}  // namespace lidar_panoptic_clustering

int main(int argc, char** argv)
{
  using namespace lidar_panoptic_clustering;
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 2;
  const Scans simulated = simulatedScans();
  registerAll("simulated", simulated);
  const std::string data = recordedData();
  const Scans recorded = data.empty() ? Scans() : recordedScans(data);
  if (!recorded.empty()) registerAll("recorded", recorded);
  benchmark::RunSpecifiedBenchmarks();
}

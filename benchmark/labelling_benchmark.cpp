// Labels without a network beside a plain copy of the scan: recorded SemanticKITTI scans where there are some, and
// simulated ones.
#include "recorded_data.h"

#include "lidar_panoptic_clustering/datasets/semantic_kitti.h"
#include "lidar_panoptic_clustering/labelling/ground_labeler.h"
#include "lidar_panoptic_clustering/projection/point_projection.h"
#include "lidar_panoptic_clustering/simulation/lidar_simulator.h"

#include <benchmark/benchmark.h>

#include <string>
#include <vector>

namespace lidar_panoptic_clustering
{
namespace
{
using Scans = std::vector<LabelledCloud>;

Scans simulatedScans()
{
  Scans scans;
  LidarSimulator simulator;
  PanopticCloud simulated;
  for (std::uint64_t frame = 0; frame < 600; frame += 60)
  {
    simulator.scan(frame, simulated);
    LabelledCloud scan(simulated.width, simulated.height);
    for (std::size_t i = 0; i < scan.size(); ++i)
      scan.points[i].getVector4fMap() = simulated.points[i].getVector4fMap();
    scans.push_back(std::move(scan));
  }
  return scans;
}

Scans recordedScans(const std::string& data)
{
  Scans scans;
  PointProjector projector{ProjectionConfig{}};
  Projection projection;
  std::vector<ScanPoint> points;
  for (const std::string name : {"00", "05", "07"})
  {
    const SemanticKittiSequence sequence(data + "/semantickitti", name);
    for (std::size_t i = 0; i < sequence.size(); ++i)
    {
      sequence.readScan(i, points);
      projector.project(points, {}, projection);
      scans.push_back(projection.cloud);
    }
  }
  return scans;
}

/// Into a frame that was touched before.
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

void label(benchmark::State& state, Scans& scans)
{
  GroundLabeler labeler{GroundLabelerConfig{}};
  std::size_t i = 0;
  for (auto _ : state) labeler.label(scans[i++ % scans.size()]);
}

void registerAll(const std::string& source, Scans& scans)
{
  const auto add = [&source](const std::string& name, const auto& body)
  { benchmark::RegisterBenchmark((source + "/" + name).c_str(), body)->Unit(benchmark::kMillisecond); };
  add("plain_copy", [&scans](benchmark::State& state) { plainCopy(state, scans); });
  add("label", [&scans](benchmark::State& state) { label(state, scans); });
}
}  // namespace
}  // namespace lidar_panoptic_clustering

int main(int argc, char** argv)
{
  using namespace lidar_panoptic_clustering;
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 2;
  Scans simulated = simulatedScans();
  registerAll("simulated", simulated);
  const std::string data = recordedData();
  Scans recorded = data.empty() ? Scans() : recordedScans(data);
  if (!recorded.empty()) registerAll("recorded", recorded);
  benchmark::RunSpecifiedBenchmarks();
}

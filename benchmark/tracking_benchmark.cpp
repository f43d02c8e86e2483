// Time of tracking beside a plain copy of the scan, one thread, on recorded SemanticKITTI scans where there are some
// and on simulated ones; and by the number of objects. Figures are worth comparing within one run only.
//   follow: what a tracker nodelet does of each scan whatever is listened to: association and filter
//   output: the same and the cloud with the tracks' ids
//   list: the same and the list of objects with their boxes
#include "benchmark_scans.h"

#include "lidar_panoptic_clustering/tracking/cloud_tracker.h"

#include <cmath>

namespace lidar_panoptic_clustering
{
namespace
{
using Clouds = std::vector<PanopticCloud>;

Clouds clustered(const Scans& scans)
{
  Algorithm made = makeAlgorithm("birds_eye");
  FramePipeline frames(table(), made.pipeline, std::move(made.clusterer));
  Clouds clouds(scans.size());
  for (std::size_t i = 0; i < scans.size(); ++i)
  {
    frames.segment(scans[i]);
    frames.paint(scans[i], clouds[i]);
  }
  return clouds;
}

/// As a copy of the input is one of panoptic points: 32 bytes, as labelled ones have.
void copy(benchmark::State& state, const Clouds& clouds)
{
  PanopticCloud out;
  std::size_t i = 0;
  for (auto _ : state)
  {
    out = clouds[i++ % clouds.size()];
    benchmark::DoNotOptimize(out.points.data());
    benchmark::ClobberMemory();
  }
}

/// The scans over and over, a tenth of a second apart. The next round begins anew, as another drive does.
void track(benchmark::State& state, const Clouds& clouds, bool with_output, bool with_list)
{
  CloudTracker tracker(table());
  PanopticCloud out;
  std::size_t i = 0;
  std::int64_t stamp_us = 0;
  for (auto _ : state)
  {
    if (i % clouds.size() == 0) tracker.reset();
    const PanopticCloud& cloud = clouds[i++ % clouds.size()];
    tracker.follow(cloud, stamp_us += 100000, Eigen::Isometry3d::Identity());
    if (with_output) tracker.paint(cloud, out);
    if (with_list) tracker.list(cloud);
  }
  state.counters["tracks"] = static_cast<double>(tracker.liveTracks());
}

/// So many objects on a grid 6 m apart, all of which drive at 3 m/s; each is seen by five points.
void manyObjects(benchmark::State& state, int count)
{
  const ClassIndex car = table()->findByName("car");
  PointTracker tracker(table());
  const int side = static_cast<int>(std::ceil(std::sqrt(count)));
  std::int64_t stamp_us = 0;
  const auto step = [&]
  {
    stamp_us += 100000;
    tracker.begin(stamp_us, Eigen::Isometry3d::Identity());
    const float moved = 3e-6F * static_cast<float>(stamp_us % 100000000);
    for (int k = 0; k < count; ++k)
    {
      const float x = 6.0F * static_cast<float>(k % side) + moved, y = 6.0F * static_cast<float>(k / side);
      for (const float corner : {-1.0F, -0.5F, 0.0F, 0.5F, 1.0F})
        tracker.add(static_cast<std::uint32_t>(k + 1), car, x + 2.0F * corner, y + std::abs(corner), 0.5F);
    }
    tracker.finish();
  };
  for (int k = 0; k < 10; ++k) step();
  for (auto _ : state) step();
  state.counters["tracks"] = static_cast<double>(tracker.tracker().liveTracks());
  state.counters["us_an_object"] =
      benchmark::Counter(1e-6 * count, benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
}

std::unique_ptr<const std::pair<Clouds, Clouds>> addAll()
{
  auto kept = std::make_unique<const std::pair<Clouds, Clouds>>(
      clustered(simulatedScans(SensorModel::load("hdl64e"), 20, 1)), clustered(recordedScans()));
  const auto addClouds = [](const std::string& source, const Clouds& clouds)
  {
    if (clouds.empty()) return;
    add(source + "/plain_copy", [&clouds](benchmark::State& state) { copy(state, clouds); });
    add(source + "/follow", [&clouds](benchmark::State& state) { track(state, clouds, false, false); });
    add(source + "/output", [&clouds](benchmark::State& state) { track(state, clouds, true, false); });
    add(source + "/list", [&clouds](benchmark::State& state) { track(state, clouds, true, true); });
  };
  addClouds("simulated", kept->first);
  addClouds("recorded", kept->second);
  for (const int count : {100, 1000, 10000})
    add("objects/" + std::to_string(count), [count](benchmark::State& state) { manyObjects(state, count); });
  return kept;
}
}  // namespace
}  // namespace lidar_panoptic_clustering

int main(int argc, char** argv)
{
  using namespace lidar_panoptic_clustering;
  return runBenchmarks(argc, argv, addAll);
}

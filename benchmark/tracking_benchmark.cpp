// Time of tracking, one thread, in copies of the labelled 64 x 2048 cloud, on recorded SemanticKITTI scans and on
// simulated ones; and by the number of objects.
//   follow: what a tracker nodelet does of each scan whatever is listened to: association and filter
//   output: the same and the cloud with the tracks' ids
//   list: the same and the list of objects with their boxes
#include "measure.h"

#include "lidar_panoptic_clustering/tracking/cloud_tracker.h"

#include <cmath>
#include <tuple>

namespace lidar_panoptic_clustering
{
namespace
{
using Clouds = std::vector<PanopticCloud>;

Clouds clustered(const Scans& scans)
{
  Algorithm made = makeAlgorithm("birds_eye");
  FramePipeline frames(kittiTable(), made.pipeline, std::move(made.clusterer));
  Clouds clouds(scans.size());
  for (std::size_t i = 0; i < scans.size(); ++i)
  {
    frames.segment(scans[i]);
    frames.paint(scans[i], clouds[i]);
  }
  return clouds;
}

/// The scans over and over, a tenth of a second apart. The next round begins anew, as another drive does.
void track(benchmark::State& state, const Scans& scans, bool with_output, bool with_list)
{
  const Clouds clouds = clustered(scans);
  CloudTracker tracker(kittiTable());
  PanopticCloud out;
  std::int64_t stamp_us = 0;
  measure(state,
          [&](std::size_t i)
          {
            if (i % clouds.size() == 0) tracker.reset();
            const PanopticCloud& cloud = clouds[i % clouds.size()];
            if (with_output)
              tracker.follow(cloud, stamp_us += 100000, Eigen::Isometry3d::Identity(), out);
            else
              tracker.follow(cloud, stamp_us += 100000, Eigen::Isometry3d::Identity());
            if (with_list) tracker.list(cloud);
          });
  state.counters["tracks"] = static_cast<double>(tracker.liveTracks());
}

/// So many objects on a grid 6 m apart, all of which drive at 3 m/s; each is seen by five points.
void manyObjects(benchmark::State& state, int count)
{
  const ClassIndex car = kittiTable()->findByName("car");
  PointTracker tracker(kittiTable());
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
  double seconds = 0.0, objects = 0.0;
  measure(state,
          [&](std::size_t)
          {
            const double begin = cpuSeconds();
            step();
            seconds += cpuSeconds() - begin, objects += count;
          });
  state.counters["tracks"] = static_cast<double>(tracker.tracker().liveTracks());
  state.counters["us_an_object"] = 1e6 * seconds / objects;
}

void addAll()
{
  for (const std::string name : {"street_in_a_row", "recorded"})
    for (const auto& [row, with_output, with_list] :
         {std::tuple("/follow", false, false), std::tuple("/output", true, false), std::tuple("/list", true, true)})
      addOn(name + row, name,
            [with_output = with_output, with_list = with_list](benchmark::State& state, const Scans& scans)
            { track(state, scans, with_output, with_list); });
  for (const int count : {100, 1000, 10000})
    add("objects/" + std::to_string(count), [count](benchmark::State& state) { manyObjects(state, count); });
}
}  // namespace
}  // namespace lidar_panoptic_clustering

int main(int argc, char** argv)
{
  using namespace lidar_panoptic_clustering;
  return runBenchmarks(argc, argv, addAll);
}

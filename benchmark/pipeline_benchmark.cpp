// Time of each stage and algorithm, one thread, in copies of the labelled 64 x 2048 cloud.
//   recorded/, street/, street_128/: whole scans with their true classes
//   ten_thousand/: clustering, recorded scans with exactly 10,000 things
//   all_things/, street_all_things/, street_128_all_things/: every return a thing, on 64 and on 128 rings
#include "measure.h"

#include <malloc.h>

namespace lidar_panoptic_clustering
{
namespace
{
void select(benchmark::State& state, const Scans& scans)
{
  ThingScan things;
  measure(state,
          [&](std::size_t i) { selectThings(scans[i % scans.size()], *kittiTable(), SelectionConfig(), things); });
  setThings(state, scans);
}

/// Into new memory each time.
void freshCopy(benchmark::State& state, const Scans& scans)
{
  auto out = std::make_unique<LabelledCloud>();
  measure(state,
          [&](std::size_t i)
          {
            out = std::make_unique<LabelledCloud>();
            *out = scans[i % scans.size()];
            benchmark::DoNotOptimize(out->points.data());
          });
}

void addAll()
{
  const std::vector<std::string> fast = {"depth", "scan_line_run", "birds_eye"};
  for (const std::string scene_name : {"recorded", "street"})
  {
    addOn(scene_name + "/plain_copy_fresh", scene_name, freshCopy);
    addOn(scene_name + "/select", scene_name, select);
    addAlgorithms(scene_name, algorithmNames());
    for (const std::string& name : algorithmNames())
      addOn(scene_name + "/pipeline_fresh/" + name, scene_name,
            [name](benchmark::State& state, const Scans& scans) { pipeline(state, scans, name, true); });
  }
  for (const std::string& name : algorithmNames())
    addOn("ten_thousand/cluster/" + name, "ten_thousand",
          [name](benchmark::State& state, const Scans& scans) { cluster(state, scans, name); });
  for (const std::string scene_name : {"all_things", "street_128", "street_all_things", "street_128_all_things"})
    addAlgorithms(scene_name, fast);
}
}  // namespace
}  // namespace lidar_panoptic_clustering

int main(int argc, char** argv)
{
  using namespace lidar_panoptic_clustering;
  mallopt(M_MMAP_THRESHOLD, 1 << 20);  // else the C library learns to keep a freed frame, and new memory is not new
  return runBenchmarks(argc, argv, addAll);
}

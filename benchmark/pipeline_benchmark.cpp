// Time of each stage and algorithm, one thread, beside a plain copy of the frame. Figures are worth comparing within
// one run only.
//   simulated/, recorded/   whole scans: 64 x 2048, 5 % of the pixels things
//   ten_thousand/           clustering alone, recorded scans with exactly 10,000 things
//   all_things/, 128_rings/ cost against size: every return a thing, on 64 and on 128 rings
#include "benchmark_scans.h"

#include <malloc.h>

namespace lidar_panoptic_clustering
{
namespace
{
void select(benchmark::State& state, const Scans& scans)
{
  ThingScan things;
  std::size_t i = 0, found = 0;
  for (auto _ : state)
  {
    selectThings(scans[i++ % scans.size()], *table(), SelectionConfig(), things);
    found += things.size();
  }
  setThings(state, found);
}

void addWholeScans(const std::string& source, const Scans& scans)
{
  if (scans.empty()) return;
  add(source + "/plain_copy", [&scans](benchmark::State& state) { plainCopy(state, scans, false); });
  add(source + "/plain_copy_fresh", [&scans](benchmark::State& state) { plainCopy(state, scans, true); });
  add(source + "/select", [&scans](benchmark::State& state) { select(state, scans); });
  for (const auto& name : algorithmNames())
  {
    add(source + "/cluster/" + name, [&scans, name](benchmark::State& state) { cluster(state, scans, name); });
    add(source + "/pipeline/" + name, [&scans, name](benchmark::State& state) { pipeline(state, scans, name); });
    add(source + "/pipeline_fresh/" + name,
        [&scans, name](benchmark::State& state) { pipeline(state, scans, name, true); });
  }
}

void addSizes(const std::string& source, const Scans& scans)
{
  for (const std::string name : {"depth", "scan_line_run", "birds_eye"})
  {
    add(source + "/cluster/" + name, [&scans, name](benchmark::State& state) { cluster(state, scans, name); });
    add(source + "/pipeline/" + name, [&scans, name](benchmark::State& state) { pipeline(state, scans, name); });
  }
}

struct Kept
{
  Scans simulated, recorded, ten_thousand, all_things, dense, dense_things;
};

std::unique_ptr<Kept> addAll()
{
  auto kept = std::make_unique<Kept>();
  kept->simulated = simulatedScans(SensorModel::load("hdl64e"), 10), kept->recorded = recordedScans();
  addWholeScans("simulated", kept->simulated);
  addWholeScans("recorded", kept->recorded);

  const Scans& usual = kept->recorded.empty() ? kept->simulated : kept->recorded;
  const Scans& ten_thousand = kept->ten_thousand = withThings(usual, 10000);
  if (!ten_thousand.empty())
    for (const auto& name : algorithmNames())
      add("ten_thousand/cluster/" + name,
          [&ten_thousand, name](benchmark::State& state) { cluster(state, ten_thousand, name); });

  kept->all_things = allThings(usual);
  kept->dense = simulatedScans(hdl128e(), 4), kept->dense_things = allThings(kept->dense);
  addSizes("all_things", kept->all_things);
  addSizes("128_rings", kept->dense);
  addSizes("128_rings_all_things", kept->dense_things);
  return kept;
}
}  // namespace
}  // namespace lidar_panoptic_clustering

int main(int argc, char** argv)
{
  using namespace lidar_panoptic_clustering;
  mallopt(M_MMAP_THRESHOLD, 1 << 20);  // else the C library learns to keep a freed frame, and new memory is not new
  return runBenchmarks(argc, argv, addAll);
}

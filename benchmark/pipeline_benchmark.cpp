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
/// A frame that is not in the cache, into one that was touched before: what the pipeline is measured against. With
/// `fresh`, into new memory.
void plainCopy(benchmark::State& state, const Scans& scans, bool fresh)
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
}  // namespace
}  // namespace lidar_panoptic_clustering

int main(int argc, char** argv)
{
  using namespace lidar_panoptic_clustering;
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 2;
  mallopt(M_MMAP_THRESHOLD, 1 << 20);  // else the C library learns to keep a freed frame, and new memory is not new
  const Scans simulated = simulatedScans(SensorModel::load("hdl64e"), 10), recorded = recordedScans();
  addWholeScans("simulated", simulated);
  addWholeScans("recorded", recorded);

  const Scans ten_thousand = withThings(recorded.empty() ? simulated : recorded, 10000);
  if (!ten_thousand.empty())
    for (const auto& name : algorithmNames())
      add("ten_thousand/cluster/" + name,
          [&ten_thousand, name](benchmark::State& state) { cluster(state, ten_thousand, name); });

  const Scans all_things = allThings(recorded.empty() ? simulated : recorded);
  const Scans dense = simulatedScans(hdl128e(), 4), dense_things = allThings(dense);
  addSizes("all_things", all_things);
  addSizes("128_rings", dense);
  addSizes("128_rings_all_things", dense_things);
  benchmark::RunSpecifiedBenchmarks();
}

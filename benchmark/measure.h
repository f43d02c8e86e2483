// What the benchmarks have in common: each row is measured in CPU time beside a plain copy of the labelled 64 x 2048
// cloud into pages touched before, and prints how many copies it takes.
#pragma once

#include "scenes.h"

#include "lidar_panoptic_clustering/pipeline/factory.h"
#include "lidar_panoptic_clustering/pipeline/frame_pipeline.h"

#include <benchmark/benchmark.h>

#include <algorithm>
#include <ctime>

namespace lidar_panoptic_clustering
{
/// CPU time of this thread [s].
inline double cpuSeconds()
{
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

inline double medianOf(std::vector<double> values)
{
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

/// A frame that is not in the cache, into one that was touched before: what everything is measured against.
class PlainCopy
{
public:
  /// Adds the CPU times of some copies [s].
  void run(std::vector<double>& times)
  {
    constexpr int kCopies = 24;
    for (int k = 0; k < kCopies; ++k)
    {
      const double begin = cpuSeconds();
      to_ = from_[next_++ % from_.size()];
      benchmark::DoNotOptimize(to_.points.data());
      benchmark::ClobberMemory();
      times.push_back(cpuSeconds() - begin);
    }
  }

  static PlainCopy& shared()
  {
    static PlainCopy copy;
    return copy;
  }

private:
  Scans from_ = Scans(12, LabelledCloud(2048, 64));  // together larger than the cache
  LabelledCloud to_ = from_[0];
  std::size_t next_ = 0;
};

/// The whole of a row: `work(i)` is the i-th time, after three that are not measured, in which buffers grow. Counters:
/// `copies`, the median in plain copies measured before and after it; `copies_least`, the least of both.
template <class Work>
void measure(benchmark::State& state, const Work& work)
{
  std::vector<double> copy, times;
  PlainCopy::shared().run(copy);
  std::size_t i = 0;
  while (i < 3) work(i++);
  for (auto _ : state)
  {
    const double begin = cpuSeconds();
    work(i++);
    times.push_back(cpuSeconds() - begin);
  }
  PlainCopy::shared().run(copy);
  if (times.empty()) return;
  const double least = *std::min_element(times.begin(), times.end()),
               least_copy = *std::min_element(copy.begin(), copy.end());
  state.counters["copies"] = medianOf(times) / medianOf(copy);
  state.counters["copies_least"] = least / least_copy;
}

inline void setThings(benchmark::State& state, const Scans& scans)
{
  double things = 0.0;
  for (const auto& scan : scans) things += static_cast<double>(thingsOf(scan).size());
  state.counters["things"] = things / static_cast<double>(scans.size());
}

/// Clustering alone.
inline void cluster(benchmark::State& state, const Scans& scans, const std::string& algorithm)
{
  const Algorithm made = makeAlgorithm(algorithm);
  std::vector<ThingScan> things;
  for (const auto& scan : scans) things.push_back(thingsOf(scan, made.pipeline.selection));
  std::vector<std::uint32_t> component;
  measure(state, [&](std::size_t i) { made.clusterer->cluster(things[i % things.size()], component); });
  setThings(state, scans);
}

/// Organised labelled cloud in, panoptic cloud out: one that was written before, or with `fresh`, new memory each time.
/// Counters besides: the least copies each stage takes.
inline void pipeline(benchmark::State& state, const Scans& scans, const std::string& algorithm, bool fresh = false)
{
  Algorithm made = makeAlgorithm(algorithm);
  FramePipeline frames(kittiTable(), made.pipeline, std::move(made.clusterer));
  auto out = std::make_unique<PanopticCloud>();
  std::vector<double> stage[4];
  measure(state,
          [&](std::size_t i)
          {
            const LabelledCloud& scan = scans[i % scans.size()];
            if (fresh) out = std::make_unique<PanopticCloud>();
            frames.process(scan, *out);
            const StageTimes& times = frames.times();
            const double ms[4] = {times.select_ms, times.cluster_ms, times.refine_ms, times.paint_ms};
            for (int k = 0; k < 4; ++k) stage[k].push_back(ms[k]);
          });
  const char* const names[4] = {"ms_select", "ms_cluster", "ms_refine", "ms_paint"};
  for (int k = 0; k < 4; ++k) state.counters[names[k]] = medianOf(stage[k]);
  setThings(state, scans);
}

template <class Body>
void add(const std::string& name, const Body& body)
{
  benchmark::RegisterBenchmark(name.c_str(), body)->Unit(benchmark::kMillisecond);
}

/// Adds a row on a scene, which is made only where the row is run; without recorded scans it is passed over where the
/// scene is made of them.
template <class Body>
void addOn(const std::string& name, const std::string& scene_name, const Body& body)
{
  add(name,
      [scene_name, body](benchmark::State& state)
      {
        const Scans& scans = scene(scene_name);
        if (scans.empty())
          state.SkipWithError("no recorded scans: set LIDAR_PANOPTIC_DATA");
        else
          body(state, scans);
      });
}

/// The rows cluster/ and pipeline/ of algorithms on a scene.
inline void addAlgorithms(const std::string& scene_name, const std::vector<std::string>& algorithms)
{
  for (const std::string& name : algorithms)
  {
    addOn(scene_name + "/cluster/" + name, scene_name,
          [name](benchmark::State& state, const Scans& scans) { cluster(state, scans, name); });
    addOn(scene_name + "/pipeline/" + name, scene_name,
          [name](benchmark::State& state, const Scans& scans) { pipeline(state, scans, name); });
  }
}

/// The whole of main(): reads Google Benchmark's options, lets `add_all` add what there is to measure, and runs it.
/// Exit status 2 for an option nobody knows.
template <class AddAll>
int runBenchmarks(int argc, char** argv, AddAll add_all)
{
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 2;
  add_all();
  benchmark::RunSpecifiedBenchmarks();
  return 0;
}
}  // namespace lidar_panoptic_clustering

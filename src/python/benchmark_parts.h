#pragma once

#include "lidar_panoptic_clustering/evaluation/benchmark_report.h"
#include "tools/support/benchmark_options.h"
#include "tools/support/run_benchmark.h"

#include <cstdint>
#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace lidar_panoptic_clustering
{
/// What panoptic_benchmark's options ask for: what the processes of a cluster agree on.
class BenchmarkPlan
{
public:
  /// `label`: predictions of one algorithm right into --output, without any evaluation. Throws std::invalid_argument
  /// naming the option, and std::runtime_error where there is no such data set.
  BenchmarkPlan(const GivenOptions& options, bool label);

  const BenchmarkSettings& settings() const { return settings_; }
  const std::shared_ptr<const ClassTable>& table() const { return table_; }
  /// Those given; else all of the data set that have ground truth, and for predictions all with classes.
  const std::vector<std::string>& sequences() const { return sequences_; }
  /// Nothing counted yet.
  BenchmarkReport emptyReport() const;

private:
  BenchmarkSettings settings_;
  std::shared_ptr<const ClassTable> table_;
  std::vector<std::string> sequences_;
};

/// One sequence of a plan, of which parts are run. Not shared between threads.
class SequenceBenchmark
{
public:
  struct Result
  {
    std::string report;                 ///< JSON of the part's BenchmarkReport; empty for predictions alone
    std::size_t used = 0, resumed = 0;  ///< scans; those of which a run before left the predictions
    std::vector<std::pair<std::string, std::string>> skipped;  ///< scan and reason
  };

  /// Throws as BenchmarkRun.
  SequenceBenchmark(const BenchmarkPlan& plan, const std::string& sequence);

  std::size_t size() const { return run_.scans().size(); }
  /// The scan's file name without its ending.
  const std::string& scanName(std::size_t i) const { return run_.scans().scanName(i); }
  /// Predictions without a scan, and why.
  std::vector<std::pair<std::string, std::string>> skipped() const;
  /// Throws as BenchmarkRun::runPart, and std::out_of_range.
  Result run(std::size_t begin, std::size_t end);

private:
  bool evaluate_;
  BenchmarkRun run_;
};

/// Adds up the parts' reports, in any order, to what panoptic_benchmark makes of all at once. Amortised each scan is
/// touched a logarithmic number of times.
class BenchmarkSum
{
public:
  explicit BenchmarkSum(const BenchmarkPlan& plan) : plan_(plan) {}

  /// Throws std::invalid_argument where it is no part of the same benchmark.
  void add(const std::string& report);
  /// A scan that could not be used.
  void skip(const std::string& scan, const std::string& reason) { skipped_.push_back({scan, reason}); }
  /// All so far. `interrupted`: some scans are missing.
  BenchmarkReport total(bool interrupted);

private:
  struct Level
  {
    std::size_t parts;
    BenchmarkReport report;
  };

  BenchmarkPlan plan_;
  std::vector<Level> levels_;  ///< of falling size
  std::vector<SkippedScan> skipped_;
};
}  // namespace lidar_panoptic_clustering

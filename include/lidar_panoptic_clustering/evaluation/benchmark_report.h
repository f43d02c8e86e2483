#pragma once

#include "lidar_panoptic_clustering/evaluation/evaluation_report.h"
#include "lidar_panoptic_clustering/evaluation/frame_times.h"

#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <vector>

namespace lidar_panoptic_clustering
{
/// One algorithm with one setting.
struct BenchmarkRow
{
  std::string name;              ///< the algorithm and what was set, "depth theta_deg=5"
  EvaluationReport evaluation;   ///< quality
  std::vector<FrameTime> times;  ///< by scan; of scans without ground truth too
};

/// What a benchmark leaves behind: per row counts and times that can be merged, saved and loaded without loss.
struct BenchmarkReport
{
  std::string semantics;                       ///< "ground truth", or the folder the classes were read from
  std::map<std::string, std::uint64_t> scans;  ///< evaluated, by sequence
  bool interrupted = false;                    ///< whether some scans are missing
  EvaluationReport before;                     ///< the semantics alone, with no instances
  std::vector<BenchmarkRow> rows;              ///< in the order of the table

  /// Rows called `names`, with nothing counted yet.
  BenchmarkReport(std::string semantics, const std::vector<std::string>& names,
                  const std::shared_ptr<const ClassTable>& table);

  /// Adds another part of the same benchmark, a shard. Throws std::invalid_argument when semantics, rows or classes
  /// differ, and when both hold the same scan.
  BenchmarkReport& operator+=(const BenchmarkReport& other);

  /// Key "quality" holds counts and figures alone: the same predictions give the same bytes there, in whatever order
  /// they came together. Wall times stand under "times".
  std::string toJsonText() const;
  /// Throws std::invalid_argument with `source` and what is wrong with the text.
  static BenchmarkReport fromJsonText(const std::string& text, const std::string& source,
                                      const std::shared_ptr<const ClassTable>& table);
  /// The name of the class table a saved report was made with. Throws as fromJsonText.
  static std::string classTableOf(const std::string& text, const std::string& source);
};

/// The survey's two tables side by side: quality and time, a line a row. When they do not fit into `width` characters,
/// one below the other; 0 stands for any width. When sequence 08 is whole, the survey's own published figures [Zhao et
/// al. 2021] stand beside, marked as theirs.
std::string formatBenchmark(const BenchmarkReport& report, std::size_t width = 0);

/// Several reports of the same rows side by side: PQ of things over the classes that occur, a line a row and a column a
/// report, and the median time of the pipeline in the last report. `headings`: one a report. Throws
/// std::invalid_argument when the rows differ or a report holds no evaluated scan.
std::string formatComparison(const std::vector<BenchmarkReport>& reports, const std::vector<std::string>& headings);
}  // namespace lidar_panoptic_clustering

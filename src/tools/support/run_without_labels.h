#pragma once

#include "core/plain_numbers.h"
#include "lidar_panoptic_clustering/evaluation/object_recall.h"
#include "lidar_panoptic_clustering/scan_to_objects/scan_to_objects.h"
#include "tools/support/benchmark_scans.h"
#include "tools/support/benchmark_settings.h"
#include "tools/support/interrupt.h"
#include "tools/support/progress.h"
#include "tools/support/recall_figure.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <ctime>
#include <filesystem>
#include <memory>
#include <random>
#include <string>
#include <utility>
#include <vector>

namespace lidar_panoptic_clustering
{
/// How scans are given to the chain that works without labels.
struct WithoutLabels
{
  int keep_rings = 1;                  ///< every N-th, from the highest: a sensor of fewer beams
  bool shuffle = false;                ///< points in an order that means nothing, as of a lidar without scan lines
  std::string structure = "balanced";  ///< see GroundLabelerConfig
  std::string plot;                    ///< folder for figures of the worst scans of the first row; none when empty
};

/// Runs the whole chain, from points without classes to objects, and compares with the true objects whatever their
/// class. Objects and false segments count from 50 points, from 30 where rings are left out.
class RunWithoutLabels
{
public:
  RunWithoutLabels(const BenchmarkSettings& settings, const WithoutLabels& without,
                   const std::shared_ptr<const ClassTable>& table)
      : settings_(settings), without_(without), table_(table), scans_(settings, table)
  {
    ObjectRecallConfig rules;
    rules.min_points = without.keep_rings > 1 ? 30 : 50;
    for (const RowSettings& row : settings.rows)
    {
      ScanToObjectsConfig config;
      config.labeller.labels = "none";
      config.labeller.ground.structure = without.structure;
      if (without.shuffle) config.organizer.layout = "merged";
      config.algorithm = row.algorithm;
      config.parameters = row.allParameters();
      rows_.push_back({row.name, std::make_unique<ScanToObjects>(config), ObjectRecall(table, rules), {}});
    }
  }

  /// The tables of all rows. Ends early when the program is interrupted. Throws std::runtime_error naming the file that
  /// is wrong.
  std::string run()
  {
    {
      Progress progress("benchmark", scans_.size());
      for (std::size_t i = 0; i < scans_.size() && interrupted() == 0; ++i, progress.step()) process(i);
    }
    if (!without_.plot.empty() && interrupted() == 0) drawWorst();
    std::string text;
    for (Row& row : rows_)
    {
      std::sort(row.cpu_ms.begin(), row.cpu_ms.end());
      std::string line;
      if (!row.cpu_ms.empty())
        appendText(line, "CPU a scan, points to objects: median %.1f ms, largest %.1f ms\n",
                   row.cpu_ms[row.cpu_ms.size() / 2], row.cpu_ms.back());
      text += row.name + ", structure " + without_.structure + "\n\n" + formatObjectRecall(row.recall) + line + "\n";
    }
    return text;
  }

private:
  struct Row
  {
    std::string name;
    std::unique_ptr<ScanToObjects> chain;
    ObjectRecall recall;
    std::vector<double> cpu_ms;  ///< but for the first scan's, which grows buffers
  };
  /// How many true objects of a scan were not found.
  struct Misses
  {
    std::size_t count, scan;
  };

  /// Which points of the file go in, in what order.
  void choose(const std::vector<ScanPoint>& points)
  {
    chosen_.clear();
    if (without_.keep_rings > 1) unfoldScan(points, Sweep(), directions_);
    for (std::uint32_t i = 0; i < points.size(); ++i)
      if (without_.keep_rings == 1 || directions_[i].row % static_cast<std::uint32_t>(without_.keep_rings) == 0)
        chosen_.push_back(i);
    std::mt19937 same_each_time(1);
    if (without_.shuffle) std::shuffle(chosen_.begin(), chosen_.end(), same_each_time);
  }

  bool follows(std::size_t i) const
  {
    return i > 0 && scans_.sequence(i) == scans_.sequence(i - 1) && scans_.numberOf(i) == scans_.numberOf(i - 1) + 1;
  }

  void take(std::size_t i)
  {
    scans_.read(i, scan_);
    choose(scan_.points);
    points_.clear(), truth_.clear(), range_.clear();
    for (const std::uint32_t k : chosen_)
    {
      points_.push_back(scan_.points[k]);
      truth_.push_back(scan_.truth[k]);
      range_.push_back(std::hypot(scan_.points[k].x, scan_.points[k].y));
    }
  }

  RecallScan recallScan(const ScanToObjects& chain, bool follows) const
  {
    return {chain.labels().data(),
            chain.instanceIds().data(),
            ScanLabels::packed(truth_.data()),
            range_.data(),
            points_.size(),
            follows};
  }

  void process(std::size_t i)
  {
    take(i);
    for (Row& row : rows_)
    {
      const double begin = cpuTime();
      row.chain->process(viewOf(points_));
      if (i > 0) row.cpu_ms.push_back(cpuTime() - begin);
      row.recall.addScan(recallScan(*row.chain, follows(i)));
      if (!settings_.output.empty()) save(row, i);
    }
    const auto& objects = rows_[0].recall.objects();
    misses_.push_back({static_cast<std::size_t>(std::count_if(objects.begin(), objects.end(),
                                                              [](const RecalledObject& object)
                                                              { return object.outcome != RecallOutcome::kFound; })),
                       i});
  }

  /// The ten scans with the most true objects that were not found.
  void drawWorst()
  {
    constexpr std::size_t kFigures = 10;
    std::stable_sort(misses_.begin(), misses_.end(),
                     [](const Misses& a, const Misses& b) { return a.count > b.count; });
    std::filesystem::create_directories(without_.plot);
    for (std::size_t k = 0; k < std::min(kFigures, misses_.size()); ++k)
    {
      const std::size_t i = misses_[k].scan;
      take(i);
      Row& row = rows_[0];
      row.chain->process(viewOf(points_));
      ObjectRecall recall(table_, row.recall.config());
      recall.addScan(recallScan(*row.chain, false));
      const auto file = "scan_" + scans_.sequence(i) + "_" + scans_.scanName(i) + ".png";
      drawRecallFigure("Sequence " + scans_.sequence(i) + ", scan " + scans_.scanName(i), *row.chain, recall, truth_,
                       *table_, (std::filesystem::path(without_.plot) / file).string());
    }
  }

  /// One label a point of the file: the id of the table "object" and the instance; 0 for points that were left out.
  void save(const Row& row, std::size_t i) const
  {
    std::vector<std::uint32_t> labels(scan_.points.size(), 0);
    for (std::size_t k = 0; k < chosen_.size(); ++k)
      labels[chosen_[k]] = row.chain->instanceIds()[k] << 16U | row.chain->labels()[k];
    std::string name = row.name;
    std::replace(name.begin(), name.end(), ' ', '_');
    const std::string base = (std::filesystem::path(settings_.output) / name).string();
    writeLabelFile(predictionFile(base, scans_.sequence(i), scans_.scanName(i)), labels);
  }

  static double cpuTime()
  {
    timespec time{};
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
    return 1e3 * static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_nsec);
  }

  BenchmarkSettings settings_;
  WithoutLabels without_;
  std::shared_ptr<const ClassTable> table_;
  BenchmarkScans scans_;
  std::vector<Row> rows_;
  BenchmarkScan scan_;
  std::vector<PointDirection> directions_;
  std::vector<std::uint32_t> chosen_;
  std::vector<ScanPoint> points_;
  std::vector<std::uint32_t> truth_;
  std::vector<float> range_;
  std::vector<Misses> misses_;  ///< of the first row, by scan
};
}  // namespace lidar_panoptic_clustering

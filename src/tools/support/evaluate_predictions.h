#pragma once

#include "lidar_panoptic_clustering/core/class_table.h"
#include "lidar_panoptic_clustering/datasets/predicted_classes.h"
#include "lidar_panoptic_clustering/datasets/semantic_kitti.h"
#include "lidar_panoptic_clustering/evaluation/evaluation_report.h"
#include "tools/support/progress.h"
#include "tools/support/run_threads.h"

#include <algorithm>
#include <atomic>
#include <filesystem>
#include <memory>
#include <mutex>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace lidar_panoptic_clustering
{
struct PredictionSet
{
  std::string dataset, predictions;    ///< folders that hold `sequences`
  std::vector<std::string> sequences;  ///< "00", ..; none: all of the data set that have ground truth
  int min_points = 50;
  int jobs = 1;
  bool keep_going = false;  ///< skip and count scans that cannot be evaluated
  bool temporal = false;    ///< ids from scan to scan too
};

/// Evaluates a folder of predictions against a data set. See evaluatePredictions.
class PredictionEvaluation
{
public:
  PredictionEvaluation(PredictionSet set, std::shared_ptr<const ClassTable> table)
      : set_(std::move(set)), table_(std::move(table)), report_(table_, set_.min_points)
  {
    if (set_.jobs < 1) throw std::invalid_argument("jobs is " + std::to_string(set_.jobs) + ", expected 1 or more");
    if (set_.temporal) report_.temporal.emplace(table_, set_.min_points);
    for (const std::string& name : sequenceNames()) addSequence(name);
    if (scans_.empty()) throw std::runtime_error("no scan with ground truth in " + set_.dataset);
  }

  EvaluationReport run()
  {
    Progress progress("evaluating", scans_.size());
    runThreads(std::min(static_cast<std::size_t>(set_.jobs), scans_.size()), [&] { work(progress); });
    if (!fatal_.scan.empty()) throw std::runtime_error(fatal_.reason);
    if (report_.quality.scanCount() == 0)
      throw std::runtime_error("none of the " + std::to_string(scans_.size()) + " scans could be evaluated");
    return report_;
  }

private:
  struct Scan
  {
    std::size_t sequence, number;
  };

  std::vector<std::string> sequenceNames() const
  {
    if (!set_.sequences.empty()) return set_.sequences;
    std::vector<std::string> names;
    for (const std::string& name : semanticKittiSequences(set_.dataset))
      if (std::filesystem::is_directory(std::filesystem::path(set_.dataset) / "sequences" / name / "labels"))
        names.push_back(name);
    return names;
  }

  void addSequence(const std::string& name)
  {
    for (const SemanticKittiSequence& other : sequences_)
      if (other.name() == name) throw std::invalid_argument("sequence " + name + " is given twice");
    SemanticKittiSequence sequence(set_.dataset, name, set_.predictions);
    if (!sequence.hasLabels())
      throw std::runtime_error("sequence " + name + " of " + set_.dataset + " has no folder 'labels' to compare with");
    std::vector<std::string> known;
    for (std::size_t i = 0; i < sequence.size(); ++i)
    {
      known.push_back(sequence.scanName(i));
      scans_.push_back({sequences_.size(), i});
    }
    const std::string folder =
        std::filesystem::path(predictionFile(set_.predictions, name, known.front())).parent_path().string();
    for (const std::string& scan : listScanFiles(folder, ".label"))
    {
      if (std::binary_search(known.begin(), known.end(), scan)) continue;
      const std::string reason = predictionFile(set_.predictions, name, scan) + ": a prediction without its scan in " +
                                 set_.dataset + "/sequences/" + name;
      if (!set_.keep_going) throw std::runtime_error(reason);
      report_.skipped.push_back({name + "/" + scan, reason});
    }
    sequences_.push_back(std::move(sequence));
  }

  /// One thread's share. Scans are taken in order, so that the error of the first bad scan is the one reported, however
  /// many threads there are.
  void work(Progress& progress)
  {
    EvaluationReport own(table_, set_.min_points);
    if (set_.temporal) own.temporal.emplace(table_, set_.min_points);
    ObjectErrors errors(set_.min_points);
    Buffers buffers;
    while (!stop_)
    {
      const std::size_t i = next_++;
      if (i >= scans_.size()) break;
      try
      {
        read(scans_[i], buffers);
        own.quality.addScan(buffers.predicted.data(), buffers.truth.data(), buffers.truth.size());
        for (const TrueObject& object : errors.judge(own.quality.lastScan())) own.objects.add(object.outcome);
        if (own.temporal) own.temporal->addScan(sequences_[scans_[i].sequence].name(), own.quality.lastScan());
      }
      catch (const std::exception& error)
      {
        if (!set_.keep_going) return failAt(i, error.what());
        progress.note("skipped " + nameOf(scans_[i]) + ": " + error.what());
        own.skipped.push_back({nameOf(scans_[i]), error.what()});
      }
      progress.step();
    }
    const std::lock_guard<std::mutex> lock(mutex_);
    report_ += own;
  }

  void failAt(std::size_t scan, const std::string& reason)
  {
    stop_ = true;
    const std::lock_guard<std::mutex> lock(mutex_);
    if (!fatal_.scan.empty() && fatal_index_ < scan) return;
    fatal_ = {nameOf(scans_[scan]), reason};
    fatal_index_ = scan;
  }

  struct Buffers
  {
    std::vector<std::uint32_t> truth, predicted;
  };

  void read(const Scan& scan, Buffers& buffers) const
  {
    const SemanticKittiSequence& sequence = sequences_[scan.sequence];
    const std::string& name = sequence.scanName(scan.number);
    const std::filesystem::path folder = std::filesystem::path(set_.dataset) / "sequences" / sequence.name();
    const std::string truth = (folder / "labels" / (name + ".label")).string();
    const std::filesystem::path points = folder / "velodyne" / (name + ".bin");
    if (std::filesystem::is_regular_file(points))
      sequence.readLabels(scan.number, std::filesystem::file_size(points) / (4 * sizeof(float)), buffers.truth);
    else
      readLabelFile(truth, buffers.truth);
    sequence.readPredictions(scan.number, buffers.truth.size(), buffers.predicted);
    requireKnownClasses(buffers.truth, *table_, truth);
    requireKnownClasses(buffers.predicted, *table_, predictionFile(set_.predictions, sequence.name(), name));
  }

  std::string nameOf(const Scan& scan) const
  {
    return sequences_[scan.sequence].name() + "/" + sequences_[scan.sequence].scanName(scan.number);
  }

  PredictionSet set_;
  std::shared_ptr<const ClassTable> table_;
  std::vector<SemanticKittiSequence> sequences_;
  std::vector<Scan> scans_;

  std::atomic<std::size_t> next_{0};
  std::atomic<bool> stop_{false};
  std::mutex mutex_;
  EvaluationReport report_;
  SkippedScan fatal_;  ///< no scan: none
  std::size_t fatal_index_ = 0;
};

/// Throws std::runtime_error naming the file, what was expected and what was found, when a folder or, without
/// keep_going, a scan cannot be evaluated: a file that is missing, short or too long, a prediction without its scan, an
/// id the class table does not name. The result does not depend on `jobs`.
inline EvaluationReport evaluatePredictions(PredictionSet set, std::shared_ptr<const ClassTable> table)
{
  return PredictionEvaluation(std::move(set), std::move(table)).run();
}
}  // namespace lidar_panoptic_clustering

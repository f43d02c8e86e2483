#pragma once

#include "lidar_panoptic_clustering/core/class_table.h"
#include "lidar_panoptic_clustering/datasets/predicted_classes.h"
#include "lidar_panoptic_clustering/datasets/semantic_kitti.h"
#include "lidar_panoptic_clustering/evaluation/evaluation_report.h"
#include "tools/support/benchmark_settings.h"

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

namespace lidar_panoptic_clustering
{
struct BenchmarkScan
{
  std::vector<ScanPoint> points;
  std::vector<std::uint32_t> truth;    ///< ground truth as in its file; empty where there is none, or none is needed
  std::vector<std::uint32_t> classes;  ///< the classes to cluster by, in the low 16 bits
};

/// The scans a benchmark runs on, in order. May be read from several threads.
class BenchmarkScans
{
public:
  /// Throws std::runtime_error or std::invalid_argument naming the folder when a sequence is missing, empty, given
  /// twice or has neither ground truth nor predicted classes, and naming the file when a prediction has no scan (with
  /// keep_going that goes into skipped()).
  BenchmarkScans(const BenchmarkSettings& settings, std::shared_ptr<const ClassTable> table)
      : dataset_(settings.dataset),
        semantics_(settings.semantics),
        label_table_(settings.label_table),
        table_(std::move(table)),
        keep_going_(settings.keep_going),
        needs_truth_(settings.evaluate || settings.semantics.empty()),
        quiet_(settings.quiet)
  {
    for (const std::string& name : sequenceNames(settings)) addSequence(name, settings.limit);
    std::vector<Place> share;
    for (std::size_t i = static_cast<std::size_t>(settings.shard) - 1; i < places_.size();
         i += static_cast<std::size_t>(settings.shards))
      share.push_back(places_[i]);
    if (share.empty())
      throw std::runtime_error("no scan in shard " + std::to_string(settings.shard) + "/" +
                               std::to_string(settings.shards) + " of " + std::to_string(places_.size()) + " scans");
    places_ = std::move(share);
  }

  std::size_t size() const { return places_.size(); }
  /// Predictions without a scan.
  const std::vector<SkippedScan>& skipped() const { return skipped_; }
  const std::string& sequence(std::size_t i) const { return sequenceOf(i).name(); }
  /// The file name without its ending, "000123".
  const std::string& scanName(std::size_t i) const { return sequenceOf(i).scanName(places_[i].number); }
  /// The sequence it belongs to, and its number there.
  const SemanticKittiSequence& sequenceOf(std::size_t i) const { return sequences_[places_[i].sequence]; }
  std::size_t numberOf(std::size_t i) const { return places_[i].number; }
  /// "08/000123"
  std::string name(std::size_t i) const { return sequence(i) + "/" + scanName(i); }

  /// Throws std::runtime_error naming the file, what was expected and what was found.
  void read(std::size_t i, BenchmarkScan& scan) const
  {
    const SemanticKittiSequence& sequence = sequenceOf(i);
    const std::size_t number = places_[i].number;
    sequence.readScan(number, scan.points);
    scan.truth.clear();
    if (needs_truth_ && sequence.hasLabels())
    {
      sequence.readLabels(number, scan.points.size(), scan.truth);
      requireKnownClasses(scan.truth, *table_, truthFile(i));
    }
    if (semantics_.empty())
    {
      scan.classes = scan.truth;
      return;
    }
    predicted_[places_[i].sequence].read(sequence, number, scan.points.size(), scan.classes);
  }

private:
  struct Place
  {
    std::size_t sequence, number;
  };

  static std::vector<std::string> sequenceNames(const BenchmarkSettings& settings)
  {
    if (!settings.sequences.empty()) return settings.sequences;
    std::vector<std::string> names;
    for (const std::string& name : semanticKittiSequences(settings.dataset))
      if (SemanticKittiSequence(settings.dataset, name).hasLabels()) names.push_back(name);
    if (names.empty()) throw std::runtime_error("no sequence of " + settings.dataset + " has a folder 'labels'");
    return names;
  }

  void addSequence(const std::string& name, int limit)
  {
    for (const SemanticKittiSequence& other : sequences_)
      if (other.name() == name) throw std::invalid_argument("sequence " + name + " is given twice");
    SemanticKittiSequence sequence(dataset_, name, semantics_);
    if (semantics_.empty() && !sequence.hasLabels())
      throw std::runtime_error("sequence " + name + " of " + dataset_ +
                               " has no folder 'labels' to take the classes from; give --semantics");
    if (!semantics_.empty())
    {
      requireScans(sequence);
      predicted_.emplace_back(sequence, table_, label_table_);
      if (!quiet_ && !predicted_.back().doubt().empty())
        std::fprintf(stderr, "sequence %s: %s\n", name.c_str(), predicted_.back().doubt().c_str());
    }
    const std::size_t count = limit == 0 ? sequence.size() : std::min(sequence.size(), static_cast<std::size_t>(limit));
    for (std::size_t i = 0; i < count; ++i) places_.push_back({sequences_.size(), i});
    sequences_.push_back(std::move(sequence));
  }

  void requireScans(const SemanticKittiSequence& sequence)
  {
    std::vector<std::string> known;
    for (std::size_t i = 0; i < sequence.size(); ++i) known.push_back(sequence.scanName(i));
    const std::filesystem::path first = predictionFile(semantics_, sequence.name(), known.front());
    for (const std::string& scan : listScanFiles(first.parent_path().string(), ".label"))
    {
      if (std::binary_search(known.begin(), known.end(), scan)) continue;
      const std::string reason = predictionFile(semantics_, sequence.name(), scan) +
                                 ": a prediction without its scan in " + dataset_ + "/sequences/" + sequence.name();
      if (!keep_going_) throw std::runtime_error(reason);
      skipped_.push_back({sequence.name() + "/" + scan, reason});
    }
  }

  std::string truthFile(std::size_t i) const
  {
    return (std::filesystem::path(dataset_) / "sequences" / sequence(i) / "labels" / (scanName(i) + ".label")).string();
  }

  std::string dataset_, semantics_, label_table_;
  std::shared_ptr<const ClassTable> table_;
  bool keep_going_, needs_truth_, quiet_;
  std::vector<SemanticKittiSequence> sequences_;
  std::vector<PredictedClasses> predicted_;  ///< by sequence, where there are predictions
  std::vector<Place> places_;
  std::vector<SkippedScan> skipped_;
};
}  // namespace lidar_panoptic_clustering

#pragma once

#include "lidar_panoptic_clustering/core/class_table.h"
#include "lidar_panoptic_clustering/datasets/predicted_classes.h"
#include "lidar_panoptic_clustering/datasets/semantic_kitti.h"

#include <cstdint>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

namespace lidar_panoptic_clustering
{
/// A SemanticKITTI folder: scans, ground truth, a network's classes and predictions, by sequence and scan. Sequences
/// are looked at when they are first asked for. May be used from several threads. All errors are std::runtime_error or
/// std::invalid_argument and name the file.
class DatasetReader
{
public:
  /// `semantics`: folder of a network's predictions, or empty for the ground truth; `label_table`: what its ids mean,
  /// empty for the class table.
  DatasetReader(const std::string& dataset, const std::string& semantics, const std::string& class_table,
                const std::string& label_table);

  /// "00", .. that hold scans.
  std::vector<std::string> sequences() const { return semanticKittiSequences(dataset_); }
  /// Of a sequence, in order, "000000".
  std::vector<std::string> scans(const std::string& sequence);
  /// A scan's number by its name. Throws std::invalid_argument where the sequence has no such scan.
  std::size_t numberOf(const std::string& sequence, const std::string& scan);
  /// Throws std::invalid_argument, with what there is, for a number that no scan has.
  void requireScan(const std::string& sequence, std::size_t scan);

  std::vector<ScanPoint> points(const std::string& sequence, std::size_t scan);
  /// Ground truth as in its file.
  std::vector<std::uint32_t> labels(const std::string& sequence, std::size_t scan);
  /// The classes to cluster by: the network's, by ids of the class table, or those of the ground truth.
  std::vector<std::uint32_t> classes(const std::string& sequence, std::size_t scan);
  std::vector<Eigen::Isometry3d> poses(const std::string& sequence);
  std::vector<double> times(const std::string& sequence);

  /// Writes root/sequences/SS/predictions/NAME.label, aside and then renamed; returns its path.
  std::string write(const std::string& root, const std::string& sequence, const std::string& scan,
                    const std::vector<std::uint32_t>& classes, const std::vector<std::uint32_t>& instances) const;

  const std::string& dataset() const { return dataset_; }
  const std::shared_ptr<const ClassTable>& table() const { return table_; }

private:
  struct Entry
  {
    SemanticKittiSequence files;
    std::unique_ptr<PredictedClasses> predicted;  ///< where there are predictions
  };
  const Entry& entry(const std::string& sequence);
  std::size_t pointCount(const std::string& sequence, const std::string& scan) const;

  std::string dataset_, semantics_, label_table_;
  std::shared_ptr<const ClassTable> table_;
  std::mutex mutex_;
  std::map<std::string, std::unique_ptr<Entry>> entries_;
};
}  // namespace lidar_panoptic_clustering

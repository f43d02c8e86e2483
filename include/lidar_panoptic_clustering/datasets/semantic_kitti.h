#pragma once

#include "lidar_panoptic_clustering/core/class_table.h"
#include "lidar_panoptic_clustering/projection/point_projection.h"

#include <Eigen/Geometry>

#include <cstdint>
#include <string>
#include <vector>

namespace lidar_panoptic_clustering
{
/// Label files (SemanticKITTI, Behley et al. 2019): a uint32 a point, raw class id in the low half, instance in the
/// high.
inline std::uint32_t rawClass(std::uint32_t label)
{
  return label & 0xFFFFU;
}
inline std::uint32_t rawInstance(std::uint32_t label)
{
  return label >> 16U;
}

/// One sequence of a data set folder: sequences/SS/{velodyne/*.bin, labels/*.label, poses.txt, calib.txt, times.txt}.
///
/// Scans are numbered 0..size()-1 in the order of their file names. All errors are std::runtime_error, and name the
/// file.
class SemanticKittiSequence
{
public:
  /// `root`: the folder that holds `sequences`; `predictions_root`: the like, with sequences/SS/predictions/*.label,
  /// or "". A scan is in the list when it has a file in `velodyne` or `labels`, so that one of which only one half is
  /// there is noticed when it is read. Throws when there is no such folder, or it holds no scan.
  SemanticKittiSequence(const std::string& root, const std::string& name, const std::string& predictions_root = "");

  const std::string& name() const { return name_; }
  std::size_t size() const { return scan_names_.size(); }
  /// The scan's file name without its ending, "000000".
  const std::string& scanName(std::size_t scan) const { return scan_names_.at(scan); }
  /// Whether there is a folder of ground truth (the test split has none).
  bool hasLabels() const { return has_labels_; }

  /// Reads a scan in one call into `points`. Throws when the file is missing or its size is no multiple of 16 bytes.
  void readScan(std::size_t scan, std::vector<ScanPoint>& points) const;
  /// Reads ground truth; throws when the file is missing or does not hold `point_count` labels.
  void readLabels(std::size_t scan, std::size_t point_count, std::vector<std::uint32_t>& labels) const;
  /// The same for the predictions given.
  void readPredictions(std::size_t scan, std::size_t point_count, std::vector<std::uint32_t>& labels) const;
  /// The file that readPredictions() reads.
  std::string predictionFile(std::size_t scan) const { return file(predictions_folder_, scan, ".label"); }

  /// The lidar's pose at each scan, in the lidar's frame at the sequence's first pose: Tr^-1 P Tr of the camera's poses
  /// P and the calibration Tr. Empty without poses.txt. A scan's number in its file name is its line there.
  /// KITTI's camera-only downloads have a calib.txt without Tr; the poses then only have the lidar's axes, and neglect
  /// how the camera is shifted and tilted against it: see hasCalibration().
  std::vector<Eigen::Isometry3d> readPoses() const;
  /// Whether calib.txt says where the lidar is (Tr). Throws when there is no calib.txt.
  bool hasCalibration() const;
  /// Time of each scan since the sequence's start [s]; empty without times.txt.
  std::vector<double> readTimes() const;

private:
  std::string file(const std::string& folder, std::size_t scan, const std::string& ending) const;
  std::size_t lineOf(std::size_t scan) const;

  std::string name_, folder_, predictions_folder_;
  std::vector<std::string> scan_names_;
  bool has_labels_ = false;
};

/// The sequences in `root`/sequences that hold scans or labels, sorted. Throws std::runtime_error when there is none.
std::vector<std::string> semanticKittiSequences(const std::string& root);

/// The official split "train", "valid" or "test". Throws std::invalid_argument for another name.
const std::vector<std::string>& semanticKittiSplit(const std::string& split);

/// Names, without their ending, of the folder's files that end in `ending` (".label"), sorted. Throws
/// std::runtime_error when there is no such folder.
std::vector<std::string> listScanFiles(const std::string& folder, const std::string& ending);

/// `root`/sequences/SS/predictions/NAME.label, where evaluation and leaderboard look for it.
std::string predictionFile(const std::string& root, const std::string& sequence, const std::string& scan_name);

/// Reads a label file of any length; throws std::runtime_error when it is missing, its size is no multiple of 4 bytes,
/// or it holds float32 numbers: read as uint32, all of these would be of class 0.
void readLabelFile(const std::string& path, std::vector<std::uint32_t>& labels);

/// Writes a label file, missing folders included: aside, then renamed, so that it is there whole or not at all. Throws
/// std::runtime_error with the file's name and the system's reason.
void writeLabelFile(const std::string& path, const std::vector<std::uint32_t>& labels);

/// The labels of a prediction: instance in the high half, the class's canonical id (10, not 252) in the low; class 0
/// for ids outside the table. Both inputs run parallel to the scan. Throws std::invalid_argument when their sizes
/// differ, and std::runtime_error on an instance above 65,535.
void encodeLabels(const std::vector<std::uint32_t>& classes, const std::vector<std::uint32_t>& instances,
                  const ClassTable& table, std::vector<std::uint32_t>& labels);
}  // namespace lidar_panoptic_clustering

#include "lidar_panoptic_clustering/datasets/semantic_kitti.h"

#include "core/input_file.h"
#include "core/plain_numbers.h"
#include "core/printable.h"
#include "datasets/binary_file.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <iterator>
#include <optional>
#include <sstream>
#include <stdexcept>
#include <utility>

namespace lidar_panoptic_clustering
{
namespace fs = std::filesystem;
namespace
{
void requireFolder(const fs::path& folder)
{
  if (!fs::is_directory(folder)) throw std::runtime_error("no such folder: " + folder.string());
}

constexpr std::size_t kMostShown = 300;                          // of a wrong line
constexpr std::uint64_t kMaxTextFile = std::uint64_t{1} << 28U;  // a pose takes 150 bytes

/// Folders stay below the data set's, and the outputs' below theirs.
void requireSequenceName(const std::string& name)
{
  if (name.empty() || name == "." || name == ".." || name.find('/') != std::string::npos ||
      name.find('\0') != std::string::npos)
    throw std::invalid_argument("sequence '" + printable(name, false) +
                                "': expected the name of one folder below 'sequences', as 08");
}

/// Metres and seconds far beyond any drive's; more would run over in stamps.
constexpr double kLargestNumber = 1e9;

/// Numbers of one line; throws naming file and line when there are not `count`.
std::vector<double> parseNumbers(const std::string& line, std::size_t count, const std::string& where)
{
  std::istringstream in(line);
  std::vector<double> numbers;
  for (std::string word; in >> word;)
  {
    const auto number = parseNumber(word);
    if (!number || std::abs(*number) > kLargestNumber)
      numbers.clear(), in.setstate(std::ios::failbit);
    else
      numbers.push_back(*number);
  }
  if (numbers.size() != count)
    throw std::runtime_error(where + ": expected " + std::to_string(count) + " numbers within 1e9, found '" +
                             printable(line.substr(0, kMostShown), false) + "'");
  return numbers;
}

Eigen::Isometry3d parsePose(const std::string& line, const std::string& where)
{
  const auto numbers = parseNumbers(line, 12, where);
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.matrix().topRows<3>() = Eigen::Map<const Eigen::Matrix<double, 3, 4, Eigen::RowMajor>>(numbers.data());
  return pose;
}

/// The lines up to the last that is not empty; none when there is no such file.
std::vector<std::string> readLines(const std::string& path)
{
  std::vector<std::string> lines;
  if (!fs::exists(path)) return lines;
  std::istringstream in(readTextFile(path, kMaxTextFile));
  for (std::string line; std::getline(in, line);) lines.push_back(line);
  while (!lines.empty() && lines.back().find_first_not_of(" \t\r") == std::string::npos) lines.pop_back();
  return lines;
}

std::string whereInFile(const std::string& path, std::size_t line)
{
  return path + ":" + std::to_string(line + 1);
}

const std::string& requireLine(const std::vector<std::string>& lines, std::size_t line, const std::string& path)
{
  if (line >= lines.size())
    throw std::runtime_error(path + ": expected at least " + std::to_string(line + 1) + " lines, found " +
                             std::to_string(lines.size()));
  return lines[line];
}

/// From the lidar's axes (x ahead, y left, z up) to the camera's (x right, y down, z ahead).
Eigen::Isometry3d axesOnly()
{
  Eigen::Isometry3d to_camera = Eigen::Isometry3d::Identity();
  to_camera.linear() << 0, -1, 0, 0, 0, -1, 1, 0, 0;
  return to_camera;
}

/// From the lidar's to the camera's frame; nothing when the file has no line "Tr:".
std::optional<Eigen::Isometry3d> readCalibration(const std::string& path)
{
  const auto lines = readLines(path);
  if (lines.empty()) throw std::runtime_error("cannot read " + path + ": expected KITTI's calibration, found no line");
  for (std::size_t i = 0; i < lines.size(); ++i)
    if (lines[i].rfind("Tr:", 0) == 0) return parsePose(lines[i].substr(3), whereInFile(path, i));
  return std::nullopt;
}

void readLabelsOf(const std::string& path, std::size_t point_count, std::vector<std::uint32_t>& labels)
{
  const std::uintmax_t bytes = point_count > 0 && fs::is_regular_file(path) ? fs::file_size(path) : 0;
  for (const auto& [type, size] : {std::pair{"uint8", 1}, std::pair{"uint16", 2}, std::pair{"int64", 8}})
    if (bytes == point_count * static_cast<std::size_t>(size) && bytes > 0)
      throw std::runtime_error(path + ": expected " + std::to_string(point_count) +
                               " uint32 labels, one a point, found " + std::to_string(bytes) + " bytes, as many as " +
                               type + " has: write them as uint32 (numpy: labels.astype('<u4').tofile(..))");
  readLabelFile(path, labels);
  if (labels.size() != point_count)
    throw std::runtime_error(path + ": expected " + std::to_string(point_count) + " labels, one a point, found " +
                             std::to_string(labels.size()));
}
}  // namespace

std::vector<std::string> listScanFiles(const std::string& folder, const std::string& ending)
{
  requireFolder(folder);
  std::vector<std::string> names;
  for (const auto& entry : fs::directory_iterator(folder))
    if (entry.path().extension() == ending) names.push_back(entry.path().stem().string());
  std::sort(names.begin(), names.end());
  return names;
}

std::vector<std::string> semanticKittiSequences(const std::string& root)
{
  const fs::path folder = fs::path(root) / "sequences";
  requireFolder(folder);
  std::vector<std::string> names;
  for (const auto& entry : fs::directory_iterator(folder))
    if (fs::is_directory(entry.path() / "velodyne") || fs::is_directory(entry.path() / "labels"))
      names.push_back(entry.path().filename().string());
  if (names.empty()) throw std::runtime_error("no sequence in " + folder.string() + " (expected NN/velodyne)");
  std::sort(names.begin(), names.end());
  return names;
}

const std::vector<std::string>& semanticKittiSplit(const std::string& split)
{
  static const std::vector<std::string> train{"00", "01", "02", "03", "04", "05", "06", "07", "09", "10"};
  static const std::vector<std::string> valid{"08"};
  static const std::vector<std::string> test{"11", "12", "13", "14", "15", "16", "17", "18", "19", "20", "21"};
  if (split == "train") return train;
  if (split == "valid") return valid;
  if (split == "test") return test;
  throw std::invalid_argument("split: expected train, valid or test, found '" + split + "'");
}

std::string predictionFile(const std::string& root, const std::string& sequence, const std::string& scan_name)
{
  requireSequenceName(sequence);
  return (fs::path(root) / "sequences" / sequence / "predictions" / (scan_name + ".label")).string();
}

SemanticKittiSequence::SemanticKittiSequence(const std::string& root, const std::string& name,
                                             const std::string& predictions_root)
    : name_(name), folder_((fs::path(root) / "sequences" / name).string())
{
  requireSequenceName(name);
  requireFolder(folder_);
  const std::string scans = folder_ + "/velodyne", labels = folder_ + "/labels";
  has_labels_ = fs::is_directory(labels);
  if (!has_labels_) requireFolder(scans);
  if (fs::is_directory(scans)) scan_names_ = listScanFiles(scans, ".bin");
  if (has_labels_)
  {
    std::vector<std::string> all;
    const auto labelled = listScanFiles(labels, ".label");
    std::set_union(scan_names_.begin(), scan_names_.end(), labelled.begin(), labelled.end(), std::back_inserter(all));
    scan_names_.swap(all);
  }
  if (scan_names_.empty()) throw std::runtime_error("no scan in " + scans + " (expected NNNNNN.bin)");
  if (predictions_root.empty()) return;
  predictions_folder_ = (fs::path(predictions_root) / "sequences" / name / "predictions").string();
  requireFolder(predictions_folder_);
}

std::string SemanticKittiSequence::file(const std::string& folder, std::size_t scan, const std::string& ending) const
{
  return folder + "/" + scanName(scan) + ending;
}

void SemanticKittiSequence::readScan(std::size_t scan, std::vector<ScanPoint>& points) const
{
  readBinaryFile(file(folder_ + "/velodyne", scan, ".bin"), points);
}

void SemanticKittiSequence::readLabels(std::size_t scan, std::size_t point_count,
                                       std::vector<std::uint32_t>& labels) const
{
  readLabelsOf(file(folder_ + "/labels", scan, ".label"), point_count, labels);
}

void SemanticKittiSequence::readPredictions(std::size_t scan, std::size_t point_count,
                                            std::vector<std::uint32_t>& labels) const
{
  if (predictions_folder_.empty()) throw std::runtime_error("no folder of predictions given for sequence " + name_);
  readLabelsOf(file(predictions_folder_, scan, ".label"), point_count, labels);
}

std::size_t SemanticKittiSequence::lineOf(std::size_t scan) const
{
  const auto& name = scanName(scan);
  std::size_t number = 0;
  const auto [end, error] = std::from_chars(name.data(), name.data() + name.size(), number);
  if (error != std::errc() || end != name.data() + name.size())
    throw std::runtime_error("expected a number as file name in " + folder_ + ", found '" + name + "'");
  return number;
}

bool SemanticKittiSequence::hasCalibration() const
{
  return readCalibration(folder_ + "/calib.txt").has_value();
}

std::vector<Eigen::Isometry3d> SemanticKittiSequence::readPoses() const
{
  const std::string path = folder_ + "/poses.txt";
  if (!fs::exists(path)) return {};
  const auto lines = readLines(path);
  const Eigen::Isometry3d to_camera = readCalibration(folder_ + "/calib.txt").value_or(axesOnly());
  std::vector<Eigen::Isometry3d> poses;
  poses.reserve(size());
  for (std::size_t scan = 0; scan < size(); ++scan)
  {
    const std::size_t line = lineOf(scan);
    const auto pose = parsePose(requireLine(lines, line, path), whereInFile(path, line));
    poses.push_back(to_camera.inverse() * pose * to_camera);
  }
  return poses;
}

std::vector<double> SemanticKittiSequence::readTimes() const
{
  const std::string path = folder_ + "/times.txt";
  if (!fs::exists(path)) return {};
  const auto lines = readLines(path);
  std::vector<double> times;
  times.reserve(size());
  for (std::size_t scan = 0; scan < size(); ++scan)
  {
    const std::size_t line = lineOf(scan);
    times.push_back(parseNumbers(requireLine(lines, line, path), 1, whereInFile(path, line)).front());
    if (times.back() < 0.0)
      throw std::runtime_error(whereInFile(path, line) + ": expected a time of 0 or more, found " + lines[line]);
  }
  return times;
}
}  // namespace lidar_panoptic_clustering

#include "python/dataset_reader.h"

#include <algorithm>
#include <filesystem>
#include <stdexcept>

namespace lidar_panoptic_clustering
{
DatasetReader::DatasetReader(const std::string& dataset, const std::string& semantics, const std::string& class_table,
                             const std::string& label_table)
    : dataset_(dataset),
      semantics_(semantics),
      label_table_(label_table),
      table_(std::make_shared<const ClassTable>(ClassTable::load(class_table)))
{
  if (!label_table.empty() && semantics.empty())
    throw std::invalid_argument("label_table says what the ids of semantics mean, which is not given");
  if (!std::filesystem::is_directory(std::filesystem::path(dataset) / "sequences"))
    throw std::invalid_argument("dataset: expected a folder that holds sequences/SS/velodyne, found none in '" +
                                dataset + "'");
}

const DatasetReader::Entry& DatasetReader::entry(const std::string& sequence)
{
  const std::lock_guard<std::mutex> lock(mutex_);
  std::unique_ptr<Entry>& found = entries_[sequence];
  if (!found)
  {
    auto made = std::make_unique<Entry>(Entry{SemanticKittiSequence(dataset_, sequence, semantics_), nullptr});
    if (!semantics_.empty()) made->predicted = std::make_unique<PredictedClasses>(made->files, table_, label_table_);
    found = std::move(made);
  }
  return *found;
}

std::vector<std::string> DatasetReader::scans(const std::string& sequence)
{
  const SemanticKittiSequence& files = entry(sequence).files;
  std::vector<std::string> names;
  for (std::size_t i = 0; i < files.size(); ++i) names.push_back(files.scanName(i));
  return names;
}

std::size_t DatasetReader::numberOf(const std::string& sequence, const std::string& scan)
{
  const SemanticKittiSequence& files = entry(sequence).files;
  for (std::size_t i = 0; i < files.size(); ++i)
    if (files.scanName(i) == scan) return i;
  throw std::invalid_argument("sequence " + sequence + " has no scan '" + scan + "', but " + files.scanName(0) +
                              " to " + files.scanName(files.size() - 1));
}

void DatasetReader::requireScan(const std::string& sequence, std::size_t scan)
{
  const std::size_t size = entry(sequence).files.size();
  if (scan >= size)
    throw std::invalid_argument("sequence " + sequence + ": expected a scan from 0 to " + std::to_string(size - 1) +
                                ", found " + std::to_string(scan));
}

std::vector<ScanPoint> DatasetReader::points(const std::string& sequence, std::size_t scan)
{
  std::vector<ScanPoint> points;
  entry(sequence).files.readScan(scan, points);
  return points;
}

/// Without reading them.
std::size_t DatasetReader::pointCount(const std::string& sequence, const std::string& scan) const
{
  return std::filesystem::file_size(std::filesystem::path(dataset_) / "sequences" / sequence / "velodyne" /
                                    (scan + ".bin")) /
         sizeof(ScanPoint);
}

std::vector<std::uint32_t> DatasetReader::labels(const std::string& sequence, std::size_t scan)
{
  const SemanticKittiSequence& files = entry(sequence).files;
  std::vector<std::uint32_t> labels;
  files.readLabels(scan, pointCount(sequence, files.scanName(scan)), labels);
  return labels;
}

std::vector<std::uint32_t> DatasetReader::classes(const std::string& sequence, std::size_t scan)
{
  const Entry& of = entry(sequence);
  std::vector<std::uint32_t> classes;
  if (of.predicted)
    of.predicted->read(of.files, scan, pointCount(sequence, of.files.scanName(scan)), classes);
  else
    classes = labels(sequence, scan);
  for (std::uint32_t& label : classes) label = rawClass(label);
  return classes;
}

std::vector<Eigen::Isometry3d> DatasetReader::poses(const std::string& sequence)
{
  return entry(sequence).files.readPoses();
}

std::vector<double> DatasetReader::times(const std::string& sequence)
{
  return entry(sequence).files.readTimes();
}

std::string DatasetReader::write(const std::string& root, const std::string& sequence, const std::string& scan,
                                 const std::vector<std::uint32_t>& classes,
                                 const std::vector<std::uint32_t>& instances) const
{
  std::vector<std::uint32_t> labels;
  encodeLabels(classes, instances, *table_, labels);
  const std::string path = predictionFile(root, sequence, scan);
  writeLabelFile(path, labels);
  return path;
}
}  // namespace lidar_panoptic_clustering

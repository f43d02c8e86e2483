#pragma once

#include "lidar_panoptic_clustering/datasets/semantic_kitti.h"
#include "lidar_panoptic_clustering/evaluation/frame_times.h"
#include "tools/support/aside_file.h"
#include "tools/support/benchmark_settings.h"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <mutex>
#include <sstream>
#include <stdexcept>
#include <string>
#include <variant>
#include <vector>

namespace lidar_panoptic_clustering
{
/// A prediction that could not be written: ends a benchmark even when it skips bad scans.
struct OutputError : std::runtime_error
{
  using std::runtime_error::runtime_error;
};

/// The predictions of one row: OUTPUT/ROW/sequences/SS/predictions/NNNNNN.label, which as a folder is what the
/// leaderboard takes (spaces in the row's name are underscores). Beside it lie OUTPUT/ROW.settings, what they were made
/// with, and OUTPUT/ROW.times.csv, a line a scan. A run with the same settings goes on where the last one stopped.
///
/// May be used from several threads, and by several shards at once.
class RowOutput
{
public:
  /// Throws std::runtime_error when the folder cannot be written, or holds predictions of other settings.
  RowOutput(const BenchmarkSettings& settings, const RowSettings& row) : base_(baseOf(settings, row))
  {
    std::error_code failed;
    std::filesystem::create_directories(base_, failed);
    if (failed) throw OutputError("cannot write " + base_ + ": " + failed.message());
    agreeOnSettings(describe(settings, row));
    readTimes();
  }

  /// Whether the scan was finished by a run before. Then `labels` holds its prediction and `time` its time, which is
  /// unnamed when it is not known. A file of another length than the scan's is no prediction of it.
  bool load(const std::string& sequence, const std::string& scan, std::size_t points,
            std::vector<std::uint32_t>& labels, FrameTime& time) const
  {
    const std::string path = predictionFile(base_, sequence, scan);
    std::error_code missing;
    const auto bytes = std::filesystem::file_size(path, missing);
    if (missing || bytes != points * sizeof(std::uint32_t)) return false;
    readLabelFile(path, labels);
    const auto known = times_.find(sequence + "/" + scan);
    time = known == times_.end() ? FrameTime{} : known->second;
    return true;
  }

  /// The time goes first, so that no finished prediction lacks it. Throws OutputError.
  void save(const std::string& sequence, const std::string& scan, const std::vector<std::uint32_t>& labels,
            const FrameTime& time)
  {
    try
    {
      appendTime(time);
      writeLabelFile(predictionFile(base_, sequence, scan), labels);
    }
    catch (const std::exception& error)
    {
      throw OutputError(error.what());
    }
  }

private:
  static std::string baseOf(const BenchmarkSettings& settings, const RowSettings& row)
  {
    std::string name = row.name;
    std::replace(name.begin(), name.end(), ' ', '_');
    return (std::filesystem::path(settings.output) / name).string();
  }

  /// All that decides the predictions, defaults included.
  static std::string describe(const BenchmarkSettings& settings, const RowSettings& row)
  {
    std::ostringstream text;
    text << "semantics: " << (settings.semantics.empty() ? "ground truth" : settings.semantics) << "\n"
         << "class table: " << settings.class_table << "\n"
         << "columns: " << settings.columns << "\n"
         << "algorithm: " << row.algorithm << "\n";
    if (settings.track) text << "tracked: true\n";
    const ParameterMap parameters = row.allParameters();
    for (const ParameterInfo& info : algorithmParameters(row.algorithm))
    {
      const auto given = parameters.find(info.name);
      std::visit([&](const auto& value) { text << info.name << ": " << std::boolalpha << value << "\n"; },
                 given == parameters.end() ? info.value : given->second);
    }
    return text.str();
  }

  void agreeOnSettings(const std::string& wanted) const
  {
    const std::string path = base_ + ".settings";
    std::ifstream file(path, std::ios::binary);
    if (!file) return AsideFile(path).save(wanted);
    std::istringstream found(std::string{std::istreambuf_iterator<char>(file), {}}), expected(wanted);
    std::string found_line, expected_line;
    while (std::getline(expected, expected_line))
    {
      if (!std::getline(found, found_line)) found_line.clear();
      if (found_line != expected_line)
        throw std::runtime_error(base_ + " holds predictions with '" + found_line + "', this run has '" +
                                 expected_line + "': choose another --output, or remove the folder and " + path);
    }
  }

  std::string timesFile() const { return base_ + ".times.csv"; }

  /// Lines cut short by a full disk are left out.
  void readTimes()
  {
    std::ifstream file(timesFile());
    for (std::string line; std::getline(file, line);)
    {
      char name[64];
      FrameTime time;
      int end = 0;
      std::sscanf(line.c_str(), "%63[^,],%u,%u,%lf,%lf;%n", name, &time.points, &time.thing_points, &time.cluster_ms,
                  &time.pipeline_ms, &end);
      if (end == 0) continue;
      time.scan = name;
      times_[time.scan] = time;
    }
  }

  /// One write a line, so that threads and shards do not mix theirs, and nothing is lost when the program is killed. A
  /// line begins with its line break: what a full disk cut short before it stays a line of its own.
  void appendTime(const FrameTime& time)
  {
    char line[160];
    const int length = std::snprintf(line, sizeof line, "\n%s,%u,%u,%.17g,%.17g;", time.scan.c_str(), time.points,
                                     time.thing_points, time.cluster_ms, time.pipeline_ms);
    const int file = ::open(timesFile().c_str(), O_WRONLY | O_CREAT | O_APPEND | O_CLOEXEC, 0666);
    bool written = file >= 0 && ::write(file, line, static_cast<std::size_t>(length)) == length;
    const int error = errno;
    if (file >= 0 && ::close(file) != 0) written = false;
    if (!written) throw OutputError("cannot write " + timesFile() + ": " + std::strerror(error));
  }

  std::string base_;
  std::map<std::string, FrameTime> times_;  ///< of runs before, by scan
};
}  // namespace lidar_panoptic_clustering

#pragma once

#include "core/aside_file.h"
#include "core/input_file.h"
#include "core/plain_numbers.h"
#include "core/printable.h"
#include "lidar_panoptic_clustering/core/version.h"
#include "lidar_panoptic_clustering/datasets/semantic_kitti.h"
#include "lidar_panoptic_clustering/evaluation/frame_times.h"
#include "tools/support/benchmark_settings.h"
#include "tools/support/fingerprint.h"
#include "tools/support/scan_log.h"

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <limits>
#include <optional>
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
/// with, OUTPUT/ROW.scans.csv, what of (a fingerprint a scan), and OUTPUT/ROW.times.csv. A run with the same settings
/// goes on where the last one stopped; one with others, or with another scan of the same name, is refused. Without
/// folders a row it is OUTPUT/sequences and OUTPUT/predictions.settings and so on.
///
/// May be used from several threads, and by several shards at once.
class RowOutput
{
public:
  /// Throws std::runtime_error when the folder cannot be written, or holds predictions of other settings.
  RowOutput(const BenchmarkSettings& settings, const RowSettings& row, const ClassTable& table)
      : base_(madeBase(settings, row)),
        records_(settings.row_folders ? base_ : (std::filesystem::path(base_) / "predictions").string()),
        scans_(records_ + ".scans.csv", 1),
        times_(records_ + ".times.csv", 4)
  {
    agreeOnSettings(describe(settings, row, table));
  }

  /// Whether the scan was finished by a run before. Then `labels` holds its prediction and `time` its time, which is
  /// unnamed when it is not known. A file of another length than the scan's is no prediction of it, nor is one that
  /// nothing is known of. `made_of`: the fingerprint of all that was read of the scan. Throws OutputError when the
  /// prediction was made of something else.
  bool load(const std::string& sequence, const std::string& scan, const std::string& made_of, std::size_t points,
            std::vector<std::uint32_t>& labels, FrameTime& time) const
  {
    const std::string path = predictionFile(base_, sequence, scan), name = sequence + "/" + scan;
    std::error_code missing;
    const auto bytes = std::filesystem::file_size(path, missing);
    const auto* known = scans_.find(name);
    if (missing || known == nullptr) return false;
    if (known->front() != made_of)
      throw OutputError(path +
                        " was made of another scan, or of other classes, than are read now: choose another "
                        "--output, or remove the folder");
    if (bytes != points * sizeof(std::uint32_t)) return false;
    readLabelFile(path, labels);
    time = timeOf(name);
    return true;
  }

  /// The prediction goes last, so that no finished one lacks its fingerprint and time. Throws OutputError.
  void save(const std::string& sequence, const std::string& scan, const std::string& made_of,
            const std::vector<std::uint32_t>& labels, const FrameTime& time)
  {
    try
    {
      scans_.append(time.scan, {made_of});
      times_.append(time.scan, {std::to_string(time.points), std::to_string(time.thing_points),
                                shortText(time.cluster_ms, 17), shortText(time.pipeline_ms, 17)});
      writeLabelFile(predictionFile(base_, sequence, scan), labels);
    }
    catch (const std::exception& error)
    {
      throw OutputError(error.what());
    }
  }

private:
  static std::string madeBase(const BenchmarkSettings& settings, const RowSettings& row)
  {
    std::string name = row.name;
    std::replace(name.begin(), name.end(), ' ', '_');
    const std::filesystem::path output = settings.output;
    const std::string base = (settings.row_folders ? output / name : output).string();
    std::error_code failed;
    std::filesystem::create_directories(base, failed);
    if (failed) throw OutputError("cannot write " + base + ": " + failed.message());
    return base;
  }

  /// Nothing where the ids are the class table's.
  static std::string describeLabelTable(const std::string& name)
  {
    if (name.empty()) return "";
    return "\nlabel table: " + printable(name, false) + ", content " + fingerprintOf(ClassTable::load(name));
  }

  /// All that decides the predictions but the scans themselves, defaults included.
  static std::string describe(const BenchmarkSettings& settings, const RowSettings& row, const ClassTable& table)
  {
    std::string text =
        "semantics: " + printable(settings.semantics.empty() ? "ground truth" : settings.semantics, false) +
        "\nclass table: " + printable(settings.class_table, false) + ", content " + fingerprintOf(table) +
        describeLabelTable(settings.label_table) + "\ncolumns: " + std::to_string(settings.columns) +
        "\nalgorithm: " + row.algorithm + "\n";
    if (settings.track) text += "tracked: true\n";
    const ParameterMap parameters = row.allParameters();
    for (const ParameterInfo& info : algorithmParameters(row.algorithm))
    {
      const auto given = parameters.find(info.name);
      text += info.name + ": " + parameterText(given == parameters.end() ? info.value : given->second) + "\n";
    }
    return text + "version: " + version() + "\n";
  }

  void agreeOnSettings(const std::string& wanted) const
  {
    constexpr std::uint64_t kMaxSettings = 1U << 20U;
    const std::string path = records_ + ".settings";
    // of several processes that find none the first to save has its way
    if (!std::filesystem::exists(path) && AsideFile(path).saveIfNone(wanted)) return;
    std::istringstream found(readTextFile(path, kMaxSettings)), expected(wanted);
    for (;;)
    {
      std::string found_line, expected_line;
      const bool has_found = static_cast<bool>(std::getline(found, found_line));
      const bool has_expected = static_cast<bool>(std::getline(expected, expected_line));
      if (!has_found && !has_expected) return;
      if (found_line != expected_line)
        throw std::runtime_error(base_ + " holds predictions with '" + found_line + "', this run has '" +
                                 expected_line + "': choose another --output, or remove the folder and " + path);
    }
  }

  FrameTime timeOf(const std::string& scan) const
  {
    const auto* fields = times_.find(scan);
    if (fields == nullptr) return {};
    const auto count = [](const std::string& text) -> std::optional<double>
    {
      const auto number = parseNumber(text);
      return number && *number >= 0.0 && *number <= std::numeric_limits<std::uint32_t>::max() ? number : std::nullopt;
    };
    const auto points = count((*fields)[0]), things = count((*fields)[1]);
    const auto cluster = parseNumber((*fields)[2]), pipeline = parseNumber((*fields)[3]);
    if (!points || !things || !cluster || !pipeline) return {};
    return {scan, static_cast<std::uint32_t>(*points), static_cast<std::uint32_t>(*things), *cluster, *pipeline};
  }

  std::string base_, records_;  ///< folder, and how the names begin of what is written beside the predictions
  ScanLog scans_, times_;
};
}  // namespace lidar_panoptic_clustering

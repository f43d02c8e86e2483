#include "lidar_panoptic_clustering/evaluation/benchmark_report.h"

#include "core/plain_numbers.h"
#include "core/printable.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <stdexcept>

namespace lidar_panoptic_clustering
{
namespace
{
constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

struct Published
{
  const char* row;
  double pq, time_ms;
};

/// Zhao, Yang, Jiang et al., "A Technical Survey and Evaluation of Traditional Point Cloud Clustering Methods for
/// LiDAR Panoptic Segmentation", ICCV workshops 2021: sequence 08 with Cylinder3D's semantics.
constexpr Published kPublished[] = {{"euclidean", 56.9, 16.2},
                                    {"supervoxel", 52.8, 62.5},
                                    {"supervoxel normal_weight=0.5", 52.7, kNone},
                                    {"depth", 55.2, 18.1},
                                    {"scan_line_run", 57.2, 29.0}};

Published publishedOf(const std::string& row)
{
  for (const Published& published : kPublished)
    if (row == published.row) return published;
  return {"", kNone, kNone};
}

bool isWholeValidation(const BenchmarkReport& report)
{
  constexpr std::uint64_t kScansOf08 = 4071;
  return report.scans.size() == 1 && report.scans.count("08") != 0 && report.scans.at("08") == kScansOf08;
}

/// A table's column: a heading of up to three lines and a number a row; NaN prints "-".
struct Column
{
  std::string over, heading, unit;
  int width, decimals;
  std::vector<double> values;
};

std::string padded(const std::string& text, int width)
{
  const std::string spaces(std::max(0, width - static_cast<int>(text.size())), ' ');
  return spaces + text;
}

std::string printed(double value, int decimals)
{
  if (std::isnan(value)) return "-";
  return fixedText(value, decimals);
}

std::vector<Column> qualityColumns(const BenchmarkReport& report)
{
  std::vector<Column> columns = {
      {"all", "PQ", "%", 7, 1, {}},      {"", "PQ+", "%", 6, 1, {}},      {"", "RQ", "%", 6, 1, {}},
      {"", "SQ", "%", 6, 1, {}},         {"things", "PQ", "%", 8, 1, {}}, {"", "RQ", "%", 6, 1, {}},
      {"", "SQ", "%", 6, 1, {}},         {"occur", "PQ", "%", 6, 1, {}},  {"stuff", "PQ", "%", 7, 1, {}},
      {"mIoU", "before", "%", 8, 1, {}}, {"", "after", "%", 6, 1, {}},    {"objects", "split", "", 9, 0, {}},
      {"", "merged", "", 7, 0, {}},      {"", "missed", "", 7, 0, {}},    {"", "of", "", 6, 0, {}}};
  const double miou_before = report.before.quality.figures().miou;
  for (const BenchmarkRow& row : report.rows)
  {
    const PanopticFigures f = row.evaluation.quality.figures();
    const ObjectErrorCounts& o = row.evaluation.objects;
    const double values[] = {100 * f.pq,
                             100 * f.pq_dagger,
                             100 * f.rq,
                             100 * f.sq,
                             100 * f.pq_th,
                             100 * f.rq_th,
                             100 * f.sq_th,
                             100 * f.pq_th_present,
                             100 * f.pq_st,
                             100 * miou_before,
                             100 * f.miou,
                             static_cast<double>(o.split),
                             static_cast<double>(o.merged),
                             static_cast<double>(o.missed),
                             static_cast<double>(o.total())};
    for (std::size_t c = 0; c < columns.size(); ++c) columns[c].values.push_back(values[c]);
  }
  return columns;
}

std::vector<Column> timeColumns(const BenchmarkReport& report)
{
  std::vector<Column> columns = {
      {"clustering", "median", "ms", 11, 2, {}}, {"", "p95", "ms", 8, 2, {}}, {"", "max", "ms", 8, 2, {}},
      {"pipeline", "median", "ms", 9, 2, {}},    {"", "p95", "ms", 8, 2, {}}, {"", "max", "ms", 8, 2, {}}};
  for (const BenchmarkRow& row : report.rows)
  {
    const TimeSummary cluster = summarize(row.times, &FrameTime::cluster_ms);
    const TimeSummary pipeline = summarize(row.times, &FrameTime::pipeline_ms);
    const double values[] = {cluster.median_ms,  cluster.p95_ms,  cluster.max_ms,
                             pipeline.median_ms, pipeline.p95_ms, pipeline.max_ms};
    for (std::size_t c = 0; c < columns.size(); ++c) columns[c].values.push_back(row.times.empty() ? kNone : values[c]);
  }
  return columns;
}

std::vector<Column> publishedColumns(const BenchmarkReport& report)
{
  std::vector<Column> columns = {{"survey's:", "PQ", "%", 10, 1, {}}, {"", "time", "ms", 7, 1, {}}};
  for (const BenchmarkRow& row : report.rows)
  {
    const Published published = publishedOf(row.name);
    columns[0].values.push_back(published.pq);
    columns[1].values.push_back(published.time_ms);
  }
  return columns;
}

std::size_t nameWidth(const BenchmarkReport& report)
{
  std::size_t width = 0;
  for (const BenchmarkRow& row : report.rows) width = std::max(width, printable(row.name, false).size());
  return width;
}

std::size_t widthOf(const std::vector<Column>& columns)
{
  return std::accumulate(columns.begin(), columns.end(), std::size_t{0},
                         [](std::size_t sum, const Column& c) { return sum + static_cast<std::size_t>(c.width); });
}

std::string formatTable(const BenchmarkReport& report, const std::vector<Column>& columns)
{
  const std::size_t name_width = nameWidth(report);
  std::string out;
  for (std::string Column::*line : {&Column::over, &Column::heading, &Column::unit})
  {
    out += std::string(name_width, ' ');
    for (const Column& column : columns) out += padded(column.*line, column.width);
    out.erase(out.find_last_not_of(' ') + 1);
    out += "\n";
  }
  for (std::size_t r = 0; r < report.rows.size(); ++r)
  {
    const std::string name = printable(report.rows[r].name, false);
    out += name + std::string(name_width - name.size(), ' ');
    for (const Column& column : columns) out += padded(printed(column.values[r], column.decimals), column.width);
    out += "\n";
  }
  return out;
}

std::string scanList(const BenchmarkReport& report)
{
  std::uint64_t total = 0;
  std::string sequences;
  for (const auto& [sequence, count] : report.scans) total += count, sequences += " " + printable(sequence, false);
  return std::to_string(total) + " scans of sequence" + (report.scans.size() == 1 ? "" : "s") + sequences;
}

std::vector<std::string> namesOf(const BenchmarkReport& report)
{
  std::vector<std::string> names;
  for (const BenchmarkRow& row : report.rows) names.push_back(row.name);
  return names;
}
}  // namespace

std::string formatComparison(const std::vector<BenchmarkReport>& reports, const std::vector<std::string>& headings)
{
  if (reports.empty() || reports.size() != headings.size())
    throw std::invalid_argument("expected as many headings as reports, found " + std::to_string(headings.size()) +
                                " and " + std::to_string(reports.size()));
  std::vector<Column> columns;
  for (std::size_t i = 0; i < reports.size(); ++i)
  {
    if (namesOf(reports[i]) != namesOf(reports[0]))
      throw std::invalid_argument("expected the rows of " + headings[0] + " in " + headings[i] + ", found others");
    if (reports[i].before.quality.scanCount() == 0)
      throw std::invalid_argument(headings[i] + ": expected scans with ground truth, found none");
    const int width = std::max<int>(8, static_cast<int>(headings[i].size()) + 2);
    columns.push_back({i == 0 ? "occur" : "", headings[i], "PQ %", width, 1, {}});
    for (const BenchmarkRow& row : reports[i].rows)
      columns.back().values.push_back(100 * row.evaluation.quality.figures().pq_th_present);
  }
  columns.push_back(timeColumns(reports.back())[3]);
  return formatTable(reports[0], columns);
}

std::string formatBenchmark(const BenchmarkReport& report, std::size_t width)
{
  const bool evaluated = report.before.quality.scanCount() > 0;
  std::vector<Column> quality = evaluated ? qualityColumns(report) : std::vector<Column>{};
  std::vector<Column> time = timeColumns(report);
  if (evaluated && isWholeValidation(report))
    for (Column& column : publishedColumns(report)) time.push_back(std::move(column));

  const bool side_by_side = width == 0 || nameWidth(report) + widthOf(quality) + widthOf(time) <= width;
  std::string out = "Semantics: " + printable(report.semantics, false) + "; ";
  out += evaluated ? scanList(report) + " evaluated" : std::string("no ground truth to evaluate with");
  out += ", " + std::to_string(report.before.skipped.size()) + " skipped" +
         (report.interrupted ? "; interrupted" : "") + "\n\n";
  if (side_by_side)
  {
    quality.insert(quality.end(), time.begin(), time.end());
    return out + formatTable(report, quality);
  }
  if (evaluated) out += formatTable(report, quality) + "\n";
  return out + formatTable(report, time);
}
}  // namespace lidar_panoptic_clustering

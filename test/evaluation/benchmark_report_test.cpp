#include "lidar_panoptic_clustering/evaluation/benchmark_report.h"

#include <gtest/gtest.h>

#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

namespace lidar_panoptic_clustering
{
namespace
{
TEST(FrameTimes, MedianPercentileAndMaximum)
{
  std::vector<FrameTime> times;
  EXPECT_EQ(summarize(times, &FrameTime::cluster_ms).max_ms, 0.0);
  for (int i = 100; i > 0; --i) times.push_back({"", 0, 0, static_cast<double>(i), 0.0});
  const TimeSummary even = summarize(times, &FrameTime::cluster_ms);
  EXPECT_EQ(even.median_ms, 50.5);
  EXPECT_EQ(even.p95_ms, 95.0);
  EXPECT_EQ(even.max_ms, 100.0);
  times.push_back({"", 0, 0, 1000.0, 0.0});
  EXPECT_EQ(summarize(times, &FrameTime::cluster_ms).median_ms, 51.0);
  EXPECT_EQ(summarize(times, &FrameTime::cluster_ms).p95_ms, 96.0);
}

TEST(FormatBenchmark, TheSurveysFiguresStandBesideTheWholeOf08Only)
{
  const auto table = std::make_shared<const ClassTable>(ClassTable::load("semantic_kitti"));
  BenchmarkReport report("ground truth", {"scan_line_run", "supervoxel normal_weight=0.5"}, table);
  report.before.quality.restore(std::vector<ClassCounts>(table->size()), 4071);
  report.scans["08"] = 4071;
  EXPECT_NE(formatBenchmark(report).find("57.2   29.0"), std::string::npos) << formatBenchmark(report);
  EXPECT_NE(formatBenchmark(report).find("52.7      -"), std::string::npos) << formatBenchmark(report);
  EXPECT_NE(formatBenchmark(report).find("survey's"), std::string::npos);
  report.scans["08"] = 4070;
  EXPECT_EQ(formatBenchmark(report).find("57.2"), std::string::npos);
  report.scans["08"] = 4071, report.scans["00"] = 1;
  EXPECT_EQ(formatBenchmark(report).find("57.2"), std::string::npos);
}

TEST(FormatBenchmark, TablesBelowEachOtherWhereTheyDoNotFit)
{
  const auto table = std::make_shared<const ClassTable>(ClassTable::load("semantic_kitti"));
  BenchmarkReport report("ground truth", {"depth"}, table);
  report.before.quality.restore(std::vector<ClassCounts>(table->size()), 1);
  const auto rowsOf = [](const std::string& text)
  {
    std::size_t count = 0;
    for (std::size_t at = text.find("\ndepth"); at != std::string::npos; at = text.find("\ndepth", at + 1)) ++count;
    return count;
  };
  EXPECT_EQ(rowsOf(formatBenchmark(report)), 1U);
  EXPECT_EQ(rowsOf(formatBenchmark(report, 300)), 1U);
  EXPECT_EQ(rowsOf(formatBenchmark(report, 80)), 2U);
}

BenchmarkReport smallReport(const std::shared_ptr<const ClassTable>& table, const std::string& scan)
{
  BenchmarkReport report("net", {"depth", "euclidean distance_m=3"}, table);
  const std::vector<std::uint32_t> truth(100, 7U << 16U | 10U), found(100, 3U << 16U | 10U);
  report.before.quality.addScan(truth.data(), truth.data(), truth.size());
  report.rows[0].evaluation.quality.addScan(found.data(), truth.data(), truth.size());
  report.rows[0].times.push_back({scan, 100, 90, 0.1, 1.0 / 3.0});
  report.scans["08"] = 1;
  return report;
}

TEST(BenchmarkReport, SavedAndLoadedIsTheSame)
{
  const auto table = std::make_shared<const ClassTable>(ClassTable::load("semantic_kitti"));
  const std::string text = smallReport(table, "08/000001").toJsonText();
  EXPECT_EQ(BenchmarkReport::fromJsonText(text, "r.json", table).toJsonText(), text);
  EXPECT_EQ(BenchmarkReport::classTableOf(text, "r.json"), "semantic_kitti");
  for (const std::string broken : {"", "[]", "{}", "{\"rows\": [1], \"quality\": {}}"})
    EXPECT_THROW(BenchmarkReport::fromJsonText(broken, "r.json", table), std::invalid_argument) << broken;
}

TEST(BenchmarkReport, PartsAddUpInAnyOrder)
{
  const auto table = std::make_shared<const ClassTable>(ClassTable::load("semantic_kitti"));
  BenchmarkReport ab = smallReport(table, "08/000001"), ba = smallReport(table, "08/000002");
  ab += smallReport(table, "08/000002");
  ba += smallReport(table, "08/000001");
  EXPECT_EQ(ab.toJsonText(), ba.toJsonText());
  EXPECT_EQ(ab.scans.at("08"), 2U);
  EXPECT_THROW(ab += smallReport(table, "08/000002"), std::invalid_argument);
  BenchmarkReport others("net", {"depth"}, table);
  EXPECT_THROW(ab += others, std::invalid_argument);
  others = smallReport(table, "08/000003");
  others.semantics = "ground truth";
  EXPECT_THROW(ab += others, std::invalid_argument);
}
}  // namespace
}  // namespace lidar_panoptic_clustering

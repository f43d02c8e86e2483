#pragma once

#include "lidar_panoptic_clustering/drawing/chart.h"
#include "lidar_panoptic_clustering/evaluation/benchmark_report.h"

#include <filesystem>
#include <functional>
#include <limits>
#include <string>
#include <vector>

namespace lidar_panoptic_clustering
{
namespace detail
{
inline std::string chartSubtitle(const BenchmarkReport& report)
{
  std::uint64_t total = 0;
  std::string sequences;
  for (const auto& [sequence, count] : report.scans)
    total += count, sequences += (sequences.empty() ? "" : ", ") + sequence;
  return "semantics: " + report.semantics + "; " + std::to_string(total) + " scans evaluated, sequences " + sequences;
}

inline BarChart rowChart(const BenchmarkReport& report, const std::string& title, const std::string& axis)
{
  BarChart chart;
  chart.frame.title = title;
  chart.frame.subtitle = chartSubtitle(report);
  chart.y.title = axis;
  chart.y.min = 0.0;
  for (const BenchmarkRow& row : report.rows) chart.categories.push_back(row.name);
  return chart;
}

inline void addSeries(BarChart& chart, const BenchmarkReport& report, const std::string& name,
                      const std::function<double(const BenchmarkRow&)>& value)
{
  BarChart::Series series;
  series.name = name;
  for (const BenchmarkRow& row : report.rows) series.values.push_back(value(row));
  chart.series.push_back(std::move(series));
}

inline BarChart qualityChart(const BenchmarkReport& report)
{
  BarChart chart = rowChart(report, "Quality", "[%]");
  chart.y.max = 100.0;
  const auto add = [&](const std::string& name, double PanopticFigures::*figure)
  {
    addSeries(chart, report, name,
              [&](const BenchmarkRow& row) { return 100.0 * (row.evaluation.quality.figures().*figure); });
  };
  add("PQ", &PanopticFigures::pq);
  add("RQ", &PanopticFigures::rq);
  add("SQ", &PanopticFigures::sq);
  add("PQ of things", &PanopticFigures::pq_th);
  add("PQ of things that occur", &PanopticFigures::pq_th_present);
  return chart;
}

inline BarChart objectChart(const BenchmarkReport& report)
{
  BarChart chart = rowChart(report, "True objects that were not found", "true objects");
  chart.decimals = 0;
  const auto add = [&](const std::string& name, std::uint64_t ObjectErrorCounts::*count)
  {
    addSeries(chart, report, name,
              [&](const BenchmarkRow& row) { return static_cast<double>(row.evaluation.objects.*count); });
  };
  add("split", &ObjectErrorCounts::split);
  add("merged", &ObjectErrorCounts::merged);
  add("missed", &ObjectErrorCounts::missed);
  return chart;
}

inline BarChart timeChart(const BenchmarkReport& report)
{
  BarChart chart = rowChart(report, "Time a scan", "time [ms]");
  const auto add = [&](const std::string& name, double FrameTime::*member, double TimeSummary::*figure)
  { addSeries(chart, report, name, [&](const BenchmarkRow& row) { return summarize(row.times, member).*figure; }); };
  add("clustering, median", &FrameTime::cluster_ms, &TimeSummary::median_ms);
  add("clustering, 95th percentile", &FrameTime::cluster_ms, &TimeSummary::p95_ms);
  add("pipeline, median", &FrameTime::pipeline_ms, &TimeSummary::median_ms);
  add("pipeline, 95th percentile", &FrameTime::pipeline_ms, &TimeSummary::p95_ms);
  return chart;
}

/// The classes that occur, things first, and all.
inline BarChart classChart(const BenchmarkReport& report)
{
  BarChart chart;
  chart.frame.title = "PQ by class";
  chart.frame.subtitle = chartSubtitle(report);
  chart.y = {"PQ [%]", false, 0.0, 100.0};
  chart.decimals = -1;
  std::vector<std::size_t> shown;
  const PanopticQuality& before = report.before.quality;
  for (const ClassKind kind : {ClassKind::kThing, ClassKind::kStuff})
    for (std::size_t c = 0; c < before.classes().size(); ++c)
    {
      const ClassInfo& info = before.table()[static_cast<ClassIndex>(c)];
      if (info.kind != kind || !before.classes()[c].occurs()) continue;
      shown.push_back(c);
      chart.categories.push_back(info.name);
    }
  for (const BenchmarkRow& row : report.rows)
  {
    BarChart::Series series;
    series.name = row.name;
    for (const std::size_t c : shown) series.values.push_back(100.0 * row.evaluation.quality.classes()[c].pq());
    chart.series.push_back(std::move(series));
  }
  return chart;
}

inline LineChart timeByPointsChart(const BenchmarkReport& report)
{
  LineChart chart;
  chart.frame.title = "Clustering time against thing points";
  chart.frame.subtitle = chartSubtitle(report);
  chart.x.title = "thing points of the range image";
  chart.x.min = 0.0;
  chart.y.title = "clustering time [ms]";
  chart.y.logarithmic = true;
  for (const BenchmarkRow& row : report.rows)
  {
    LineChart::Series series;
    series.name = row.name;
    series.line = false;
    for (const FrameTime& time : row.times)
      if (time.cluster_ms > 0.0) series.points.push_back({static_cast<double>(time.thing_points), time.cluster_ms});
    chart.series.push_back(std::move(series));
  }
  return chart;
}
}  // namespace detail

/// Writes the benchmark's charts into a folder: quality.png, objects.png, pq_by_class.png where there was ground truth,
/// time.png and time_by_points.png. Throws std::runtime_error naming the file that cannot be written.
inline void drawBenchmarkCharts(const BenchmarkReport& report, const std::filesystem::path& folder)
{
  if (report.before.quality.scanCount() > 0)
  {
    drawChart(detail::qualityChart(report), folder / "quality.png");
    drawChart(detail::objectChart(report), folder / "objects.png");
    drawChart(detail::classChart(report), folder / "pq_by_class.png");
  }
  drawChart(detail::timeChart(report), folder / "time.png");
  drawChart(detail::timeByPointsChart(report), folder / "time_by_points.png");
}
}  // namespace lidar_panoptic_clustering

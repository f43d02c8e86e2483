#include "reporting/frame_report.h"

#include "reporting/format_text.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace lidar_panoptic_clustering
{
namespace
{
double stageMilliseconds(const FrameFigures& figures, const std::string& stage)
{
  for (const auto& [name, milliseconds] : figures.stages)
    if (name == stage) return milliseconds;
  return 0.0;
}

std::string counts(double points, double things, double instances)
{
  return formatText(" %8.0f %8.0f %10.0f", points, things, instances);
}

template <class Value>
std::vector<double> valuesOf(const std::vector<FrameFigures>& frames, const Value& value)
{
  std::vector<double> values;
  values.reserve(frames.size());
  for (const auto& figures : frames) values.push_back(static_cast<double>(value(figures)));
  return values;
}

double meanOf(const std::vector<double>& values)
{
  double sum = 0.0;
  for (const double value : values) sum += value;
  return values.empty() ? 0.0 : sum / static_cast<double>(values.size());
}
}  // namespace

double FrameFigures::totalMilliseconds() const
{
  double sum = 0.0;
  for (const auto& stage : stages) sum += stage.second;
  return sum;
}

double quantileOf(std::vector<double> values, double quantile)
{
  if (values.empty()) return 0.0;
  // the small term takes back what rounding adds: 0.95 * 20 is 19, not a little more
  const auto rank = static_cast<std::size_t>(std::ceil(quantile * static_cast<double>(values.size()) - 1e-9));
  const auto nth = values.begin() + static_cast<std::ptrdiff_t>(std::clamp<std::size_t>(rank, 1, values.size()) - 1);
  std::nth_element(values.begin(), nth, values.end());
  return *nth;
}

FrameReport::FrameReport(const std::vector<std::string>& algorithms, std::size_t frames) : limit_(frames)
{
  for (const auto& algorithm : algorithms) series_.push_back({algorithm, {}});
}

std::string FrameReport::add(const std::string& algorithm, FrameFigures figures)
{
  const auto series =
      std::find_if(series_.begin(), series_.end(), [&algorithm](const Series& s) { return s.algorithm == algorithm; });
  if (series == series_.end()) throw std::invalid_argument("frame of an unexpected algorithm '" + algorithm + "'");
  if (limit_ > 0 && series->frames.size() >= limit_) return "";

  std::string line;
  if (stages_.empty())
  {
    for (const auto& stage : figures.stages) stages_.push_back(stage.first);
    line = head(formatText("%6s %-13s", "frame", "algorithm")) + "   [ms a stage]\n";
  }
  line += formatText("%6zu %-13s", series->frames.size() + 1, algorithm.c_str());
  line += counts(static_cast<double>(figures.points), static_cast<double>(figures.things),
                 static_cast<double>(figures.instances));
  for (const auto& stage : stages_) line += formatText(" %8.2f", stageMilliseconds(figures, stage));
  line += formatText(" %8.2f\n", figures.totalMilliseconds());
  series->frames.push_back(std::move(figures));
  return line;
}

bool FrameReport::complete() const
{
  return limit_ > 0 &&
         std::all_of(series_.begin(), series_.end(), [this](const Series& s) { return s.frames.size() >= limit_; });
}

std::size_t FrameReport::dropped(const Series& series) const
{
  if (series.frames.empty()) return 0;
  const auto first = std::lower_bound(sent_.begin(), sent_.end(), series.frames.front().stamp_us);
  const auto last = std::upper_bound(first, sent_.end(), series.frames.back().stamp_us);
  const auto sent = static_cast<std::size_t>(last - first);
  return sent - std::min(sent, series.frames.size());
}

std::string FrameReport::head(const std::string& leading) const
{
  std::string line = leading + formatText(" %8s %8s %10s", "points", "things", "instances");
  for (const auto& stage : stages_) line += formatText(" %8s", stage.c_str());
  return line + formatText(" %8s", "total");
}

std::string FrameReport::summary() const
{
  std::string text = "\nSummary: means of points, things and instances; medians of the milliseconds a stage\n";
  text +=
      head(formatText("%-13s %6s %7s", "algorithm", "frames", "dropped")) + formatText(" %8s %8s\n", "95 %", "longest");
  std::size_t fewest = series_.empty() ? 0 : series_.front().frames.size();
  for (const auto& series : series_)
  {
    text += summaryOf(series);
    fewest = std::min(fewest, series.frames.size());
  }
  if (limit_ == 0) return text + "done: ended from outside, as no number of frames was set\n";
  return text + formatText(complete() ? "done: %zu of %zu frames of each algorithm\n"
                                      : "ended early: %zu of %zu frames of the slowest algorithm\n",
                           fewest, limit_);
}

std::string FrameReport::summaryOf(const Series& series) const
{
  const auto& frames = series.frames;
  std::string line = formatText("%-13s %6zu %7zu", series.algorithm.c_str(), frames.size(), dropped(series));
  line += counts(meanOf(valuesOf(frames, [](const auto& f) { return f.points; })),
                 meanOf(valuesOf(frames, [](const auto& f) { return f.things; })),
                 meanOf(valuesOf(frames, [](const auto& f) { return f.instances; })));
  for (const auto& stage : stages_)
    line += formatText(
        " %8.2f", quantileOf(valuesOf(frames, [&stage](const auto& f) { return stageMilliseconds(f, stage); }), 0.5));
  const auto totals = valuesOf(frames, [](const auto& f) { return f.totalMilliseconds(); });
  return line +
         formatText(" %8.2f %8.2f %8.2f\n", quantileOf(totals, 0.5), quantileOf(totals, 0.95), quantileOf(totals, 1.0));
}
}  // namespace lidar_panoptic_clustering

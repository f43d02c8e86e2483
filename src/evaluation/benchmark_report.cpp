#include "lidar_panoptic_clustering/evaluation/benchmark_report.h"

#include "evaluation/json_text.h"

#include <algorithm>
#include <limits>
#include <nlohmann/json.hpp>
#include <set>
#include <stdexcept>
#include <utility>

namespace lidar_panoptic_clustering
{
namespace
{
using nlohmann::json;

json toJson(const TimeSummary& summary)
{
  return {{"median", summary.median_ms}, {"p95", summary.p95_ms}, {"max", summary.max_ms}};
}

std::vector<FrameTime> sortedByScan(std::vector<FrameTime> times)
{
  std::sort(times.begin(), times.end(), [](const FrameTime& a, const FrameTime& b) { return a.scan < b.scan; });
  return times;
}

json timesToJson(const std::vector<FrameTime>& times)
{
  json frames = json::array();
  for (const FrameTime& time : sortedByScan(times))
    frames.push_back({{"scan", time.scan},
                      {"points", time.points},
                      {"thing_points", time.thing_points},
                      {"cluster_ms", time.cluster_ms},
                      {"pipeline_ms", time.pipeline_ms}});
  return {{"cluster_ms", toJson(summarize(times, &FrameTime::cluster_ms))},
          {"pipeline_ms", toJson(summarize(times, &FrameTime::pipeline_ms))},
          {"frames", std::move(frames)}};
}

double milliseconds(const json& frame, const char* key)
{
  constexpr double kMost = 1e9;
  const json& value = jsonMember(frame, key);
  if (!value.is_number() || !(value.get<double>() >= 0.0 && value.get<double>() <= kMost))
    throw std::invalid_argument(std::string("key '") + key + "' is " + briefly(value) +
                                ", expected milliseconds from 0 to 1e9");
  return value.get<double>();
}

std::vector<FrameTime> timesFromJson(const json& object)
{
  constexpr std::uint64_t kMost = std::numeric_limits<std::uint32_t>::max();
  std::vector<FrameTime> times;
  for (const json& frame : jsonList(object, "frames"))
    times.push_back({jsonText(frame, "scan"), static_cast<std::uint32_t>(jsonNumber(frame, "points", kMost)),
                     static_cast<std::uint32_t>(jsonNumber(frame, "thing_points", kMost)),
                     milliseconds(frame, "cluster_ms"), milliseconds(frame, "pipeline_ms")});
  return times;
}

std::map<std::string, std::uint64_t> scansFromJson(const json& object)
{
  std::map<std::string, std::uint64_t> scans;
  if (!object.is_object()) throw std::invalid_argument("key 'scans' is " + briefly(object) + ", expected a map");
  for (const auto& [sequence, count] : object.items())
    scans[sequence] = jsonNumber(object, sequence.c_str(), kMostCount);
  return scans;
}

/// What `read` returns; names the source in what it throws.
template <class Read>
auto named(const std::string& source, const Read& read)
{
  try
  {
    return read();
  }
  catch (const std::invalid_argument& error)
  {
    throw std::invalid_argument(source + ": " + error.what());
  }
}

json evaluationToJson(const EvaluationReport& evaluation)
{
  return json::parse(evaluation.toJsonText());
}

std::set<std::string> scanNames(const BenchmarkReport& report)
{
  std::set<std::string> names;
  for (const FrameTime& time : report.rows.empty() ? std::vector<FrameTime>{} : report.rows.front().times)
    names.insert(time.scan);
  return names;
}

void requireParts(const BenchmarkReport& a, const BenchmarkReport& b)
{
  if (a.semantics != b.semantics)
    throw std::invalid_argument("cannot merge benchmarks with semantics '" + a.semantics + "' and '" + b.semantics +
                                "'");
  const auto same = [](const BenchmarkRow& x, const BenchmarkRow& y) { return x.name == y.name; };
  if (!std::equal(a.rows.begin(), a.rows.end(), b.rows.begin(), b.rows.end(), same))
  {
    const auto list = [](const BenchmarkReport& report)
    {
      std::string names;
      for (const BenchmarkRow& row : report.rows) names += (names.empty() ? "" : ", ") + row.name;
      return names;
    };
    throw std::invalid_argument("cannot merge benchmarks of " + list(a) + " and of " + list(b));
  }
  const std::set<std::string> known = scanNames(a);
  for (const std::string& scan : scanNames(b))
    if (known.count(scan) != 0) throw std::invalid_argument("cannot merge benchmarks that both hold scan " + scan);
}
}  // namespace

BenchmarkReport::BenchmarkReport(std::string semantics_, const std::vector<std::string>& names,
                                 const std::shared_ptr<const ClassTable>& table)
    : semantics(std::move(semantics_)), before(table)
{
  for (const std::string& name : names) rows.push_back({name, EvaluationReport(table), {}});
}

BenchmarkReport& BenchmarkReport::operator+=(const BenchmarkReport& other)
{
  requireParts(*this, other);
  before += other.before;
  for (const auto& [sequence, count] : other.scans) scans[sequence] += count;
  interrupted = interrupted || other.interrupted;
  for (std::size_t i = 0; i < rows.size(); ++i)
  {
    rows[i].evaluation += other.rows[i].evaluation;
    rows[i].times.insert(rows[i].times.end(), other.rows[i].times.begin(), other.rows[i].times.end());
  }
  return *this;
}

std::string BenchmarkReport::toJsonText() const
{
  json quality = {{"semantics", semantics}, {"scans", scans}, {"before_clustering", evaluationToJson(before)}};
  json times = json::object(), names = json::array();
  for (const BenchmarkRow& row : rows)
  {
    names.push_back(row.name);
    quality["rows"][row.name] = evaluationToJson(row.evaluation);
    times[row.name] = timesToJson(row.times);
  }
  const json result = {{"rows", std::move(names)},
                       {"interrupted", interrupted},
                       {"quality", std::move(quality)},
                       {"times", std::move(times)}};
  // folder names may hold any bytes, JSON only UTF-8
  return result.dump(1, ' ', false, json::error_handler_t::replace) + "\n";
}

BenchmarkReport BenchmarkReport::fromJsonText(const std::string& text, const std::string& source,
                                              const std::shared_ptr<const ClassTable>& table)
{
  const json parsed = parseJson(text, source, "a benchmark report");
  try
  {
    const json& quality = parsed.at("quality");
    BenchmarkReport report(quality.at("semantics").get<std::string>(),
                           parsed.at("rows").get<std::vector<std::string>>(), table);
    report.scans = named(source, [&] { return scansFromJson(quality.at("scans")); });
    report.interrupted = parsed.at("interrupted").get<bool>();
    report.before = EvaluationReport::fromJsonText(quality.at("before_clustering").dump(), source, table);
    for (BenchmarkRow& row : report.rows)
    {
      const std::string evaluation = quality.at("rows").at(row.name).dump();
      row.evaluation = EvaluationReport::fromJsonText(evaluation, source + ", row '" + row.name + "'", table);
      row.times = named(source, [&] { return timesFromJson(parsed.at("times").at(row.name)); });
    }
    return report;
  }
  catch (const json::exception& error)
  {
    throw std::invalid_argument(source + ": no benchmark report: " + error.what());
  }
}

std::string BenchmarkReport::classTableOf(const std::string& text, const std::string& source)
{
  const json parsed = parseJson(text, source, "a benchmark report");
  try
  {
    return parsed.at("quality").at("before_clustering").at("class_table").get<std::string>();
  }
  catch (const json::exception& error)
  {
    throw std::invalid_argument(source + ": no benchmark report: " + error.what());
  }
}
}  // namespace lidar_panoptic_clustering

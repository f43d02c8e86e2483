#include "lidar_panoptic_clustering/evaluation/evaluation_report.h"

#include "evaluation/json_text.h"

#include <algorithm>
#include <cstdint>
#include <limits>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <tuple>
#include <utility>

namespace lidar_panoptic_clustering
{
namespace
{
using nlohmann::json;

const char* kindName(const ClassInfo& info)
{
  return info.isThing() ? "thing" : "stuff";
}

json toJson(const ClassCounts& counts, const ClassInfo& info)
{
  return {
      {"kind", kindName(info)},
      {"pq", counts.pq()},
      {"sq", counts.sq()},
      {"rq", counts.rq()},
      {"iou", counts.iou()},
      {"tp", counts.tp},
      {"fp", counts.fp},
      {"fn", counts.fn},
      {"iou_sum", {{"whole", counts.iou_sum.whole}, {"fraction_2_53", counts.iou_sum.fraction}}},
      {"points", {{"both", counts.points_both}, {"predicted", counts.points_predicted}, {"true", counts.points_true}}}};
}

ClassCounts classCountsFromJson(const json& object, const ClassInfo& info)
{
  if (jsonText(object, "kind") != kindName(info))
    throw std::invalid_argument("kind is '" + jsonText(object, "kind") + "', the class table says '" + kindName(info) +
                                "'");
  const json& sum = jsonMember(object, "iou_sum");
  const json& points = jsonMember(object, "points");
  ClassCounts counts;
  counts.tp = jsonNumber(object, "tp"), counts.fp = jsonNumber(object, "fp"), counts.fn = jsonNumber(object, "fn");
  counts.iou_sum = {jsonNumber(sum, "whole"), jsonNumber(sum, "fraction_2_53")};
  if (counts.iou_sum.fraction >> ExactSum::kFractionBits != 0)
    throw std::invalid_argument("key 'fraction_2_53' is " + std::to_string(counts.iou_sum.fraction) +
                                ", expected less than 2^53");
  counts.points_both = jsonNumber(points, "both");
  counts.points_predicted = jsonNumber(points, "predicted");
  counts.points_true = jsonNumber(points, "true");
  return counts;
}

json parseReport(const std::string& report, const std::string& source)
{
  return parseJson(report, source, "an evaluation report");
}
}  // namespace

json toJson(const PanopticQuality& quality)
{
  const PanopticFigures f = quality.figures();
  json result = {{"class_table", quality.table().name()},
                 {"min_points", quality.minPoints()},
                 {"scans", quality.scanCount()},
                 {"pq", f.pq},
                 {"pq_dagger", f.pq_dagger},
                 {"rq", f.rq},
                 {"sq", f.sq},
                 {"pq_th", f.pq_th},
                 {"rq_th", f.rq_th},
                 {"sq_th", f.sq_th},
                 {"pq_st", f.pq_st},
                 {"rq_st", f.rq_st},
                 {"sq_st", f.sq_st},
                 {"miou", f.miou},
                 {"pq_th_present", f.pq_th_present}};
  for (std::size_t c = 0; c < quality.classes().size(); ++c)
  {
    const auto index = static_cast<ClassIndex>(c);
    if (!quality.isEvaluated(index)) continue;
    const ClassInfo& info = quality.table()[index];
    result["per_class"][info.name] = toJson(quality.classes()[c], info);
  }
  return result;
}

PanopticQuality panopticQualityFromJson(const json& object, std::shared_ptr<const ClassTable> table)
{
  const std::uint64_t min_points = jsonNumber(object, "min_points", std::numeric_limits<int>::max());
  PanopticQuality quality(std::move(table), static_cast<int>(min_points));

  const json& per_class = jsonMember(object, "per_class");
  std::vector<ClassCounts> counts(quality.classes().size());
  std::size_t evaluated = 0;
  for (std::size_t c = 0; c < counts.size(); ++c)
  {
    const auto index = static_cast<ClassIndex>(c);
    if (!quality.isEvaluated(index)) continue;
    const ClassInfo& info = quality.table()[index];
    try
    {
      counts[c] = classCountsFromJson(jsonMember(per_class, info.name.c_str()), info);
    }
    catch (const std::invalid_argument& error)
    {
      throw std::invalid_argument("class '" + info.name + "': " + error.what());
    }
    ++evaluated;
  }
  if (per_class.size() != evaluated)
    throw std::invalid_argument("key 'per_class' has " + std::to_string(per_class.size()) + " classes, class table '" +
                                quality.table().name() + "' evaluates " + std::to_string(evaluated));
  quality.restore(std::move(counts), jsonNumber(object, "scans"));
  return quality;
}

json toJson(const ObjectErrorCounts& counts)
{
  return {{"total", counts.total()},
          {"matched", counts.matched},
          {"split", counts.split},
          {"merged", counts.merged},
          {"missed", counts.missed}};
}

ObjectErrorCounts objectErrorCountsFromJson(const json& object)
{
  ObjectErrorCounts counts;
  counts.matched = jsonNumber(object, "matched"), counts.split = jsonNumber(object, "split");
  counts.merged = jsonNumber(object, "merged"), counts.missed = jsonNumber(object, "missed");
  return counts;
}

EvaluationReport& EvaluationReport::operator+=(const EvaluationReport& other)
{
  quality += other.quality;
  objects += other.objects;
  skipped.insert(skipped.end(), other.skipped.begin(), other.skipped.end());
  return *this;
}

std::string EvaluationReport::toJsonText() const
{
  json result = toJson(quality);
  result["true_objects"] = toJson(objects);
  result["skipped"] = json::array();
  std::vector<SkippedScan> sorted = skipped;
  std::sort(sorted.begin(), sorted.end(),
            [](const SkippedScan& a, const SkippedScan& b)
            { return std::tie(a.scan, a.reason) < std::tie(b.scan, b.reason); });
  for (const SkippedScan& scan : sorted) result["skipped"].push_back({{"scan", scan.scan}, {"reason", scan.reason}});
  result["scans_skipped"] = skipped.size();
  // file names may hold any bytes, JSON only UTF-8
  return result.dump(1, ' ', false, json::error_handler_t::replace) + "\n";
}

EvaluationReport EvaluationReport::fromJsonText(const std::string& report, const std::string& source,
                                                std::shared_ptr<const ClassTable> table)
{
  const json parsed = parseReport(report, source);
  try
  {
    EvaluationReport result(table);
    result.quality = panopticQualityFromJson(parsed, std::move(table));
    result.objects = objectErrorCountsFromJson(jsonMember(parsed, "true_objects"));
    for (const json& scan : jsonList(parsed, "skipped"))
      result.skipped.push_back({jsonText(scan, "scan"), jsonText(scan, "reason")});
    return result;
  }
  catch (const std::invalid_argument& error)
  {
    throw std::invalid_argument(source + ": " + error.what());
  }
}

std::string EvaluationReport::classTableOf(const std::string& report, const std::string& source)
{
  const json parsed = parseReport(report, source);
  try
  {
    return jsonText(parsed, "class_table");
  }
  catch (const std::invalid_argument& error)
  {
    throw std::invalid_argument(source + ": " + error.what());
  }
}
}  // namespace lidar_panoptic_clustering

#include "lidar_panoptic_clustering/evaluation/evaluation_report.h"

#include "evaluation/json_text.h"

#include <cstdint>
#include <limits>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <string>
#include <utility>

namespace lidar_panoptic_clustering
{
namespace
{
using nlohmann::json;
using Sequence = TemporalQuality::Sequence;

std::uint64_t number(const json& value, const std::string& what, std::uint64_t max)
{
  if (!value.is_number_unsigned() || value.get<std::uint64_t>() > max)
    throw std::invalid_argument("key '" + what + "' holds " + briefly(value) + ", expected a whole number");
  return value.get<std::uint64_t>();
}

std::uint32_t id(const json& value, const std::string& what)
{
  return static_cast<std::uint32_t>(number(value, what, std::numeric_limits<std::uint32_t>::max()));
}

std::uint64_t points(const json& value, const std::string& what)
{
  return number(value, what, std::uint64_t{1} << 52U);  // sums of two stay exact in double
}

/// A tube's row of `size` numbers.
const json& row(const json& value, const char* what, std::size_t size)
{
  if (!value.is_array() || value.size() != size)
    throw std::invalid_argument(std::string("key '") + what + "' holds " + briefly(value) + ", expected rows of " +
                                std::to_string(size) + " numbers");
  return value;
}

json sequenceToJson(const Sequence& tubes, const ClassTable& table)
{
  json object = {{"predicted", json::array()}, {"truth", json::object()}, {"shared", json::object()}};
  for (const auto& [instance, count] : tubes.predicted) object["predicted"].push_back({instance, count});
  for (const auto& [tube, count] : tubes.truth) object["truth"][table[tube.first].name].push_back({tube.second, count});
  for (const auto& [pair, count] : tubes.shared)
    object["shared"][table[pair.first.first].name].push_back({pair.first.second, pair.second, count});
  return object;
}

ClassIndex thingNamed(const std::string& name, const ClassTable& table)
{
  const ClassIndex index = table.findByName(name);
  if (index == kUnknownClass || !table[index].isThing())
    throw std::invalid_argument("class '" + name + "' of a tube is no thing of class table '" + table.name() + "'");
  return index;
}

Sequence sequenceFromJson(const json& object, const ClassTable& table)
{
  Sequence tubes;
  for (const json& value : jsonList(object, "predicted"))
  {
    const json& cells = row(value, "predicted", 2);
    tubes.predicted[id(cells[0], "predicted")] = points(cells[1], "predicted");
  }
  for (const auto& [name, rows] : jsonMember(object, "truth").items())
    for (const json& value : rows)
    {
      const json& cells = row(value, "truth", 2);
      tubes.truth[{thingNamed(name, table), id(cells[0], "truth")}] = points(cells[1], "truth");
    }
  for (const auto& [name, rows] : jsonMember(object, "shared").items())
    for (const json& value : rows)
    {
      const json& cells = row(value, "shared", 3);
      const TemporalQuality::TrueTube tube{thingNamed(name, table), id(cells[0], "shared")};
      tubes.shared[{tube, id(cells[1], "shared")}] = points(cells[2], "shared");
    }
  return tubes;
}

/// What counts as a class: the evaluated ones, and all that are ignored together.
bool isCounted(ClassIndex index, const ClassTable& table)
{
  return index == kUnknownClass || table[index].kind != ClassKind::kIgnored;
}

std::string nameOf(ClassIndex index, const ClassTable& table)
{
  return index == kUnknownClass ? std::string() : table[index].name;
}
}  // namespace

json toJson(const TemporalQuality& quality)
{
  const ClassTable& table = quality.table();
  const TemporalFigures figures = quality.figures();
  const TemporalQuality::Counts counts = quality.counts();
  json result = {{"lstq", figures.lstq},
                 {"s_assoc", figures.s_assoc},
                 {"s_cls", figures.s_cls},
                 {"min_points", quality.minPoints()},
                 {"scans", counts.scans},
                 {"assoc_per_class", json::object()},
                 {"tubes_per_class", json::object()},
                 {"class_points", json::object()},
                 {"sequences", json::object()}};
  for (std::size_t c = 0; c < table.size(); ++c)
  {
    const auto index = static_cast<ClassIndex>(c);
    if (table[index].isThing())
    {
      result["assoc_per_class"][table[index].name] = figures.association[c];
      result["tubes_per_class"][table[index].name] = figures.tubes[c];
    }
    const TemporalQuality::ClassPoints& p = counts.classes[c];
    if (isCounted(index, table)) result["class_points"][nameOf(index, table)] = {p.both, p.predicted, p.truth};
  }
  for (const auto& [name, tubes] : counts.sequences) result["sequences"][name] = sequenceToJson(tubes, table);
  return result;
}

TemporalQuality temporalQualityFromJson(const json& object, std::shared_ptr<const ClassTable> table)
{
  const auto min_points = number(jsonMember(object, "min_points"), "min_points", std::numeric_limits<int>::max());
  TemporalQuality::Counts counts;
  counts.scans = number(jsonMember(object, "scans"), "scans", std::numeric_limits<std::uint64_t>::max());
  counts.classes.resize(table->size());
  for (std::size_t c = 0; c < table->size(); ++c)
  {
    const auto index = static_cast<ClassIndex>(c);
    if (!isCounted(index, *table)) continue;
    const json& cells =
        row(jsonMember(jsonMember(object, "class_points"), nameOf(index, *table).c_str()), "class_points", 3);
    counts.classes[c] = {points(cells[0], "class_points"), points(cells[1], "class_points"),
                         points(cells[2], "class_points")};
  }
  for (const auto& [name, tubes] : jsonMember(object, "sequences").items())
    counts.sequences[name] = sequenceFromJson(tubes, *table);
  TemporalQuality quality(std::move(table), static_cast<int>(min_points));
  quality.restore(std::move(counts));
  return quality;
}
}  // namespace lidar_panoptic_clustering

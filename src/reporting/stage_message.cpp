#include "reporting/stage_message.h"

#include "core/plain_numbers.h"
#include "core/printable.h"

#include <stdexcept>

namespace lidar_panoptic_clustering
{
namespace
{
const std::string kUnit = "_ms";

bool endsWithUnit(const std::string& key)
{
  return key.size() > kUnit.size() && key.compare(key.size() - kUnit.size(), kUnit.size(), kUnit) == 0;
}
double numberIn(const diagnostic_msgs::KeyValue& pair)
{
  if (const auto number = parseNumber(pair.value)) return *number;
  throw std::invalid_argument(printable("stages: '" + pair.key + "': expected a number, found '" + pair.value + "'"));
}

std::size_t countIn(const diagnostic_msgs::KeyValue& pair)
{
  constexpr double kMostPoints = 1e9;
  const double number = numberIn(pair);
  if (number >= 0.0 && number <= kMostPoints) return static_cast<std::size_t>(number);
  throw std::invalid_argument(printable("stages: '" + pair.key + "': expected 0 to 1e9, found '" + pair.value + "'"));
}
}  // namespace

diagnostic_msgs::DiagnosticStatus stageMessage(const std::string& nodelet, const std::string& algorithm,
                                               std::size_t things, std::size_t instances,
                                               const StreamDiagnostics::StageMilliseconds& stages)
{
  const PlainNumbers plain;
  diagnostic_msgs::DiagnosticStatus status;
  status.name = nodelet;
  status.hardware_id = algorithm;
  const auto add = [&status](const std::string& key, const auto& value)
  {
    status.values.emplace_back();
    status.values.back().key = key;
    status.values.back().value = std::to_string(value);  // milliseconds with six decimals
  };
  add("things", things);
  add("instances", instances);
  for (const auto& [stage, milliseconds] : stages) add(stage + kUnit, milliseconds);
  return status;
}

FrameFigures readStageMessage(const diagnostic_msgs::DiagnosticStatus& status)
{
  FrameFigures figures;
  for (const auto& pair : status.values)
  {
    if (pair.key == "things") figures.things = countIn(pair);
    if (pair.key == "instances") figures.instances = countIn(pair);
    if (endsWithUnit(pair.key))
      figures.stages.emplace_back(pair.key.substr(0, pair.key.size() - kUnit.size()), numberIn(pair));
  }
  return figures;
}
}  // namespace lidar_panoptic_clustering

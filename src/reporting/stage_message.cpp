#include "reporting/stage_message.h"

#include "core/plain_numbers.h"

#include <optional>

namespace lidar_panoptic_clustering
{
namespace
{
const std::string kUnit = "_ms";

bool endsWithUnit(const std::string& key)
{
  return key.size() > kUnit.size() && key.compare(key.size() - kUnit.size(), kUnit.size(), kUnit) == 0;
}
/// A value of 0 or more; nothing for text that is none: a message may come from anywhere, and an exception in its
/// callback would end the whole manager.
std::optional<double> numberIn(const diagnostic_msgs::KeyValue& pair)
{
  constexpr double kMost = 1e9;
  const auto number = parseNumber(pair.value);
  return number && *number >= 0.0 && *number <= kMost ? number : std::nullopt;
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
    const auto number = numberIn(pair);
    if (!number) continue;
    if (pair.key == "things") figures.things = static_cast<std::size_t>(*number);
    if (pair.key == "instances") figures.instances = static_cast<std::size_t>(*number);
    if (endsWithUnit(pair.key))
      figures.stages.emplace_back(pair.key.substr(0, pair.key.size() - kUnit.size()), *number);
  }
  return figures;
}
}  // namespace lidar_panoptic_clustering

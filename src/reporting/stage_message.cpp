#include "reporting/stage_message.h"

namespace lidar_panoptic_clustering
{
namespace
{
const std::string kUnit = "_ms";

bool endsWithUnit(const std::string& key)
{
  return key.size() > kUnit.size() && key.compare(key.size() - kUnit.size(), kUnit.size(), kUnit) == 0;
}
}  // namespace

diagnostic_msgs::DiagnosticStatus stageMessage(const std::string& nodelet, const std::string& algorithm,
                                               std::size_t things, std::size_t instances,
                                               const StreamDiagnostics::StageMilliseconds& stages)
{
  diagnostic_msgs::DiagnosticStatus status;
  status.name = nodelet;
  status.hardware_id = algorithm;
  const auto add = [&status](const std::string& key, const auto& value)
  {
    status.values.emplace_back();
    status.values.back().key = key;
    status.values.back().value = std::to_string(value);
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
    if (pair.key == "things") figures.things = std::stoul(pair.value);
    if (pair.key == "instances") figures.instances = std::stoul(pair.value);
    if (endsWithUnit(pair.key))
      figures.stages.emplace_back(pair.key.substr(0, pair.key.size() - kUnit.size()), std::stod(pair.value));
  }
  return figures;
}
}  // namespace lidar_panoptic_clustering

#pragma once

#include "reporting/frame_report.h"
#include "ros/stream_diagnostics.h"

#include <diagnostic_msgs/DiagnosticStatus.h>

#include <cstddef>
#include <string>

namespace lidar_panoptic_clustering
{
/// What ClusterNodelet says on ~stages of its work on a scan; `hardware_id` is the algorithm.
diagnostic_msgs::DiagnosticStatus stageMessage(const std::string& nodelet, const std::string& algorithm,
                                               std::size_t things, std::size_t instances,
                                               const StreamDiagnostics::StageMilliseconds& stages);

/// Reads it again; the stamp and the points are not in it. Values that are no numbers from 0 to 1e9 are left out.
FrameFigures readStageMessage(const diagnostic_msgs::DiagnosticStatus& status);
}  // namespace lidar_panoptic_clustering

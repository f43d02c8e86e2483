#pragma once

#include <string>

namespace lidar_panoptic_clustering
{
/// Says on /diagnostics why a nodelet was not loaded: a status of level ERROR, once a second for ten seconds, so that
/// it reaches those who listen elsewhere (the nodelet is gone by then, and its log stands where its manager runs).
/// `nodelet` is its full name.
void announceLoadFailure(const std::string& nodelet, const std::string& error);
}  // namespace lidar_panoptic_clustering

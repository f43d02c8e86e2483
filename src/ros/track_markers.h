#pragma once

#include "lidar_panoptic_clustering/tracking/cloud_tracker.h"
#include "ros/marker_list.h"

#include <lidar_panoptic_clustering/ObjectArray.h>

#include <array>
#include <cstdint>
#include <vector>

namespace lidar_panoptic_clustering
{
/// The tracked objects of each scan of a stream as markers, for RViz; the marker id is the track's.
///
/// An object that is seen in the scan is a box (namespace "boxes", in the track's colour), a text "CLASS #ID SPEED m/s"
/// ("texts"; the speed where it moves), an arrow to where it will be in a second ("velocities") and its way of the last
/// seconds, which fades ("trails"). All are in the cloud's frame.
class TrackMarkers
{
public:
  /// `list` and `tracks` are the same objects in the same order; `fixed_from_sensor`: where the sensor was.
  visualization_msgs::MarkerArrayPtr update(const ObjectArray& list, const std::vector<ListedTrack>& tracks,
                                            const Eigen::Isometry3d& fixed_from_sensor, ros::Time now);

  /// Forgets all ways (a jump in time, another fixed frame).
  void reset() { trails_.clear(); }

private:
  static constexpr std::size_t kKept = 40;  // points of a way

  /// In the fixed frame [m].
  struct Place
  {
    double x, y, z;
  };
  struct Trail
  {
    std::uint32_t track;
    std::uint32_t count = 0;         ///< that it had
    std::array<Place, kKept> way{};  ///< the last at (count - 1) % kKept
  };

  Trail& trailOf(std::uint32_t track);
  void extend(Trail& trail, const ListedTrack& listed, const Eigen::Isometry3d& fixed_from_sensor);
  static visualization_msgs::Marker trailMarker(const Trail& trail, std::uint32_t rgb,
                                                const Eigen::Isometry3d& sensor_from_fixed);
  void forgetAllBut(const std::vector<ListedTrack>& tracks);

  MarkerList markers_;
  std::vector<Trail> trails_;  ///< by track id
  std::vector<std::uint32_t> listed_;
};
}  // namespace lidar_panoptic_clustering

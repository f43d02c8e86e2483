#pragma once

#include "lidar_panoptic_clustering/core/instances.h"
#include "lidar_panoptic_clustering/core/point_types.h"
#include "lidar_panoptic_clustering/core/thing_scan.h"
#include "lidar_panoptic_clustering/geometry/voxel_index.h"
#include "lidar_panoptic_clustering/refinement/instance_boxes.h"
#include "lidar_panoptic_clustering/tracking/point_tracker.h"

#include <Eigen/Geometry>
#include <cstdint>
#include <memory>
#include <vector>

namespace lidar_panoptic_clustering
{
/// An object of a list, in the axes of the sensor frame.
struct ListedTrack
{
  TrackedObject object;             ///< as the tracker knows it, in the axes of the fixed frame
  std::uint32_t instance = 0;       ///< in the cloud, of its largest part; 0: not seen in this scan
  std::uint32_t point_count = 0;    ///< in this scan
  float class_share = 0.0F;         ///< of its points that came with its class; of an unseen one when it was seen last
  InstanceBox box;                  ///< about its points; of one that is not seen the last one, moved on
  double since_last_seen_s = 0.0;   ///< 0: in this scan
  double since_first_seen_s = 0.0;  ///< 0: in this scan
  Eigen::Vector3d velocity;         ///< over ground [m/s]
  Eigen::Matrix3d velocity_covariance, position_covariance;  ///< [m^2/s^2], [m^2]
};

/// Ids that last for painted clouds: PointTracker on their instances, and a list of the objects.
///
/// Keeps its memory between scans; linear in the points, but for the list, whose boxes take n log n in those of an
/// object. Not shared between threads.
class CloudTracker
{
public:
  /// Throws std::invalid_argument without a table, and on a value outside its range.
  explicit CloudTracker(std::shared_ptr<const ClassTable> table, const TrackerConfig& config = {});

  /// Forgets all tracks. Ids go on from the last one.
  void reset();

  /// Follows the instances of a scan; `fixed_from_sensor`: where the sensor is in the frame that objects are followed
  /// in. Throws std::invalid_argument when the cloud's size contradicts its points.
  void follow(const PanopticCloud& cloud, std::int64_t stamp_us, const Eigen::Isometry3d& fixed_from_sensor);
  /// The same and paint(), in one pass over the cloud. Throws as follow() does; then `out` holds nothing of use.
  void follow(const PanopticCloud& cloud, std::int64_t stamp_us, const Eigen::Isometry3d& fixed_from_sensor,
              PanopticCloud& out);

  /// Fills `out` with the points of `cloud`, the one followed last: with track ids for instances, their colours, and
  /// the class that was voted where a point has another. All else is the same bit for bit. Throws
  /// std::invalid_argument on a cloud of another size.
  void paint(const PanopticCloud& cloud, PanopticCloud& out) const;

  /// The objects of `cloud`, the one followed last, in order of their first points, and after them those that were seen
  /// in three scans and more before and may come again, by track id. Valid until the next call of follow(). A box whose
  /// object drives along its longer side points that way.
  const std::vector<ListedTrack>& list(const PanopticCloud& cloud);

  /// How many points of instances have a class that the table does not name, and how many there are; in the scan
  /// followed last.
  std::size_t unknownPoints() const { return unknown_points_; }
  std::size_t instancePoints() const { return points_.size(); }               ///< see unknownPoints()
  std::size_t liveTracks() const { return tracker_.tracker().liveTracks(); }  ///< tracks that may still be seen again
  /// Where the sensor was in the scan followed last.
  const Eigen::Isometry3d& pose() const { return pose_; }

private:
  /// What was seen of a track last, to be moved on while it is hidden.
  struct Memory
  {
    std::uint32_t track;
    TrackedObject object;
    float class_share;
    InstanceBox box;         ///< its size
    Eigen::Vector3d center;  ///< fixed frame
    Eigen::Vector3d axis;    ///< of its length, fixed frame
  };

  /// What was seen of a track in one instance.
  struct Part
  {
    std::uint32_t place;     ///< in the list
    std::uint32_t instance;  ///< in the cloud
  };

  /// What paint() writes for an observation.
  struct Paint
  {
    std::uint32_t track, rgb;
    ClassIndex class_index;
    bool has_label;  ///< the class has an id of its own
    std::uint32_t label;
  };

  void begin(const PanopticCloud& cloud, std::int64_t stamp_us, const Eigen::Isometry3d& fixed_from_sensor);
  void take(const PanopticPoint* points, std::uint32_t begin, std::uint32_t end);
  void finish();
  void paintThings(PanopticCloud& out) const;
  void requireSame(const PanopticCloud& cloud) const;
  void beginList();
  void gather(const PanopticCloud& cloud);
  void describe();
  void remember();
  void listHidden();
  void intoSensorAxes(ListedTrack& listed) const;

  std::shared_ptr<const ClassTable> table_;
  PointTracker tracker_;
  std::int64_t stamp_us_ = 0;
  Eigen::Isometry3d pose_ = Eigen::Isometry3d::Identity();
  std::size_t cloud_size_ = 0, unknown_points_ = 0;
  std::vector<std::uint32_t> points_;  ///< those of instances, by index in the cloud
  std::vector<Paint> paints_;          ///< by observation

  bool listed_ = false;
  std::vector<ListedTrack> list_;
  VoxelIndex place_of_track_;
  ThingScan things_;
  Instances instances_;
  std::vector<Part> parts_;                        ///< by observation
  std::vector<std::uint32_t> largest_, agreeing_;  ///< by place: points of the largest part, and of the class
  InstanceBoxes boxes_;
  std::vector<Memory> memory_, next_memory_;  ///< by track id
};
}  // namespace lidar_panoptic_clustering

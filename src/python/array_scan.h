#pragma once

#include "lidar_panoptic_clustering/core/parameters.h"
#include "lidar_panoptic_clustering/projection/organizer.h"
#include "lidar_panoptic_clustering/projection/point_projection.h"
#include "python/array_views.h"

#include <cstdint>
#include <optional>
#include <vector>

namespace lidar_panoptic_clustering
{
/// How the points of an array lie: what OrganizerConfig says of messages.
struct ArrayScanConfig
{
  OrganizerConfig organizer;  ///< of its fields only what arrays have; columns 0: kColumns where scans are unfolded
  int rows = 64;              ///< rings of the sensor, for arrays (N, channels) without a ring index

  static constexpr int kColumns = 2048;  ///< of a full turn, as panoptic_benchmark has it

  template <class Self, class Visitor>
  static void visit(Self& self, Visitor&& visitor)
  {
    visitor("layout", self.organizer.layout, layoutNames());
    visitor("orientation", self.organizer.orientation, orientationNames());
    visitor("sensor", self.organizer.sensor, std::vector<std::string>{});
    visitor("rows", self.rows, 1, 1024);
    visitor("columns", self.organizer.columns, 0, 16384);
  }
};

/// The points of an array as scan lines. With layout "auto":
/// - (N, channels) without a ring index is taken for points ring after ring as in KITTI's files, and projected as
///   panoptic_benchmark does it;
/// - (N, channels) with a ring index goes by that, as Organizer has it;
/// - (H, W, channels) stays as it is, rows being scan lines: what a cluster nodelet does with an organised cloud.
/// Any other layout is Organizer's, with its checks. What was seen before counts for nothing: the same array always
/// gives the same scan. Buffers are kept; not shared between threads.
class ArrayScan
{
public:
  /// Throws std::invalid_argument on a value outside its range, std::runtime_error on a sensor that cannot be read.
  explicit ArrayScan(const ArrayScanConfig& config);

  /// Points that lie as ScanPoint has them are not copied. `classes`: one a point, row-major, or empty for none;
  /// `ring`: one a point, or null. Throws std::invalid_argument, with what was expected and found, where the points do
  /// not lie as the layout says.
  void place(const PointsView& points, const std::vector<std::uint32_t>& classes, const IdsView* ring);

  /// The scan placed last. Where isImage(), only `image.cloud` and `layout` of it are filled; `points` may be empty.
  OrganizedScan& scan() { return scan_; }
  /// Its points, which may lie in the array: valid as long as that is.
  ScanPoints points() const { return points_; }
  /// Whether each point is the pixel of the same number.
  bool isImage() const { return is_image_; }

private:
  struct RawPoint
  {
    ScanPoint point;
    std::uint32_t label, ring;
  };
  void takeImage(const PointsView& points, const std::vector<std::uint32_t>& classes);
  void unfold(const std::vector<std::uint32_t>& classes);
  void organize(const PointsView& points, const std::vector<std::uint32_t>& classes, const IdsView* ring);

  ArrayScanConfig config_;
  std::optional<PointProjector> projector_;
  std::optional<Organizer> pristine_with_labels_, pristine_without_;  ///< never given a cloud
  OrganizedScan scan_;
  std::vector<ScanPoint> buffer_;
  ScanPoints points_{nullptr, 0};
  bool is_image_ = false;
  std::vector<std::uint32_t> ring_;
  std::vector<RawPoint> raw_;
};
}  // namespace lidar_panoptic_clustering

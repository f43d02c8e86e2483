#pragma once

#include "lidar_panoptic_clustering/core/class_table.h"
#include "lidar_panoptic_clustering/core/point_types.h"

#include <algorithm>
#include <cstdint>
#include <string>
#include <vector>

namespace lidar_panoptic_clustering
{
/// Which classes may share an instance.
enum class ClassPolicy : std::uint8_t
{
  kClass,  ///< the same class only
  kGroup,  ///< classes of one group of the class table
  kAny     ///< all thing classes
};

/// "class", "group", "any"
const std::vector<std::string>& classPolicyNames();
/// Throws std::invalid_argument for any other name.
ClassPolicy classPolicyFromName(const std::string& name);

/// A return of a thing class.
struct ThingPoint
{
  float x, y, z;         ///< [m], sensor frame
  std::uint32_t column;  ///< firing, 0-based
};

/// The thing points of an organised scan, scan line by scan line, each line by column: what clusterers work on.
///
/// `points`, `link` and `class_index` run in parallel, in row-major order of the pixels. Two points are linkable when
/// their `link` is the same; no algorithm takes points for neighbours that are linkDistance() apart or more.
struct ThingScan
{
  std::uint32_t rows = 0;     ///< scan lines
  std::uint32_t columns = 0;  ///< firings a line
  bool full_turn = true;      ///< whether the last column is the first one's neighbour
  float column_angle = 0.0F;  ///< azimuth between neighbouring columns [rad]

  std::vector<ThingPoint> points;         ///< row-major
  std::vector<std::uint8_t> link;         ///< key: class, group or 0, as the class policy says
  std::vector<ClassIndex> class_index;    ///< in the class table
  std::vector<std::uint32_t> line_begin;  ///< rows + 1 entries: line r is [line_begin[r], line_begin[r + 1])
  std::uint32_t link_count = 0;           ///< link < link_count
  std::uint32_t class_count = 0;          ///< class_index < class_count

  std::vector<float> class_link_distance;  ///< by class index: the widest gap between points of one object [m]

  std::vector<std::uint32_t> unknown_labels;  ///< up to 16 raw ids of this scan that the class table does not name

  /// Number of thing points.
  std::size_t size() const { return points.size(); }

  /// The widest gap between points i and j of one object [m]: of two classes the narrower.
  float linkDistance(std::uint32_t i, std::uint32_t j) const
  {
    return std::min(class_link_distance[class_index[i]], class_link_distance[class_index[j]]);
  }
};

/// "auto", "full_turn", "sector"
const std::vector<std::string>& fieldOfViewNames();

/// What is selected, and which points may share an instance.
struct SelectionConfig
{
  double max_range_m = 300.0;  ///< returns beyond count as no return
  /// Whether the scan closes on itself; "auto": told from the azimuth its columns span, for each scan.
  std::string field_of_view = "auto";
  std::string class_policy = "class";  ///< see classPolicyNames()
  double link_distance_scale = 1.0;    ///< factor on the class table's link distances

  template <class Self, class Visitor>
  static void visit(Self& self, Visitor&& visitor)
  {
    visitor("max_range_m", self.max_range_m, 1.0, 10000.0);
    visitor("field_of_view", self.field_of_view, fieldOfViewNames());
    visitor("class_policy", self.class_policy, classPolicyNames());
    visitor("link_distance_scale", self.link_distance_scale, 0.05, 100.0);
  }
};

/// The azimuth between neighbouring columns of an organised cloud [rad]: the mean over some hundred pairs of returns,
/// at most an eighth of the columns apart, evenly spread over the cloud. 0 where there are hardly any.
float measureColumnAngle(const LabelledCloud& cloud, float max_range_m);

/// Whether a scan's last column is the first one's neighbour, as `field_of_view` says or, with "auto", by the angle
/// between columns (measureColumnAngle): they span a turn, or nothing could be measured.
bool closesOnItself(const std::string& field_of_view, float column_angle, std::uint32_t columns);

/// Finds the thing points of an organised cloud: one pass, linear in the pixels, no allocation once `scan` has grown.
///
/// No return is NaN, infinity, exactly (0, 0, 0) or a range above max_range_m; is_dense is not looked at.
/// Throws std::invalid_argument when width * height is not the number of points.
void selectThings(const LabelledCloud& cloud, const ClassTable& table, const SelectionConfig& config, ThingScan& scan);

/// The same, and in the same pass fills `out` with the cloud's points in class colours, instance 0: the cloud is read
/// once for both.
void selectThings(const LabelledCloud& cloud, const ClassTable& table, const SelectionConfig& config, ThingScan& scan,
                  PanopticCloud& out);
/// That pass alone.
void copyInClassColors(const LabelledCloud& cloud, const ClassTable& table, PanopticCloud& out);
}  // namespace lidar_panoptic_clustering

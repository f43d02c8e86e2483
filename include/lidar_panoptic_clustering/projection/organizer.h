#pragma once

#include "lidar_panoptic_clustering/projection/raw_cloud.h"

#include <optional>
#include <string>
#include <vector>

namespace lidar_panoptic_clustering
{
/// What the rows of a driver's organised cloud are.
enum class Orientation
{
  kRowsAreRings,   ///< height = rings, as ouster-ros has it
  kRowsAreFirings  ///< height = firings, as the velodyne driver has it
};

/// "auto", "rows_are_rings", "rows_are_firings"
const std::vector<std::string>& orientationNames();

struct OrganizerConfig
{
  std::string orientation = "auto";
  std::string label_field = "label";  ///< class ids, of any number type
  std::string intensity_field = "intensity";
  std::string ring_field = "ring";  ///< looked at by "auto" alone, and only where it is there

  template <class Self, class Visitor>
  static void visit(Self& self, Visitor&& visitor)
  {
    visitor("orientation", self.orientation, orientationNames());
    visitor("label_field", self.label_field, std::vector<std::string>{});
    visitor("intensity_field", self.intensity_field, std::vector<std::string>{});
    visitor("ring_field", self.ring_field, std::vector<std::string>{});
  }
};

/// Finds out what the rows are: the field `ring_field` is constant along a scan line; without it, or where it tells
/// nothing, neighbouring returns of one scan line share their elevation, those of two lines do not.
///
/// Looks at a few thousand returns whatever the size of the cloud. Empty where these do not decide: hardly any returns,
/// or a frame so tilted against the sensor's that elevation changes as fast along a line as across. Throws
/// std::invalid_argument as checkLayout() does.
std::optional<Orientation> detectOrientation(const RawCloud& cloud, const std::string& ring_field);

/// Turns a driver's organised cloud into an organised labelled one, whose rows are scan lines.
///
/// The order of rings and of firings stays as sent. What is no return (NaN, infinity, exactly (0, 0, 0)) gets NaN
/// coordinates. Linear in the points. Not shared between threads.
class Organizer
{
public:
  /// Throws std::invalid_argument when `config` names no orientation.
  explicit Organizer(const OrganizerConfig& config);

  /// Fills `out` but for its header. Throws std::invalid_argument, with what was expected and found, for clouds that
  /// are not organised, lack a field or contradict themselves.
  void organize(const RawCloud& raw, LabelledCloud& out);

private:
  Orientation orientationOf(const RawCloud& raw);

  OrganizerConfig config_;
  std::optional<Orientation> fixed_;  ///< by the config; empty for "auto"
  std::optional<Orientation> last_;   ///< a sensor does not turn: what an undecided scan goes by
};
}  // namespace lidar_panoptic_clustering

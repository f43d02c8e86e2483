#pragma once

#include "lidar_panoptic_clustering/projection/layout_probe.h"
#include "lidar_panoptic_clustering/projection/organized_scan.h"
#include "lidar_panoptic_clustering/projection/raw_cloud.h"

#include <optional>
#include <string>
#include <vector>

namespace lidar_panoptic_clustering
{
/// "auto", "organized", "ring", "beams", "unfold", "merged"
const std::vector<std::string>& layoutNames();

struct OrganizerConfig
{
  std::string layout = "auto";
  std::string orientation = "auto";
  std::string label_field;      ///< class ids, of any number type; empty: the first usual name, see FieldNames
  std::string intensity_field;  ///< likewise
  std::string ring_field;       ///< likewise

  /// Not a parameter: whether the cloud carries class ids; without, see labelPoints() and labelPixels().
  bool labels = true;

  template <class Self, class Visitor>
  static void visit(Self& self, Visitor&& visitor)
  {
    visitor("layout", self.layout, layoutNames());
    visitor("orientation", self.orientation, orientationNames());
    visitor("label_field", self.label_field, std::vector<std::string>{});
    visitor("intensity_field", self.intensity_field, std::vector<std::string>{});
    visitor("ring_field", self.ring_field, std::vector<std::string>{});
  }
};

/// Turns a cloud as a driver publishes it into an organised labelled one, whose rows are scan lines, the highest first.
///
/// Each cloud is looked at afresh: a sensor may change its resolution or layout from one to the next. What is no return
/// (NaN, infinity, exactly (0, 0, 0)) gets NaN coordinates. Linear in points and pixels; allocates only while buffers
/// grow. Not shared between threads.
class Organizer
{
public:
  /// Throws std::invalid_argument when `config` has a value outside its range.
  explicit Organizer(const OrganizerConfig& config);

  /// Fills `out` but for its cloud's header. Throws std::invalid_argument, with what was expected and found, for clouds
  /// that cannot be organised, lack a field or contradict themselves; `out` then holds nothing of use.
  void organize(const RawCloud& raw, OrganizedScan& out);

private:
  Layout layoutOf(const RawCloud& raw, const ScanFields& fields) const;
  void takeRows(const RawCloud& raw, const ScanFields& fields, OrganizedScan& out);
  Orientation orientationOf(const RawCloud& raw);

  OrganizerConfig config_;
  FieldNames names_;
  std::optional<Layout> fixed_layout_;            ///< by the config; empty for "auto"
  std::optional<Orientation> fixed_orientation_;  ///< likewise
  LayoutProbe probe_;
  std::optional<Orientation> last_orientation_;  ///< a sensor does not turn: what an undecided scan goes by
  std::optional<bool> last_highest_first_;       ///< likewise
};
}  // namespace lidar_panoptic_clustering

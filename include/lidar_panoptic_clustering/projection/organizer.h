#pragma once

#include "lidar_panoptic_clustering/projection/layout_probe.h"
#include "lidar_panoptic_clustering/projection/organized_scan.h"
#include "lidar_panoptic_clustering/projection/raw_cloud.h"
#include "lidar_panoptic_clustering/projection/row_finder.h"
#include "lidar_panoptic_clustering/projection/sensor_model.h"

#include <optional>
#include <string>
#include <vector>

namespace lidar_panoptic_clustering
{
/// "auto", and the layouts in their order: "organized", "ring", "beams", "unfold", "merged"
///
/// "auto" takes clouds of several rows and columns for organised. A single row (or column) is placed by its field
/// `ring` where that has two values and more, unfolded where its points come ring after ring, placed by the sensor's
/// beams where a sensor is named, and left as it is where it is a scan line of its own; any other is refused. "ring" on
/// an organised cloud without such a field takes its scan lines for the rings.
const std::vector<std::string>& layoutNames();

struct OrganizerConfig
{
  std::string layout = "auto";
  std::string orientation = "auto";
  std::string sensor = "auto";  ///< of config/sensors or a file, for "beams", rows and columns; "auto": none is named
  int columns = 0;              ///< of a full turn, for clouds that are not organised; 0: the sensor's, else found
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
    visitor("sensor", self.sensor, std::vector<std::string>{});
    visitor("columns", self.columns, 0, 16384);
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
  /// Throws std::invalid_argument when `config` has a value outside its range or layout "beams" and no sensor, and as
  /// SensorModel::load() does.
  explicit Organizer(const OrganizerConfig& config);

  /// Fills `out` but for its cloud's header. Throws std::invalid_argument, with what was expected and found, for clouds
  /// that cannot be organised, lack a field or contradict themselves; `out` then holds nothing of use.
  void organize(const RawCloud& raw, OrganizedScan& out);

private:
  void organizeOneRow(const RawCloud& raw, const ScanFields& fields, OrganizedScan& out);
  void takeRows(const RawCloud& raw, const ScanFields& fields, OrganizedScan& out);
  void takeInOrder(const RawCloud& raw, const ScanFields& fields, OrganizedScan& out);
  std::uint32_t findRows(const OrganizedScan& scan);
  void placePoints(std::uint32_t rows, OrganizedScan& out);
  void readRings(const RawCloud& raw, const ScanFields& fields);
  Orientation orientationOf(const RawCloud& raw);

  OrganizerConfig config_;
  FieldNames names_;
  std::optional<Layout> fixed_layout_;            ///< by the config; empty for "auto"
  std::optional<Orientation> fixed_orientation_;  ///< likewise
  std::uint32_t sensor_rows_ = 0, columns_ = 0;   ///< 0 where they are found cloud by cloud
  std::optional<BeamTable> beams_;
  LayoutProbe probe_;
  RowFinder rows_;
  DirectionProjector projector_;
  std::vector<std::uint32_t> ring_of_point_;
  std::optional<Orientation> last_orientation_;  ///< a sensor does not turn: what an undecided scan goes by
  std::optional<bool> last_highest_first_;       ///< likewise
};
}  // namespace lidar_panoptic_clustering

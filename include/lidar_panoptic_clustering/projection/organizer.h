#pragma once

#include "lidar_panoptic_clustering/projection/found_layout.h"
#include "lidar_panoptic_clustering/projection/grid_finder.h"
#include "lidar_panoptic_clustering/projection/organized_rows.h"
#include "lidar_panoptic_clustering/projection/organized_scan.h"
#include "lidar_panoptic_clustering/projection/raw_cloud.h"
#include "lidar_panoptic_clustering/projection/row_finder.h"
#include "lidar_panoptic_clustering/projection/sensor_model.h"

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace lidar_panoptic_clustering
{
/// "auto", and the layouts in their order: "organized", "ring", "beams", "unfold", "merged"
///
/// "auto" takes clouds of several rows and columns for organised, in whichever of the four ways they make scan lines;
/// by their field `ring` where they make none. A single row (or column) is placed by its field `ring` where that has
/// two values and more, unfolded where its points come ring after ring, placed by the sensor's beams where a sensor is
/// named, and left as it is where it is a scan line of its own; any other is refused. "ring" on an organised cloud
/// without such a field takes its scan lines for the rings, where they are such.
const std::vector<std::string>& layoutNames();

/// How the points lie in the messages.
struct OrganizerConfig
{
  std::string layout = "auto";       ///< see layoutNames()
  std::string orientation = "auto";  ///< of organised clouds, see orientationNames()
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
/// What a cloud is taken for is held to what a scan must be: each row one beam, the rows in the sequence of their
/// elevation, neighbours in azimuth, hardly any returns hidden. A cloud that is not so is refused with what was found.
///
/// What was found in one cloud holds for the stream, so that image and rows mean the same from scan to scan: number and
/// sequence of rows, columns of clouds that are not organised. A scan that contradicts it is refused alone; ten in a
/// row that do so change it. An organised cloud may at any time have another number of rows or columns. Scans with
/// hardly any returns decide nothing and follow.
///
/// Where no sensor is named, a cloud of one row with a field `ring` gets RowFinder::beamsOf() the highest ring seen,
/// one ring after ring as many rows as rings came; the number grows within a stream and never shrinks. With a sensor it
/// is its number of beams.
///
/// What is no return (NaN, infinity, exactly (0, 0, 0)) gets NaN coordinates. Linear in points and pixels; allocates
/// only while buffers grow. Not shared between threads.
class Organizer
{
public:
  /// Throws std::invalid_argument when `config` has a value outside its range or layout "beams" and no sensor, and as
  /// SensorModel::load() does.
  explicit Organizer(const OrganizerConfig& config);

  /// Fills `out` but for its cloud's header. Throws std::invalid_argument, with what was expected and found, for clouds
  /// that cannot be organised, lack a field or contradict themselves; `out` then holds nothing of use.
  void organize(const RawCloud& raw, OrganizedScan& out);

  /// What the clouds were found to be so far; nothing is known() before the first one.
  const FoundLayout& found() const { return decision_.found; }

private:
  struct Decision
  {
    FoundLayout found;
    RowPlacement placement;  ///< of organised clouds
    double firings = 0.0;    ///< of a turn; 0 where unknown
    bool firm = false;       ///< enough was seen to hold it
  };

  Decision decide(const RawCloud& raw, const ScanFields& fields, OrganizedScan& out);
  void follow(const RawCloud& raw, const ScanFields& fields, OrganizedScan& out);
  void reconsider(const RawCloud& raw, const ScanFields& fields, OrganizedScan& out);
  void adopt(Decision decision);

  Decision decideOneRow(const RawCloud& raw, const ScanFields& fields, OrganizedScan& out);
  Decision decideRowsOrRings(const RawCloud& raw, const ScanFields& fields, OrganizedScan& out);
  Decision decideRows(const RawCloud& raw, const ScanFields& fields, OrganizedScan& out);
  Decision decideRings(const RawCloud& raw, const ScanFields& fields, OrganizedScan& out);
  Decision decideBeams(const RawCloud& raw, const ScanFields& fields, OrganizedScan& out);
  std::optional<Decision> decideUnfolded(const RawCloud& raw, const ScanFields& fields, OrganizedScan& out);
  Decision decideUnfoldedOnly(const RawCloud& raw, const ScanFields& fields, OrganizedScan& out);
  Decision takeInOrder(const RawCloud& raw, const ScanFields& fields, OrganizedScan& out);

  Grid gridOf(const RawCloud& raw, const ScanFields& fields, OrganizedScan& out, Decision& decision);
  [[noreturn]] void refuseColumns(const RawCloud& raw, const ScanFields& fields, OrganizedScan& out, const Grid& grid);
  void orderLines(const RawCloud& view, OrganizedScan& out, Decision& decision);
  void followRows(const RawCloud& raw, const ScanFields& fields, OrganizedScan& out);
  void followPoints(const RawCloud& raw, const ScanFields& fields, OrganizedScan& out);
  void readRings(const RawCloud& raw, const ScanFields& fields, const FoundLayout& found, OrganizedScan& out);
  void numberRings(const RawCloud& raw, const FoundLayout& found);
  void place(std::uint32_t rows, Decision& decision, OrganizedScan& out);
  void project(std::uint32_t rows, std::uint32_t columns, OrganizedScan& out);
  double mostHidden(const Decision& decision) const;
  double hiddenShare(double most, const OrganizedScan& out) const;
  Orientation assumedOrientation(const RawCloud& raw) const;

  OrganizerConfig config_;
  FieldNames names_;
  std::optional<Layout> fixed_layout_;            ///< by the config; empty for "auto"
  std::optional<Orientation> fixed_orientation_;  ///< likewise
  std::uint32_t sensor_rows_ = 0, columns_ = 0;   ///< 0 where they are found
  std::optional<BeamTable> beams_;

  Decision decision_;
  int against_ = 0;  ///< scans in a row that contradict the decision
  GridFinder grid_;
  RowFinder rows_, held_rows_;  ///< the second while a scan is looked at that contradicts the decision
  DirectionProjector projector_;
  std::vector<std::uint32_t> ring_of_point_;
};
}  // namespace lidar_panoptic_clustering

#pragma once

#include "lidar_panoptic_clustering/core/point_types.h"
#include "lidar_panoptic_clustering/core/thing_scan.h"
#include "lidar_panoptic_clustering/labelling/component_judge.h"
#include "lidar_panoptic_clustering/labelling/ground_surface.h"
#include "lidar_panoptic_clustering/labelling/polar_view.h"
#include "lidar_panoptic_clustering/labelling/scan_components.h"
#include "lidar_panoptic_clustering/projection/organized_scan.h"

#include <array>
#include <cstdint>
#include <string>
#include <vector>

namespace lidar_panoptic_clustering
{
/// What is ground, and what an object can be.
struct GroundLabelerConfig
{
  double max_range_m = 300.0;          ///< returns beyond count as no return
  std::string field_of_view = "auto";  ///< or full_turn, sector; see SelectionConfig
  double ground_height_m = 0.15;       ///< what is lower is ground: a curb's height
  double max_slope = 0.08;     ///< of the ground against the plane around the sensor, rise over run: of steep streets
  double link_m = 0.7;         ///< the widest gap between neighbouring returns of one thing: a car's side window
  double max_height_m = 4.2;   ///< no object is higher: 4.0 m is the limit for vehicles in most of Europe
  double max_length_m = 20.0;  ///< no object is longer: 18.75 m is the European limit for lorries with trailers
  std::string structure = "balanced";  ///< or strict: fewer false objects; keep_objects: fewer lost ones

  template <class Self, class Visitor>
  static void visit(Self& self, Visitor&& visitor)
  {
    visitor("max_range_m", self.max_range_m, 1.0, 10000.0);
    visitor("field_of_view", self.field_of_view, fieldOfViewNames());
    visitor("ground_height_m", self.ground_height_m, 0.02, 1.0);
    visitor("max_slope", self.max_slope, 0.0, 1.0);
    visitor("link_m", self.link_m, 0.05, 5.0);
    visitor("max_height_m", self.max_height_m, 0.5, 100.0);
    visitor("max_length_m", self.max_length_m, 0.5, 1000.0);
    visitor("structure", self.structure, structureBiasNames());
  }
};

/// What a scan tells of the ground under the sensor, for diagnostics.
struct GroundReport
{
  /// It has not where there are hardly any returns, or the sensor stands on its head and its driver did not turn the
  /// cloud round. Then nothing is labelled ground, and the rest means nothing.
  bool found = false;
  SlopedPlane plane;             ///< of the ground around the sensor, in its frame
  double sensor_height_m = 0.0;  ///< over the plane, at right angles to it
  double slope_deg = 0.0;        ///< of the plane against the sensor's x-y plane: how the sensor is tilted, or the road
};

/// Labels a scan without any network: ground, structure (walls, fences, poles, trees), and the rest as objects, in the
/// raw ids of the class table "object".
///
/// The ground is followed from under the sensor (see GroundSurface); what hangs together above it (see ScanComponents)
/// is judged as a whole, but for people, who are found before what they stand at (see ComponentJudge), and where they
/// lean on it are told by how high they reach (see ColumnProfile). The sensor's height over the ground and a tilt of up
/// to 12 degrees each way are found in each scan.
///
/// What it cannot tell: a bush from a car of its size, a vehicle that only shows a bare tall side down to the ground
/// from a wall, and a person who leans on something from that thing, unless he stands above it by head and shoulders.
///
/// Not shared between threads; keeps its memory.
class GroundLabeler
{
public:
  /// Throws std::invalid_argument on a value outside its range.
  explicit GroundLabeler(const GroundLabelerConfig& config);

  /// Writes the labels of an organised cloud, whose rows are scan lines from the highest down or from the lowest up; z
  /// points up. Missing returns (NaN, infinity, exactly (0, 0, 0), out of range) become "ignored", as does whatever is
  /// straight above or below the sensor. Throws std::invalid_argument when width * height is not the number of points.
  /// Linear in the pixels.
  void label(LabelledCloud& cloud);

  /// Labels the points of a scan whose image label() was given: those that a pixel shows as there, hidden ones by their
  /// own height over the ground and, above it, as the nearest return above the ground that is shown within 0.35 m, in
  /// the 5 x 9 pixels around; where there is none, as structure. Linear in the points.
  void labelPoints(const OrganizedScan& scan, std::vector<std::uint32_t>& labels) const;

  /// Labels points without scan lines, in any order, by a view of them (see PolarView). Linear.
  void labelUnordered(const std::vector<ScanPoint>& points, std::vector<std::uint32_t>& labels);

  /// Of a place [m], sensor frame, above the ground of the last scan; NaN where that shows none.
  float heightOf(float x, float y, float z) const;

  /// Of the last scan.
  GroundReport ground() const;
  /// Whether the last scan shows ground under the sensor.
  bool foundGround() const { return found_ground_; }
  /// The ground around the sensor; without ground it means nothing.
  const SlopedPlane& groundPlane() const { return surface_.plane(); }

private:
  void judge(const LabelledCloud& cloud);
  void showPeople();
  void showPerson(std::uint32_t part);
  bool mayBeStall(std::uint32_t component) const;
  void showGround(LabelledCloud& cloud, std::size_t begin, std::size_t end);
  void showPart(LabelledCloud& cloud, std::uint32_t pixel);
  unsigned char hidden(const ScanPoint& p, const LabelledCloud& cloud, std::uint32_t pixel) const;

  GroundLabelerConfig config_;
  std::array<std::uint32_t, 4> ids_{};  ///< raw: ignored, ground, structure, object
  GroundSurface surface_;
  ScanComponents components_;
  ComponentJudge judge_;
  PolarView view_;
  bool found_ground_ = false;
  std::vector<GroundedReturn> returns_;
  std::vector<std::uint32_t> leant_on_;                                    ///< parts that someone may lean on
  std::vector<unsigned char> shown_of_component_, shown_of_part_, shown_;  ///< places in ids_; the last by pixel
};
}  // namespace lidar_panoptic_clustering

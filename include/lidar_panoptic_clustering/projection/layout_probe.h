#pragma once

#include "lidar_panoptic_clustering/projection/scan_fields.h"

#include <cstdint>
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
/// Nothing for "auto"; throws std::invalid_argument for a name that is none.
std::optional<Orientation> orientationFromName(const std::string& name);

/// Looks at about a thousand returns of an organised cloud, whatever its size, and at their neighbours. Where that
/// decides nothing, at all of them.
///
/// Works on any layout that findScanFields() accepted. Buffers are kept; not shared between threads.
class LayoutProbe
{
public:
  /// Looks at about a thousand points, and at all where hardly anything returns.
  void look(const RawCloud& cloud, const ScanFields& fields);

  /// What the rows are: the ring is constant along a scan line; without it, or where it tells nothing, neighbouring
  /// returns of one scan line share their elevation, those of two lines do not. Empty where these do not decide: hardly
  /// any returns, or a frame so tilted against the sensor's that elevation changes as fast along a line as across.
  std::optional<Orientation> orientation() const;

  /// Whether the first scan line is the highest beam; empty where hardly any two lines have returns side by side.
  std::optional<bool> highestFirst(Orientation orientation) const;

  /// By how many columns the azimuth within one firing differs from a scan line to the next, in the mean over the
  /// lines: well below 1 where a column is a firing (0.2 and less in recorded PandaSet and Ouster clouds), 4 to 24 in
  /// an Ouster's with destaggering off, 8 and more for a VLP-32C's rows as they are fired. What changes sign with the
  /// azimuth, as in a tilted frame, cancels. 0 where hardly anything returned.
  double staggeredColumns(Orientation orientation) const;

  /// How far the azimuth gets along the scan lines, of the way that it goes: 1 where columns follow each other in
  /// azimuth, near 0 where they lie in no sequence or go to and fro. 1 too where hardly anything returned.
  double progress(Orientation orientation) const;
  /// The angle that the columns span, by the mean step of the azimuth, signed [rad]. 0 where hardly anything returned.
  double turned(Orientation orientation) const;

  /// Whether enough returns have neighbours, either way, for the figures to mean something.
  bool enough() const;

  /// Means of what changes from one firing to the next along the scan lines, absolute [rad; of the elevation its sine].
  double azimuthStep(Orientation orientation) const;
  /// See azimuthStep().
  double elevationStep(Orientation orientation) const;

  /// The share of neighbouring scan lines of which the one with the lower row in `row_of_line` is the higher one; 1
  /// where hardly any two have returns side by side.
  double agreement(Orientation orientation, const std::vector<std::uint32_t>& row_of_line) const;

private:
  struct Pixel;
  /// Sums over the pixels compared between two neighbouring rows (or columns).
  struct Pair
  {
    float azimuth = 0.0F;    ///< signed differences [rad]
    float elevation = 0.0F;  ///< signed differences of its sine
    std::uint32_t count = 0;
  };
  /// Differences in one direction of the cloud.
  struct Direction
  {
    std::vector<Pair> pairs;                ///< by the lower of the two rows (columns)
    double elevation = 0.0, azimuth = 0.0;  ///< sums of absolute differences
    double net_azimuth = 0.0;               ///< of signed ones
    std::size_t other_rings = 0, count = 0;

    void reset(std::size_t lines);
    void add(std::size_t line, const Pixel& here, const Pixel& there);
    double meanElevation() const { return elevation / static_cast<double>(count); }
  };

  void gather(const RawCloud& cloud, const ScanFields& fields, std::size_t stride);
  const Direction& across(Orientation o) const { return o == Orientation::kRowsAreRings ? down_ : right_; }
  const Direction& along(Orientation o) const { return o == Orientation::kRowsAreRings ? right_ : down_; }

  Direction right_, down_;  ///< between columns, between rows
  bool has_ring_ = false;
};
}  // namespace lidar_panoptic_clustering

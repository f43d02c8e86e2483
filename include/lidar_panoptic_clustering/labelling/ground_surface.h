#pragma once

#include "lidar_panoptic_clustering/core/point_types.h"
#include "lidar_panoptic_clustering/labelling/ground_plane.h"

#include <cstddef>
#include <cstdint>
#include <vector>

namespace lidar_panoptic_clustering
{
/// Where a return lies; in the place of a missing one, NaN.
struct GroundedReturn
{
  float range;   ///< horizontal [m]
  float height;  ///< above the ground [m]

  /// Whether the pixel holds a return.
  bool isReturn() const { return range > 0.0F; }
};

/// The ground around the sensor, from a scan without labels: a height in each cell of a polar grid.
///
/// 1. The lowest return of each cell stands for it. 2. A plane is found among those within 20 m (see
/// findGroundPlane); it takes in how the sensor is mounted, height and tilt (up to 12 degrees each way). 3. From under
/// the sensor the ground is followed outwards: a cell's lowest return is ground where a slope of `max_slope` against
/// the plane leads to it from the cells inside and beside; where there is none, the ground goes on as it was. What
/// rises within a cell is ground only where it begins: the sill of a car behind metres without ground is none.
/// 4. Cells without ground of their own lie on the line between the nearest seen inside and outside of them.
///
/// After Himmelsbach et al. 2010 ("Fast segmentation of 3D point clouds for ground vehicles", IV), with neighbouring
/// sectors helping where one is hidden. The order of points means nothing. Linear in the points; keeps its memory.
class GroundSurface
{
public:
  GroundSurface();

  /// No return is NaN, infinity, exactly (0, 0, 0), anything straight above or below the sensor, and what is farther
  /// than `max_range_m`. `max_slope`: rise over run, against the plane. Returns whether there is ground; without it,
  /// heights are those above the lowest return.
  bool find(const LabelledCloud& cloud, float max_range_m, float max_slope);

  /// Writes where points of the cloud that find() was given lie, from `begin` to before `end`; `returns` holds as many
  /// as the cloud. Apart from find(), so that a row can be worked on while it is in the cache.
  void locate(const LabelledCloud& cloud, std::size_t begin, std::size_t end,
              std::vector<GroundedReturn>& returns) const;

  /// Above the ground of the last scan [m].
  float heightOf(float x, float y, float z) const;

  /// The plane under the sensor in the last scan.
  const SlopedPlane& plane() const { return plane_; }

private:
  static constexpr std::uint32_t kSectors = 180;  ///< see PolarGrid

  /// The returns of a cell.
  struct CellReturns
  {
    std::int64_t lowest;  ///< its height, in an order of whole numbers, and below that its place in the cloud
    float top;            ///< how high they reach
  };
  /// The lowest return of a cell, on its own.
  struct Lowest
  {
    float height;  ///< above the plane [m]
    float range;   ///< horizontal [m]; 0: there is none
    float rise;    ///< of the cell's highest above it [m]
  };
  /// The ground of a cell.
  struct Ground
  {
    float height;    ///< above the plane [m]
    float distance;  ///< horizontal, where it was seen, else the cell's middle [m]
    float unseen;    ///< how far back it was seen last [m]; 0: here
    float weight;    ///< in what the next cells out expect: the less, the longer it was not seen
  };
  /// The ground from a cell's to the next one's out.
  struct Line
  {
    float distance, ground;  ///< where it begins: horizontal [m]; above the plane [m]
    float rise;              ///< over run
    float unused;            ///< to 16 bytes, so that four are taken at once
  };

  void sortIntoCells(const LabelledCloud& cloud, float max_range_m);
  void takeLowest(const LabelledCloud& cloud, std::size_t begin, std::size_t end);
  bool findPlane(const LabelledCloud& cloud);
  void measureLowest();
  void follow(float max_slope);
  void followTo(std::uint32_t bin, float max_slope);
  void refuseIslands(std::uint32_t bin);
  void bridge();
  void flatten();
  void drawLines();
  /// On the line between the grounds of two cells; beyond the last one as there.
  float groundAt(std::uint32_t cell, float range) const
  {
    const std::uint32_t is_inside = range < lines_[cell].distance ? 1U : 0U;  // the first bin has its at 0 m
    const Line& line = lines_[cell - is_inside * kSectors];
    return line.ground + line.rise * (range - line.distance);
  }

  SlopedPlane plane_;
  std::vector<std::uint16_t> cell_of_;     ///< by point
  std::vector<CellReturns> returns_;       ///< by cell
  std::vector<LowReturn> lowest_returns_;  ///< by cell; NaN where there is none
  std::vector<Lowest> lowest_;             ///< by cell
  std::vector<LowReturn> near_;            ///< the lowest of the cells around the sensor
  std::vector<Ground> ground_;             ///< by cell
  std::vector<float> expected_;            ///< by sector: what the cells inside let expect of the bin in hand
  std::vector<Line> lines_;                ///< by cell
};
}  // namespace lidar_panoptic_clustering

#pragma once

#include "lidar_panoptic_clustering/core/point_types.h"

#include <cstdint>
#include <vector>

namespace lidar_panoptic_clustering
{
/// z = slope_x x + slope_y y + offset [m], sensor frame.
struct SlopedPlane
{
  float slope_x = 0.0F, slope_y = 0.0F, offset = 0.0F;  ///< z = slope_x x + slope_y y + offset [m]

  /// Above the plane, along z [m].
  float heightOf(float x, float y, float z) const { return z - slope_x * x - slope_y * y - offset; }
};

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
/// 1. The lowest return of each cell stands for it. 2. A plane is found among those within 20 m: a vote over slopes and
/// offsets, then least squares; it takes in how the sensor is mounted, height and tilt (up to 12 degrees each way). 3.
/// From under the sensor the ground is followed outwards: a cell's lowest return is ground where a slope of `max_slope`
/// against the plane leads to it from the cells inside and beside; where there is none, the ground goes on as it was.
/// What rises within a cell is ground only where it begins: the sill of a car behind metres without ground is none.
/// 4. Cells without ground of their own lie on the line between the nearest seen inside and outside of them.
///
/// After Himmelsbach et al. 2010 ("Fast segmentation of 3D point clouds for ground vehicles", IV), with neighbouring
/// sectors helping where one is hidden. The order of points means nothing. Linear in the points; keeps its memory.
class GroundSurface
{
public:
  GroundSurface();

  /// Writes where each point of `cloud` lies. No return is NaN, infinity, exactly (0, 0, 0), anything straight above or
  /// below the sensor, and what is farther than `max_range_m`. `max_slope`: rise over run, against the plane.
  /// Returns whether there is ground; without it, heights are those above the lowest return.
  bool measure(const LabelledCloud& cloud, float max_range_m, float max_slope, std::vector<GroundedReturn>& returns);

  /// Above the ground of the last scan [m].
  float heightOf(float x, float y, float z) const;

  /// The plane under the sensor in the last scan.
  const SlopedPlane& plane() const { return plane_; }

private:
  struct Low
  {
    float x, y, z;
  };
  /// The returns of a cell: the lowest, and how high they reach.
  struct Lowest
  {
    float z;
    std::uint32_t point;
    float top;
  };
  /// The ground from a cell's to the next one's out.
  struct Line
  {
    float distance, ground;  ///< where it begins: horizontal [m]; above the plane [m]
    float rise;              ///< over run
  };

  void sortIntoCells(const LabelledCloud& cloud, float max_range_m, std::vector<GroundedReturn>& returns);
  bool findPlane(const LabelledCloud& cloud);
  void votePlane();
  std::size_t fitPlane(float gate);
  void follow(const LabelledCloud& cloud, float max_slope);
  void followTo(std::uint32_t bin, const LabelledCloud& cloud, float max_slope);
  void refuseIslands(std::uint32_t bin);
  void bridge();
  void flatten();
  /// On the line between the grounds of two cells; beyond the last one as there.
  float groundAt(std::uint32_t cell, float range) const
  {
    const Line& line = lines_[cell - (range < lines_[cell].distance ? 1 : 0)];  // a sector's first has its at 0 m
    return line.ground + line.rise * (range - line.distance);
  }
  void writeHeights(const LabelledCloud& cloud, std::vector<GroundedReturn>& returns);

  SlopedPlane plane_;
  std::vector<std::uint16_t> cell_of_;  ///< by point
  std::vector<Lowest> lowest_;          ///< by cell, the bins of a sector in a row
  std::vector<Low> near_;               ///< the lowest of the cells around the sensor
  std::vector<float> ground_;           ///< by cell: above the plane [m]
  std::vector<float> distance_;         ///< by cell: horizontal, where its ground was seen [m]
  std::vector<float> unseen_;           ///< by cell: how far back the ground was seen last [m]; 0: here
  std::vector<float> expected_;         ///< by sector: what the cells inside let expect of the bin in hand
  std::vector<Line> lines_;             ///< by cell
};
}  // namespace lidar_panoptic_clustering

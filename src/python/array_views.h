#pragma once

#include "lidar_panoptic_clustering/projection/point_projection.h"

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace lidar_panoptic_clustering
{
/// The points of an array of shape (N, channels) or (H, W, channels), where they lie: owns nothing.
struct PointsView
{
  const std::uint8_t* data = nullptr;            ///< the first number
  bool is_double = false;                        ///< float64; otherwise float32
  bool organized = false;                        ///< (H, W, channels): rows are scan lines
  std::size_t height = 1, width = 0;             ///< points; (N, channels) is one row
  std::size_t channels = 0;                      ///< 3 or more: x y z [m], remission, what follows is not read
  std::ptrdiff_t row_step = 0, column_step = 0;  ///< bytes; any sign
  std::ptrdiff_t channel_step = 0;               ///< likewise

  std::size_t size() const { return height * width; }
};

/// Whole numbers of an array of the same shape, one a point.
struct IdsView
{
  const std::uint8_t* data = nullptr;            ///< the first number
  std::size_t bytes = 4;                         ///< of a number: 1, 2, 4, 8
  bool is_signed = false;                        ///< two's complement
  std::size_t height = 1, width = 0;             ///< numbers
  std::ptrdiff_t row_step = 0, column_step = 0;  ///< bytes; any sign

  std::size_t size() const { return height * width; }
};

/// Where the points lie as ScanPoint has them, one after the other, the view of them; otherwise copies them into
/// `buffer`, row-major, and views that. Remission is 0 where there is no fourth channel; a float64 beyond float's range
/// becomes infinite. Linear.
ScanPoints readPoints(const PointsView& view, std::vector<ScanPoint>& buffer);

/// Copies the ids, row-major. Throws std::invalid_argument naming `what`, the point and the number where one is
/// negative or does not fit 32 bits. Linear.
void readIds(const IdsView& view, const std::string& what, std::vector<std::uint32_t>& ids);
}  // namespace lidar_panoptic_clustering

#include "lidar_panoptic_clustering/labelling/ground_plane.h"

#include "four_floats.h"

#include <Eigen/Dense>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>

namespace lidar_panoptic_clustering
{
namespace
{
constexpr std::size_t kOffsets = 48;  // down to 12 m below the sensor
constexpr float kOffsetStep = 0.25F;
using Votes = std::array<int, kOffsets + 2>;  ///< by offset; then those for none, after one that has none

/// Votes of a few hundred returns, four at once.
class Voters
{
public:
  explicit Voters(const std::vector<LowReturn>& lowest)
  {
    constexpr std::size_t kVoters = 300;
    const std::size_t stride = 1 + lowest.size() / kVoters;
    constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();
    for (std::size_t i = 0; i < lowest.size(); i += stride, ++size_)
      x_[size_] = lowest[i].x, y_[size_] = lowest[i].y, z_[size_] = lowest[i].z;
    for (; size_ % 4 != 0; ++size_) x_[size_] = y_[size_] = z_[size_] = kNaN;
  }

  Votes forSlopes(const SlopedPlane& plane) const
  {
    Votes votes{};
    for (std::size_t i = 0; i < size_; i += 4)
    {
      const FourFloats height = loadFour(&z_[i]) - plane.slope_x * loadFour(&x_[i]) - plane.slope_y * loadFour(&y_[i]);
      const FourFloats below = -height / kOffsetStep;
      const FourInts is_in = (below > 0.0F) & (below < float{kOffsets});
      const FourInts offset = select(is_in, truncated(below), FourInts{} + static_cast<std::int32_t>(kOffsets + 1));
      for (int k = 0; k < 4; ++k) ++votes[static_cast<std::size_t>(offset[k])];
    }
    return votes;
  }

private:
  std::array<float, 304> x_, y_, z_;  ///< the stride leaves 300 at most
  std::size_t size_ = 0;
};

/// The slopes and offset that most of the returns agree on, coarsely.
SlopedPlane votePlane(const std::vector<LowReturn>& lowest)
{
  constexpr int kSlopes = 6;  // either side, two degrees each
  constexpr float kSlopeStep = 0.035F;
  const Voters voters(lowest);
  SlopedPlane elected;
  int most = -1;
  for (int v = -kSlopes; v <= kSlopes; ++v)
    for (int u = -kSlopes; u <= kSlopes; ++u)
    {
      const SlopedPlane plane{kSlopeStep * static_cast<float>(u), kSlopeStep * static_cast<float>(v), 0.0F};
      const Votes votes = voters.forSlopes(plane);
      for (std::size_t k = 0; k < kOffsets; ++k)
        if (votes[k] + votes[k + 1] > most)
        {
          most = votes[k] + votes[k + 1];
          elected = {plane.slope_x, plane.slope_y, -kOffsetStep * static_cast<float>(k + 1)};
        }
    }
  return elected;
}

/// Least squares through the returns within `gate` of the plane so far; returns how many there are.
std::size_t fitPlane(const std::vector<LowReturn>& lowest, float gate, SlopedPlane& plane)
{
  Eigen::Matrix3d normal = Eigen::Matrix3d::Zero();
  Eigen::Vector3d right = Eigen::Vector3d::Zero();
  std::size_t count = 0;
  for (const LowReturn& low : lowest)
  {
    if (std::abs(plane.heightOf(low.x, low.y, low.z)) > gate) continue;
    const Eigen::Vector3d row(low.x, low.y, 1.0);
    normal += row * row.transpose();
    right += row * static_cast<double>(low.z);
    ++count;
  }
  // a ridge of a millimetre a metre: what the cells do not tell, such as the slope across a single row, stays level
  normal.diagonal() += Eigen::Vector3d(1e-3, 1e-3, 1e-9);
  const Eigen::Vector3f solution = normal.ldlt().solve(right).cast<float>();
  plane = {solution.x(), solution.y(), solution.z()};
  return count;
}
}  // namespace

bool findGroundPlane(const std::vector<LowReturn>& lowest, SlopedPlane& plane)
{
  constexpr std::size_t kFewest = 10;
  constexpr float kGates[] = {0.5F, 0.3F, 0.2F, 0.2F};
  if (lowest.size() < kFewest) return false;
  plane = votePlane(lowest);
  std::size_t on_plane = 0;
  for (const float gate : kGates) on_plane = fitPlane(lowest, gate, plane);
  return plane.offset < 0.0F && on_plane >= std::max(kFewest, lowest.size() / 10);
}
}  // namespace lidar_panoptic_clustering

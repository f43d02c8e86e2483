#pragma once

#include "lidar_panoptic_clustering/core/point_types.h"
#include "lidar_panoptic_clustering/projection/scan_unfolding.h"

#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

namespace lidar_panoptic_clustering
{
/// A return as a KITTI file stores it. 16 bytes.
struct ScanPoint
{
  float x, y, z;    ///< [m], sensor frame
  float remission;  ///< 0..1
};

/// Points of a scan that lie one after the other: a view that owns none.
class ScanPoints
{
public:
  ScanPoints(const ScanPoint* points, std::size_t count) : points_(points), count_(count) {}  ///< `count` from `points`
  ScanPoints(const std::vector<ScanPoint>& points) : ScanPoints(points.data(), points.size()) {}  ///< all of them

  std::size_t size() const { return count_; }                              ///< number of points
  bool empty() const { return count_ == 0; }                               ///< whether there are none
  const ScanPoint& operator[](std::size_t i) const { return points_[i]; }  ///< i below size()
  const ScanPoint* begin() const { return points_; }                       ///< the first
  const ScanPoint* end() const { return points_ + count_; }                ///< behind the last

private:
  const ScanPoint* points_;
  std::size_t count_;
};

/// The size of the range image.
struct ProjectionConfig
{
  int rows = 64;       ///< scan lines of the sensor
  int columns = 2048;  ///< azimuth bins of a full turn

  template <class Self, class Visitor>
  static void visit(Self& self, Visitor&& visitor)
  {
    visitor("rows", self.rows, 1, 1024);
    visitor("columns", self.columns, 16, 16384);
  }
};

/// An unordered scan as an organised cloud, and which points of the scan went where.
///
/// Pixels are row-major, pixel = row * width + column. Row 0 is the scan's first ring, KITTI's highest beam. Column 0
/// looks backwards (azimuth pi) and the azimuth falls with the column: the picture as one sees it looking ahead, +x in
/// the middle, +y left of it.
struct Projection
{
  static constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();  ///< no point, or no pixel

  LabelledCloud cloud;                        ///< NaN coordinates where no return fell
  std::vector<std::uint32_t> pixel_of_point;  ///< kNone for what is no return
  std::vector<std::uint32_t> owner_of_pixel;  ///< the point the pixel shows, kNone where it is empty

  /// All points of a pixel, in file order: points[begin[pixel]] .. points[begin[pixel + 1] - 1]. Every point of the
  /// scan stands in exactly one pixel's list.
  std::vector<std::uint32_t> begin;
  std::vector<std::uint32_t> points;  ///< see begin

  std::uint32_t rings = 0;  ///< found in the scan, however many rows there are
};

/// Where a point goes. The azimuth is NaN where there is no return.
struct PointDirection
{
  float azimuth;  ///< [rad], in [-pi, pi]
  /// 0 is the highest beam.
  std::uint32_t row;
};

/// Whether a point can be projected: finite, not (0, 0, 0), and near enough to square its range.
inline bool hasDirection(const ScanPoint& p)
{
  const float squared_range = p.x * p.x + p.y * p.y + p.z * p.z;
  return squared_range > 0.0F && squared_range < std::numeric_limits<float>::infinity();  // false for NaN
}

/// Projects points whose rows are known; the column is the azimuth's. Buffers are kept between scans.
class DirectionProjector
{
public:
  /// The nearest point owns the pixel, the first of equals. A point without a return stands in its predecessor's pixel,
  /// in any order of points, and owns none.
  ///
  /// `directions`: one a point, rows below `rows`; `labels`: one a point, or empty for none (0); `class_bits`: the bits
  /// of a label that are its class; `shift`: parts of a column, 0 to 1, by which all azimuths move to the right, so
  /// that firings at the border of two columns fall into one of them. All but `rings` of `out` is filled. Linear in
  /// points and pixels; allocates only while buffers grow.
  void project(ScanPoints scan, const std::vector<std::uint32_t>& labels, const std::vector<PointDirection>& directions,
               std::uint32_t rows, std::uint32_t columns, std::uint32_t class_bits, Projection& out,
               float shift = 0.0F);

  /// Returns of the scan projected last that lie behind others of their pixel, and all of its returns.
  std::size_t hiddenReturns() const { return hidden_.size() - without_return_; }
  /// See hiddenReturns().
  std::size_t returns() const { return returns_; }
  /// Points of that scan that own no pixel, those without a return too.
  const std::vector<std::uint32_t>& hidden() const { return hidden_; }

private:
  void locate(ScanPoints scan, const std::vector<PointDirection>& directions, std::uint32_t columns, float shift,
              Projection& out);
  void findPixels(const std::vector<PointDirection>& directions, std::size_t begin, std::size_t end,
                  std::uint32_t columns, float shift, Projection& out);
  void takePixel(ScanPoints scan, std::uint32_t point, PointDirection direction, Projection& out);
  void takeOwners(std::uint32_t rows, std::uint32_t columns, Projection& out);
  void listPoints(Projection& out);

  /// Between the rows of owners_, a line of the cache: where columns are a power of two, a firing's pixels would all
  /// fall to the same place of it.
  static constexpr std::uint32_t kGap = 16;

  std::vector<std::uint32_t> owners_;  ///< as Projection::owner_of_pixel
  std::vector<std::uint32_t> hidden_;  ///< points that own no pixel
  std::vector<std::uint32_t> full_;    ///< the pixels these stand in
  std::size_t returns_ = 0, without_return_ = 0;
};

/// The direction of each point of a scan whose points come ring after ring (see RingCounter): the row is its ring,
/// from 0. A point without a return has its predecessor's ring. Returns the number of rings. Linear.
std::uint32_t unfoldScan(ScanPoints scan, const Sweep& sweep, std::vector<PointDirection>& directions);

/// Projects scans whose points come ring after ring (see RingCounter); buffers are kept between scans.
class PointProjector
{
public:
  /// Throws std::invalid_argument when a member of `config` is outside its range.
  explicit PointProjector(const ProjectionConfig& config);

  /// The row is the point's ring, the column its azimuth; the nearest point owns the pixel, the first of equals.
  /// Rings beyond the last row go into the last row, so that no point is lost; fewer rings leave rows empty.
  /// A point without a return (not finite, 0 0 0, or too far to square) stands in its predecessor's pixel and owns
  /// none.
  ///
  /// `labels`: the points' classes, in the low 16 bits as in SemanticKITTI's files; empty for none (0).
  /// Throws std::invalid_argument when there are labels, but not as many as points.
  /// Linear in points and pixels; allocates only while buffers grow.
  void project(ScanPoints scan, const std::vector<std::uint32_t>& labels, Projection& out);

private:
  std::uint32_t rows_, columns_;
  std::vector<PointDirection> directions_;
  DirectionProjector projector_;
};
}  // namespace lidar_panoptic_clustering

// What the ids of a stream lie on: the part of LabelNumbering that looks at the points.
#include "lidar_panoptic_clustering/core/label_numbering.h"

#include <cmath>

namespace lidar_panoptic_clustering
{
namespace
{
constexpr std::uint64_t kShapeScans = 100;  // an id not seen for so long is not judged by its shape any more

constexpr double kFewPairs = 80.0, kManyPairs = 8000.0;
constexpr double kFlatShare = 0.85, kUprightShare = 0.5, kLongShare = 0.5, kGroundShare = 0.2;
constexpr std::uint32_t kColumnStep = 4, kRowStep = 4;
constexpr float kFlatSlope = 0.3F, kSteepSlope = 1.0F;
constexpr float kRunGap = 0.5F;  // [m]
}  // namespace

/// Neighbouring returns of one id above one another: on the ground one is farther away, on what stands it is higher.
void LabelNumbering::lookAtShapes(const LabelledCloud& image)
{
  for (std::uint32_t row = 0; row + 1 < image.height; ++row)
    for (std::uint32_t column = 0; column < image.width; column += kColumnStep)
    {
      const LabelledPoint &p = image.points[row * image.width + column],
                          &q = image.points[(row + 1) * image.width + column];
      if (p.label != q.label || !isReturn(p) || !isReturn(q)) continue;
      const float dot = p.x * q.x + p.y * q.y, cross = p.x * q.y - p.y * q.x;
      if (!(std::abs(cross) < 0.02F * dot)) continue;  // not above one another
      const float rise = std::abs(p.z - q.z), run = std::hypot(p.x - q.x, p.y - q.y);
      Seen& entry = seen(p.label);
      entry.pairs += 1.0;
      if (rise < kFlatSlope * run) entry.flat += 1.0, ground_pairs_ += 1.0;
      if (rise > kSteepSlope * run) entry.steep += 1.0;
    }
}

/// Unbroken runs of one id along a scan line.
void LabelNumbering::lookAlongLines(const LabelledCloud& image)
{
  for (std::uint32_t row = 0; row < image.height; row += kRowStep)
  {
    const LabelledPoint *first = nullptr, *last = nullptr;
    std::size_t points = 0;
    const auto end = [&]
    {
      if (first != nullptr)
        addRun(seen(first->label), std::hypot(last->x - first->x, last->y - first->y, last->z - first->z), points);
    };
    for (std::uint32_t column = 0; column < image.width; ++column)
    {
      const LabelledPoint& p = image.points[row * image.width + column];
      if (!isReturn(p)) continue;
      const auto gap = [&] { return std::hypot(p.x - last->x, p.y - last->y, p.z - last->z); };
      if (first == nullptr || p.label != first->label || gap() > kRunGap)
      {
        end();
        first = &p;
        points = 0;
      }
      last = &p;
      ++points;
    }
    end();
  }
}

void LabelNumbering::addRun(Seen& id, float length, std::size_t points) const
{
  id.run_points += static_cast<double>(points);
  for (std::size_t i = 0; i < kRunLengths.size(); ++i)
    if (length > kRunLengths[i]) id.long_run_points[i] += static_cast<double>(points);
}

/// So that a stream may change its mind.
void LabelNumbering::forgetHalf()
{
  for (Seen& id : seen_)
  {
    if (id.pairs > kManyPairs) id.flat /= 2.0, id.steep /= 2.0, id.pairs /= 2.0;
    if (id.run_points <= kManyPairs) continue;
    id.run_points /= 2.0;
    for (double& points : id.long_run_points) points /= 2.0;
  }
  ground_pairs_ = 0.0;
  for (const Seen& id : seen_) ground_pairs_ += id.flat;
}

LabelNumbering::Misfit LabelNumbering::misfit(const Seen& id, const Candidate& candidate) const
{
  const ClassIndex index = candidate.table->find(id.id);
  if (index == kUnknownClass || id.id == 0 || scan_ - id.scan > kShapeScans) return Misfit::kNone;
  const Expectation& expected = candidate.of_class[index];
  const bool flat = id.pairs >= kFewPairs && id.flat >= kFlatShare * id.pairs;
  if (flat && expected.shape == Shape::kStanding) return Misfit::kFlat;
  const bool no_class = id.id == (*candidate.table)[index].ids[0];
  if (flat && expected.shape == Shape::kNotGround && !no_class && id.flat > kGroundShare * ground_pairs_)
    return Misfit::kFlat;
  if (expected.shape == Shape::kFlat && id.pairs >= kFewPairs && id.steep >= kUprightShare * id.pairs)
    return Misfit::kUpright;
  if (expected.longest_run >= 0 && id.run_points >= kFewPairs)
    if (id.long_run_points[static_cast<std::size_t>(expected.longest_run)] >= kLongShare * id.run_points)
      return Misfit::kLong;
  return Misfit::kNone;
}
}  // namespace lidar_panoptic_clustering

#include "lidar_panoptic_clustering/labelling/scan_components.h"

#include <cmath>
#include <utility>

namespace lidar_panoptic_clustering
{
namespace
{
constexpr std::uint32_t kColumnReach = 8, kRowReach = 4;

/// How closely two returns hang together.
enum class Tie
{
  kNone,
  kLoose,  ///< within the link
  kTight   ///< within the step, or on one surface
};

Tie tieOf(const LabelledPoint& a, const LabelledPoint& b, float squared_step, float squared_link)
{
  const auto pa = a.getVector3fMap(), pb = b.getVector3fMap();
  const float squared = (pa - pb).squaredNorm();
  if (squared < squared_step) return Tie::kTight;
  constexpr float kSlant = 4.0F;  // the squared cosine of 60 degrees, inverted; |a x b| / |a| is across the beam
  if (squared * pa.squaredNorm() < kSlant * pa.cross(pb).squaredNorm()) return Tie::kTight;
  return squared < squared_link ? Tie::kLoose : Tie::kNone;
}

/// Whether elevation falls with the row; told by a few thousand returns.
bool isHighestFirst(const LabelledCloud& cloud, const std::vector<GroundedReturn>& returns)
{
  constexpr std::size_t kReturns = 4096;
  const std::size_t stride = returns.size() / kReturns | 1U;
  const auto middle = 0.5 * (cloud.height - 1.0);
  double fall = 0.0;
  for (std::size_t i = 0; i < returns.size(); i += stride)
    if (returns[i].isReturn())
      fall += (middle - static_cast<double>(i / cloud.width)) * double{cloud.points[i].z / returns[i].range};
  return fall >= 0.0;
}
}  // namespace

void ScanComponent::add(const ScanComponent& other)
{
  point_count += other.point_count;
  bottom = std::min(bottom, other.bottom), top = std::max(top, other.top);
  footprint.add(other.footprint);
  open_top |= other.open_top;
  blocked += other.blocked, undercut += other.undercut, hidden += other.hidden;
  triples += other.triples, rough_triples += other.rough_triples;
  ends += other.ends, free_ends += other.free_ends;
}

void ScanComponents::find(const LabelledCloud& cloud, const std::vector<GroundedReturn>& returns,
                          const Distances& distances, bool full_turn)
{
  link(cloud, returns, distances, full_turn);
  gatherParts(cloud, returns);
  joinParts();
  const bool highest_first = isHighestFirst(cloud, returns);
  examineTops(cloud, highest_first);
  examineFeet(cloud, returns, distances.above, highest_first);
  examineLines(cloud, returns);
  components_.assign(component_count_, {});
  for (std::uint32_t part = 0; part < parts_.size(); ++part) components_[component_of_part_[part]].add(parts_[part]);
}

/// Runs of neighbours along a line are one from the start; each pair of runs, one below the other, is tried until it
/// hangs together. `part_of_` holds a pixel's run until gatherParts().
void ScanComponents::link(const LabelledCloud& cloud, const std::vector<GroundedReturn>& returns,
                          const Distances& distances, bool full_turn)
{
  const std::uint32_t columns = cloud.width;
  const float squared_step = distances.step * distances.step, squared_link = distances.link * distances.link;
  sets_.reset(0);
  part_of_.resize(returns.size());
  pixels_.clear();
  loose_.clear();
  row_before_.assign(columns, kNone);
  const auto tie = [&](std::uint32_t a, std::uint32_t b)
  { return tieOf(cloud.points[a], cloud.points[b], squared_step, squared_link); };
  for (std::uint32_t row = 0; row < cloud.height; ++row)
  {
    const std::uint32_t begin = row * columns;
    std::uint32_t first = kNone, last = kNone, run = kNone, run_above = kNone, loose_above = kNone;
    for (std::uint32_t pixel = begin; pixel < begin + columns; ++pixel)
    {
      if (!(returns[pixel].height >= distances.above))  // no return too
      {
        part_of_[pixel] = kNone;
        continue;
      }
      pixels_.push_back(pixel);
      if (first == kNone) first = pixel;
      const Tie beside = last == kNone || pixel - last > kColumnReach ? Tie::kNone : tie(pixel, last);
      if (beside != Tie::kTight)
      {
        const std::uint32_t next = sets_.add();
        if (beside == Tie::kLoose) loose_.push_back({next, run});
        run = next, run_above = loose_above = kNone;
      }
      last = pixel;
      part_of_[pixel] = run;

      const std::uint32_t before = std::exchange(row_before_[pixel - begin], row);
      if (before == kNone || row - before > kRowReach) continue;
      const std::uint32_t over = before * columns + pixel - begin, over_run = part_of_[over];
      if (over_run == run_above) continue;
      const Tie above = tie(pixel, over);
      if (above == Tie::kTight)
      {
        run_above = over_run;
        sets_.unite(run, run_above);
      }
      else if (above == Tie::kLoose && over_run != loose_above)
      {
        loose_above = over_run;
        loose_.push_back({run, over_run});
      }
    }
    if (!full_turn || first == last || first + columns - last > kColumnReach) continue;
    const Tie around = tie(first, last);
    if (around == Tie::kTight) sets_.unite(part_of_[first], run);
    if (around == Tie::kLoose) loose_.push_back({part_of_[first], run});
  }
}

/// Numbers the parts and measures their size.
void ScanComponents::gatherParts(const LabelledCloud& cloud, const std::vector<GroundedReturn>& returns)
{
  sets_.flatten(part_of_run_);
  std::uint32_t part_count = 0;
  for (std::uint32_t run = 0; run < part_of_run_.size(); ++run)  // a set stands by its first run
    part_of_run_[run] = part_of_run_[run] == run ? part_count++ : part_of_run_[part_of_run_[run]];
  parts_.assign(part_count, {});
  for (const std::uint32_t pixel : pixels_)
  {
    part_of_[pixel] = part_of_run_[part_of_[pixel]];
    ScanComponent& c = parts_[part_of_[pixel]];
    ++c.point_count;
    c.bottom = std::min(c.bottom, returns[pixel].height), c.top = std::max(c.top, returns[pixel].height);
    c.footprint.add(cloud.points[pixel].x, cloud.points[pixel].y);
  }
}

/// Numbers the components.
void ScanComponents::joinParts()
{
  sets_.reset(parts_.size());
  for (const Pair& pair : loose_) sets_.unite(part_of_run_[pair.a], part_of_run_[pair.b]);
  component_count_ = 0;
  component_of_part_.resize(parts_.size());
  for (std::uint32_t part = 0; part < parts_.size(); ++part)
  {
    const std::uint32_t root = sets_.find(part);  // the smallest member
    component_of_part_[part] = root == part ? component_count_++ : component_of_part_[root];
  }
}

/// Of the sensor's highest beams, those that do not point down: a scan in which nothing is as high as the sensor does
/// not tell where they are.
void ScanComponents::examineTops(const LabelledCloud& cloud, bool highest_first)
{
  const std::uint32_t columns = cloud.width, begin = highest_first ? 0 : (cloud.height - 1) * columns;
  for (std::uint32_t pixel = begin; pixel < begin + columns && cloud.height > 0; ++pixel)
    if (part_of_[pixel] != kNone && cloud.points[pixel].z > 0.0F) parts_[part_of_[pixel]].open_top = true;
}

void ScanComponents::examineFeet(const LabelledCloud& cloud, const std::vector<GroundedReturn>& returns, float above,
                                 bool highest_first)
{
  constexpr float kUnder = 0.15F;  // [m] more than a wall's foot and range noise
  // [m] above the ground at the foot: from the noise of ground and ranges on; what is undercut is seen to be so
  constexpr float kFoot = 0.05F;
  const std::uint32_t columns = cloud.width;
  row_before_.assign(columns, kNone);  // the row of the last return
  for (std::uint32_t k = 0; k < cloud.height; ++k)
  {
    const std::uint32_t row = highest_first ? k : cloud.height - 1 - k;
    for (std::uint32_t column = 0; column < columns; ++column)
    {
      const std::uint32_t pixel = row * columns + column;
      if (!returns[pixel].isReturn()) continue;
      const std::uint32_t before = std::exchange(row_before_[column], row);
      if (before == kNone) continue;
      const std::uint32_t over = before * columns + column;
      if (part_of_[pixel] != kNone)
      {
        if (part_of_[over] != kNone && of(over) != of(pixel) && returns[pixel].range < returns[over].range - kUnder)
          ++parts_[part_of_[over]].hidden;
        continue;
      }
      if (part_of_[over] == kNone || (row > before ? row - before : before - row) > kRowReach) continue;
      ScanComponent& c = parts_[part_of_[over]];
      const bool is_first = returns[over].height >= above;  // not a foot itself
      const float beyond = returns[pixel].range - returns[over].range;
      const bool is_foot = std::abs(beyond) <= kUnder && returns[pixel].height > kFoot;
      if (is_foot) part_of_[pixel] = part_of_[over];
      if (!is_first) continue;
      c.undercut += beyond > kUnder ? 1U : 0U;
      c.blocked += is_foot ? 1U : 0U;
    }
  }
}

/// Along the scan lines: how rough a surface is, and whether it goes on where a part ends.
void ScanComponents::examineLines(const LabelledCloud& cloud, const std::vector<GroundedReturn>& returns)
{
  constexpr float kNoise = 0.04F;     // [m] twice the range noise of usual sensors
  constexpr float kBend = 0.75F;      // of the distance between neighbouring beams
  constexpr float kBehind = 0.3F;     // [m]
  constexpr std::uint32_t kNext = 3;  // columns in which what comes next is looked for
  const auto examineEnd = [&](std::uint32_t pixel, std::int32_t direction)
  {
    ScanComponent& c = parts_[part_of_[pixel]];
    ++c.ends;
    const auto column = static_cast<std::int32_t>(pixel % cloud.width);
    for (std::uint32_t k = 1; k <= kNext; ++k)
    {
      const std::int32_t next = column + direction * static_cast<std::int32_t>(k);
      if (next < 0 || next >= static_cast<std::int32_t>(cloud.width)) break;
      const GroundedReturn& other = returns[pixel - static_cast<std::uint32_t>(column - next)];
      if (!other.isReturn()) continue;
      c.free_ends += other.range > returns[pixel].range + kBehind ? 1U : 0U;
      return;
    }
    ++c.free_ends;
  };
  for (const std::uint32_t pixel : pixels_)
  {
    const std::uint32_t part = part_of_[pixel], column = pixel % cloud.width;
    if (column == 0 || part_of_[pixel - 1] != part) examineEnd(pixel, -1);
    if (column + 1 == cloud.width || part_of_[pixel + 1] != part) examineEnd(pixel, 1);
    const std::uint32_t component = component_of_part_[part];
    if (column < 2 || of(pixel - 1) != component || of(pixel - 2) != component) continue;
    const LabelledPoint &a = cloud.points[pixel - 1], &b = cloud.points[pixel];
    const float range = returns[pixel].range;
    const float spacing = std::abs(a.x * b.y - a.y * b.x);  // times range
    const float bend = range - 2.0F * returns[pixel - 1].range + returns[pixel - 2].range;
    ScanComponent& c = parts_[part];
    ++c.triples;
    c.rough_triples += (std::abs(bend) - kNoise) * range > kBend * spacing ? 1U : 0U;
  }
}
}  // namespace lidar_panoptic_clustering

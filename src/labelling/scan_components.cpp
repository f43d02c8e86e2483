#include "lidar_panoptic_clustering/labelling/scan_components.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace lidar_panoptic_clustering
{
namespace
{
constexpr std::uint32_t kColumnReach = 8, kRowReach = 4;

bool hangTogether(const LabelledPoint& a, const LabelledPoint& b, float squared_link)
{
  const auto pa = a.getVector3fMap(), pb = b.getVector3fMap();
  const float squared = (pa - pb).squaredNorm();
  if (squared < squared_link) return true;
  constexpr float kSlant = 4.0F;  // the squared cosine of 60 degrees, inverted; |a x b| / |a| is across the beam
  return squared * pa.squaredNorm() < kSlant * pa.cross(pb).squaredNorm();
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

void ScanComponents::find(const LabelledCloud& cloud, const std::vector<GroundedReturn>& returns, float above,
                          float link_distance, bool full_turn)
{
  link(cloud, returns, above, link_distance, full_turn);
  gather(cloud, returns);
  const bool highest_first = isHighestFirst(cloud, returns);
  examineTops(cloud, returns, highest_first);
  examineFeet(cloud, returns, highest_first);
  examineSurfaces(cloud, returns);
}

/// Runs of neighbours along a line are one from the start; each pair of runs, one below the other, is tried until it
/// hangs together. `component_of_` holds a run's first pixel until gather().
void ScanComponents::link(const LabelledCloud& cloud, const std::vector<GroundedReturn>& returns, float above,
                          float link_distance, bool full_turn)
{
  const std::uint32_t columns = cloud.width;
  const float squared_link = link_distance * link_distance;
  sets_.reset(returns.size());
  component_of_.assign(returns.size(), kNone);
  pixels_.clear();
  row_before_.assign(columns, kNone);
  const auto isPair = [&](std::uint32_t a, std::uint32_t b)
  { return hangTogether(cloud.points[a], cloud.points[b], squared_link); };
  for (std::uint32_t row = 0; row < cloud.height; ++row)
  {
    const std::uint32_t begin = row * columns;
    std::uint32_t first = kNone, last = kNone, run = kNone, run_above = kNone;
    for (std::uint32_t pixel = begin; pixel < begin + columns; ++pixel)
    {
      if (!(returns[pixel].height >= above)) continue;  // false for no return
      pixels_.push_back(pixel);
      if (first == kNone) first = pixel;
      if (last == kNone || pixel - last > kColumnReach || !isPair(pixel, last)) run = pixel, run_above = kNone;
      last = pixel;
      component_of_[pixel] = run;

      const std::uint32_t before = std::exchange(row_before_[pixel - begin], row);
      if (before == kNone || row - before > kRowReach) continue;
      const std::uint32_t over = before * columns + pixel - begin;
      if (component_of_[over] == run_above || !isPair(pixel, over)) continue;
      run_above = component_of_[over];
      sets_.unite(run, run_above);
    }
    if (full_turn && first != last && first + columns - last <= kColumnReach && isPair(first, last))
      sets_.unite(first, run);
  }
}

/// Numbers the components and measures their size.
void ScanComponents::gather(const LabelledCloud& cloud, const std::vector<GroundedReturn>& returns)
{
  components_.clear();
  for (const std::uint32_t pixel : pixels_)
  {
    const std::uint32_t root = sets_.find(component_of_[pixel]);
    if (root == pixel)  // the smallest member: the component's first
    {
      component_of_[pixel] = static_cast<std::uint32_t>(components_.size());
      components_.emplace_back();
      components_.back().bottom = components_.back().top = returns[pixel].height;
    }
    component_of_[pixel] = component_of_[root];
    ScanComponent& c = components_[component_of_[pixel]];
    ++c.point_count;
    c.bottom = std::min(c.bottom, returns[pixel].height), c.top = std::max(c.top, returns[pixel].height);
    c.footprint.add(cloud.points[pixel].x, cloud.points[pixel].y);
  }
}

void ScanComponents::examineTops(const LabelledCloud& cloud, const std::vector<GroundedReturn>& returns,
                                 bool highest_first)
{
  constexpr std::uint32_t kTopRows = 3;
  const std::uint32_t rows = std::min(kTopRows, cloud.height), columns = cloud.width;
  for (std::uint32_t column = 0; column < columns; ++column)
    for (std::uint32_t k = 0; k < rows; ++k)
    {
      const std::uint32_t pixel = (highest_first ? k : cloud.height - 1 - k) * columns + column;
      if (!returns[pixel].isReturn()) continue;
      if (component_of_[pixel] != kNone) components_[component_of_[pixel]].open_top = true;
      break;  // what lies below the highest return of a column ends there
    }
}

void ScanComponents::examineFeet(const LabelledCloud& cloud, const std::vector<GroundedReturn>& returns,
                                 bool highest_first)
{
  constexpr float kUnder = 0.15F;  // [m] more than a wall's foot and range noise
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
      if (component_of_[pixel] != kNone || before == kNone) continue;
      const std::uint32_t over = before * columns + column;
      if (component_of_[over] == kNone || (row > before ? row - before : before - row) > kRowReach) continue;
      ScanComponent& c = components_[component_of_[over]];
      ++c.feet;
      if (returns[pixel].range > returns[over].range + kUnder) ++c.undercut_feet;
    }
  }
}

void ScanComponents::examineSurfaces(const LabelledCloud& cloud, const std::vector<GroundedReturn>& returns)
{
  constexpr float kNoise = 0.04F;  // [m] twice the range noise of usual sensors
  constexpr float kBend = 0.75F;   // of the distance between neighbouring beams
  for (const std::uint32_t pixel : pixels_)
  {
    const std::uint32_t component = component_of_[pixel];
    if (pixel % cloud.width < 2 || component_of_[pixel - 1] != component || component_of_[pixel - 2] != component)
      continue;
    const LabelledPoint &a = cloud.points[pixel - 1], &b = cloud.points[pixel];
    const float range = returns[pixel].range;
    const float spacing = std::abs(a.x * b.y - a.y * b.x);  // times range
    const float bend = range - 2.0F * returns[pixel - 1].range + returns[pixel - 2].range;
    ScanComponent& c = components_[component];
    ++c.triples;
    c.rough_triples += (std::abs(bend) - kNoise) * range > kBend * spacing ? 1U : 0U;
  }
}
}  // namespace lidar_panoptic_clustering

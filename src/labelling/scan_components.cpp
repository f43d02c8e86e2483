#include "lidar_panoptic_clustering/labelling/scan_components.h"

#include <cmath>
#include <cstring>
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

float squaredNorm(float x, float y, float z)
{
  return x * x + (y * y + z * z);
}

inline Tie tieOf(const LabelledPoint& a, const LabelledPoint& b, float squared_step, float squared_link)
{
  const float squared = squaredNorm(a.x - b.x, a.y - b.y, a.z - b.z);
  if (squared < squared_step) return Tie::kTight;
  constexpr float kSlant = 4.0F;  // the squared cosine of 60 degrees, inverted; |a x b| / |a| is across the beam
  const float across = squaredNorm(a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x);
  if (squared * squaredNorm(a.x, a.y, a.z) < kSlant * across) return Tie::kTight;
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

void ScanComponents::start(std::uint32_t rows, std::uint32_t columns, const Distances& distances, bool full_turn)
{
  rows_ = rows, columns_ = columns, distances_ = distances, full_turn_ = full_turn;
  sets_.reset(0);
  part_of_.resize(std::size_t{rows} * columns);
  static_assert(kNone == 0xFFFFFFFF);  // in bytes: several times as fast
  if (!part_of_.empty()) std::memset(part_of_.data(), 0xFF, part_of_.size() * sizeof(part_of_[0]));
  pixels_.clear();
  begin_of_run_.clear();
  loose_.clear();
  pixel_before_.assign(columns, kNone);
  has_return_.assign(columns, 0);
}

void ScanComponents::finish(const LabelledCloud& cloud, const std::vector<GroundedReturn>& returns)
{
  begin_of_run_.push_back(static_cast<std::uint32_t>(pixels_.size()));
  numberParts();
  joinParts();
  const bool highest_first = isHighestFirst(cloud, returns);
  examineTops(cloud, highest_first);
  examineFeet(returns, highest_first);
  for (std::uint32_t run = 0; run < part_of_run_.size(); ++run) measureRun(cloud, returns, run);
  components_.clear();
  for (std::uint32_t part = 0; part < parts_.size(); ++part)
    if (component_of_part_[part] == components_.size())  // numbered by first part
      components_.push_back(parts_[part]);
    else
      components_[component_of_part_[part]].add(parts_[part]);
}

/// Runs of neighbours along a line are one from the start; each pair of runs, one below the other, is tried until it
/// hangs together. `part_of_` holds a pixel's run until numberParts().
class ScanComponents::RowLinker
{
public:
  RowLinker(ScanComponents& to, const LabelledCloud& cloud)
      : to_(to),
        points_(cloud.points.data()),
        columns_(to.columns_),
        squared_step_(to.distances_.step * to.distances_.step),
        squared_link_(to.distances_.link * to.distances_.link),
        run_of_(to.part_of_.data()),
        pixel_before_(to.pixel_before_.data())
  {
  }

  /// The next return of the row that is above the ground.
  void add(std::uint32_t pixel, std::uint32_t column)
  {
    const LabelledPoint& point = points_[pixel];
    const Tie beside = last_ == kNone || pixel - last_ > kColumnReach ? Tie::kNone : tie(point, points_[last_]);
    if (beside != Tie::kTight)
    {
      const std::uint32_t next = to_.sets_.add();
      to_.begin_of_run_.push_back(static_cast<std::uint32_t>(to_.pixels_.size()));
      if (beside == Tie::kLoose) to_.loose_.push_back({next, run_});
      run_ = next, run_above_ = loose_above_ = kNone;
    }
    to_.pixels_.push_back(pixel);
    if (first_ == kNone) first_ = pixel;
    last_ = pixel;
    run_of_[pixel] = run_;

    const std::uint32_t over = std::exchange(pixel_before_[column], pixel);
    if (over == kNone || pixel - over > kRowReach * columns_) return;
    const std::uint32_t over_run = run_of_[over];
    if (over_run == run_above_) return;
    const Tie above = tie(point, points_[over]);
    if (above == Tie::kTight)
    {
      run_above_ = over_run;
      to_.sets_.unite(run_, run_above_);
    }
    else if (above == Tie::kLoose && over_run != loose_above_)
    {
      loose_above_ = over_run;
      to_.loose_.push_back({run_, over_run});
    }
  }

  /// The row's ends are neighbours.
  void closeRow()
  {
    if (first_ == last_ || first_ + columns_ - last_ > kColumnReach) return;
    const Tie around = tie(points_[first_], points_[last_]);
    if (around == Tie::kTight) to_.sets_.unite(run_of_[first_], run_);
    if (around == Tie::kLoose) to_.loose_.push_back({run_of_[first_], run_});
  }

private:
  Tie tie(const LabelledPoint& a, const LabelledPoint& b) const { return tieOf(a, b, squared_step_, squared_link_); }

  ScanComponents& to_;
  const LabelledPoint* points_;
  std::uint32_t columns_;
  float squared_step_, squared_link_;
  std::uint32_t *run_of_, *pixel_before_;
  std::uint32_t first_ = kNone, last_ = kNone, run_ = kNone, run_above_ = kNone, loose_above_ = kNone;
};

void ScanComponents::addRow(std::uint32_t row, const LabelledCloud& cloud, const std::vector<GroundedReturn>& returns)
{
  RowLinker linker(*this, cloud);
  const std::uint32_t begin = row * columns_;
  const GroundedReturn* const at = returns.data() + begin;
  const float above = distances_.above;
  std::uint8_t* const has_return = has_return_.data();
  for (std::uint32_t column = 0; column < columns_; ++column)
    has_return[column] = static_cast<std::uint8_t>(has_return[column] | at[column].isReturn());
  for (std::uint32_t column = 0; column < columns_; ++column)
    if (at[column].height >= above) linker.add(begin + column, column);  // false for no return too
  if (full_turn_) linker.closeRow();
}

void ScanComponents::numberParts()
{
  sets_.flatten(part_of_run_);
  std::uint32_t part_count = 0;
  for (std::uint32_t run = 0; run < part_of_run_.size(); ++run)  // a set stands by its first run
  {
    part_of_run_[run] = part_of_run_[run] == run ? part_count++ : part_of_run_[part_of_run_[run]];
    for (std::uint32_t k = begin_of_run_[run]; k < begin_of_run_[run + 1]; ++k)
      part_of_[pixels_[k]] = part_of_run_[run];
  }
  parts_.assign(part_count, {});
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

void ScanComponents::examineFeet(const std::vector<GroundedReturn>& returns, bool highest_first)
{
  feet_.clear();
  for (const std::uint32_t pixel : pixels_) examineFoot(returns, pixel, highest_first);
}

/// What the next beams below a return of a part met, down its foot: `pixel` is above the ground.
void ScanComponents::examineFoot(const std::vector<GroundedReturn>& returns, std::uint32_t pixel, bool highest_first)
{
  constexpr float kUnder = 0.15F;  // [m] more than a wall's foot and range noise
  // [m] above the ground at the foot: from the noise of ground and ranges on; what is undercut is seen to be so
  constexpr float kFoot = 0.05F;
  const std::uint32_t part = part_of_[pixel], size = rows_ * columns_;
  const std::uint32_t step = highest_first ? columns_ : 0U - columns_;
  const auto isInside = [size](std::uint32_t at) { return at < size; };  // above row 0 it wraps to beyond the last
  bool is_first = true;
  for (std::uint32_t over = pixel;;)
  {
    std::uint32_t under = over + step, rows = 1;
    for (; isInside(under) && !returns[under].isReturn(); ++rows) under += step;
    if (!isInside(under) || part_of_[under] == part) return;
    const float beyond = returns[under].range - returns[over].range;
    ScanComponent& c = parts_[part];
    if (const std::uint32_t other = part_of_[under]; other != kNone)
    {
      c.hidden += component_of_part_[part] != component_of_part_[other] && beyond < -kUnder ? 1U : 0U;
      return;
    }
    if (rows > kRowReach) return;
    const bool is_foot = std::abs(beyond) <= kUnder && returns[under].height > kFoot;
    if (is_first)
    {
      c.undercut += beyond > kUnder ? 1U : 0U;
      c.blocked += is_foot ? 1U : 0U;
    }
    if (!is_foot) return;
    part_of_[under] = part;
    feet_.push_back(under);
    over = under, is_first = false;
  }
}

/// Adds a run to its part: its size, how rough its surface is, and whether it goes on where the part ends.
void ScanComponents::measureRun(const LabelledCloud& cloud, const std::vector<GroundedReturn>& returns,
                                std::uint32_t run)
{
  constexpr float kNoise = 0.04F;  // [m] twice the range noise of usual sensors
  constexpr float kBend = 0.75F;   // of the distance between neighbouring beams
  const std::uint32_t begin = begin_of_run_[run], end = begin_of_run_[run + 1];
  const std::uint32_t part = part_of_run_[run], component = component_of_part_[part];
  const std::uint32_t row_begin = pixels_[begin] / cloud.width * cloud.width;
  const std::uint32_t row_end = row_begin + cloud.width;
  ScanComponent& c = parts_[part];
  c.point_count += end - begin;
  float bottom = c.bottom, top = c.top;
  std::uint32_t triples = 0, rough_triples = 0;
  std::uint32_t in_a_row = 0;  // returns of the run, without a gap, before the one in hand
  for (std::uint32_t k = begin; k < end; ++k)
  {
    const std::uint32_t pixel = pixels_[k];
    const LabelledPoint& b = cloud.points[pixel];
    const GroundedReturn here = returns[pixel];
    bottom = std::min(bottom, here.height), top = std::max(top, here.height);
    c.footprint.add(b.x, b.y);
    if (in_a_row == 0 && (pixel == row_begin || part_of_[pixel - 1] != part)) examineEnd(cloud, returns, pixel, -1);
    const bool goes_on = k + 1 < end && pixels_[k + 1] == pixel + 1;
    if (!goes_on && (pixel + 1 == row_end || part_of_[pixel + 1] != part)) examineEnd(cloud, returns, pixel, 1);
    if (in_a_row >= 2 || (pixel >= row_begin + 2 && of(pixel - 1) == component && of(pixel - 2) == component))
    {
      const LabelledPoint& a = cloud.points[pixel - 1];
      const float spacing = std::abs(a.x * b.y - a.y * b.x);  // times range
      const float bend = here.range - 2.0F * returns[pixel - 1].range + returns[pixel - 2].range;
      ++triples;
      rough_triples += (std::abs(bend) - kNoise) * here.range > kBend * spacing ? 1U : 0U;
    }
    in_a_row = goes_on ? in_a_row + 1 : 0;
  }
  c.bottom = bottom, c.top = top;
  c.triples += triples, c.rough_triples += rough_triples;
}

/// A part ends with this pixel, unless it goes on beyond columns that have no return at all, as an image of more
/// columns than firings has now and then; it stands free where what comes next lies behind, or nothing does.
void ScanComponents::examineEnd(const LabelledCloud& cloud, const std::vector<GroundedReturn>& returns,
                                std::uint32_t pixel, std::int32_t direction)
{
  constexpr float kBehind = 0.3F;    // [m]
  constexpr std::int32_t kNext = 3;  // columns in which what comes next is looked for
  const std::uint32_t part = part_of_[pixel];
  ScanComponent& c = parts_[part];
  const auto column = static_cast<std::int32_t>(pixel % cloud.width), columns = static_cast<std::int32_t>(cloud.width);
  bool is_next = true;  // but for empty columns
  for (std::int32_t k = 1; k <= kNext; ++k)
  {
    const std::int32_t next = column + direction * k;
    if (next < 0 || next >= columns) break;
    const std::uint32_t beyond = pixel + static_cast<std::uint32_t>(direction * k);
    const GroundedReturn& other = returns[beyond];
    if (!other.isReturn())
    {
      is_next = is_next && has_return_[static_cast<std::size_t>(next)] == 0;
      continue;
    }
    if (is_next && part_of_[beyond] == part) return;
    ++c.ends;
    c.free_ends += other.range > returns[pixel].range + kBehind ? 1U : 0U;
    return;
  }
  ++c.ends, ++c.free_ends;
}
}  // namespace lidar_panoptic_clustering

#include "lidar_panoptic_clustering/labelling/scan_components.h"

#include <cmath>

namespace lidar_panoptic_clustering
{
namespace
{
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
/// How far the last of three neighbours in a line is from where the first two lead [m].
inline float bendOf(const GroundedReturn* last)
{
  return last[0].range - 2.0F * last[-1].range + last[-2].range;
}

/// Whether a return and the two before it in its line lie on no smooth surface, for all that the ranges' noise bends.
inline bool isRough(const LabelledPoint* last, const GroundedReturn* at, float noise)
{
  constexpr float kBend = 0.75F;  // of the distance between neighbouring beams
  const LabelledPoint &a = last[-1], &b = last[0];
  const float spacing = std::abs(a.x * b.y - a.y * b.x);  // times range
  return (std::abs(bendOf(at)) - noise) * at[0].range > kBend * spacing;
}
}  // namespace

void HeightRange::add(const HeightRange& other)
{
  point_count += other.point_count;
  bottom = std::min(bottom, other.bottom), top = std::max(top, other.top);
  open_top |= other.open_top;
}

void ScanComponent::addShape(const ScanComponent& other)
{
  footprint.add(other.footprint);
  blocked += other.blocked, undercut += other.undercut, hidden += other.hidden;
  triples += other.triples, rough_triples += other.rough_triples;
  ends += other.ends, free_ends += other.free_ends;
}

void ScanComponents::start(std::uint32_t rows, std::uint32_t columns, const Distances& distances, bool full_turn)
{
  rows_ = rows, columns_ = columns, distances_ = distances, full_turn_ = full_turn;
  sets_.reset(0);
  part_of_.resize(std::size_t{rows} * columns);
  pixels_.clear();
  begin_of_run_.clear();
  loose_.clear();
  pixel_before_.assign(columns, kNoPixel);
  has_return_.assign(columns, 0);
}

void ScanComponents::finish(const LabelledCloud& cloud, const std::vector<GroundedReturn>& returns,
                            const std::function<bool(const HeightRange&)>& is_apart)
{
  begin_of_run_.push_back(static_cast<std::uint32_t>(pixels_.size()));
  numberParts(returns);
  joinParts();
  down_ = isHighestFirst(cloud, returns) ? columns_ : 0U - columns_;
  examineTops(cloud);
  setApart(is_apart);
  examineFeet(returns);
  measureNoise(returns);
  for (std::uint32_t run = 0; run < part_of_run_.size(); ++run) measureRun(cloud, returns, run);
  for (const std::uint32_t part : parts_apart_)
    described_[component_of_part_[part]].addShape(described_[description_of_part_[part]]);
}

/// Numbers the parts and measures their heights.
void ScanComponents::numberParts(const std::vector<GroundedReturn>& returns)
{
  sets_.flatten(part_of_run_);
  heights_.clear();
  for (std::uint32_t run = 0; run < part_of_run_.size(); ++run)  // a set stands by its first run
  {
    const bool is_first = part_of_run_[run] == run;
    const std::uint32_t part = is_first ? partCount() : part_of_run_[part_of_run_[run]];
    if (is_first) heights_.emplace_back();
    part_of_run_[run] = part;
    HeightRange here;
    here.point_count = begin_of_run_[run + 1] - begin_of_run_[run];
    for (std::uint32_t k = begin_of_run_[run]; k < begin_of_run_[run + 1]; ++k)
    {
      here.widen(returns[pixels_[k]].height);
      part_of_[pixels_[k]] = part;
    }
    heights_[part].add(here);
  }
}

/// Begins the descriptions, with the heights.
void ScanComponents::setApart(const std::function<bool(const HeightRange&)>& is_apart)
{
  described_.assign(component_count_, {});
  description_of_part_ = component_of_part_;
  parts_apart_.clear();
  for (std::uint32_t part = 0; part < partCount(); ++part)
  {
    described_[component_of_part_[part]].HeightRange::add(heights_[part]);
    if (is_apart(heights_[part])) describeApart(part);
  }
}

void ScanComponents::describeApart(std::uint32_t part)
{
  description_of_part_[part] = static_cast<std::uint32_t>(described_.size());
  parts_apart_.push_back(part);
  described_.emplace_back();
  described_.back().HeightRange::add(heights_[part]);
}

/// Numbers the components.
void ScanComponents::joinParts()
{
  sets_.reset(heights_.size());
  for (const Pair& pair : loose_) sets_.unite(part_of_run_[pair.a], part_of_run_[pair.b]);
  component_count_ = 0;
  component_of_part_.resize(heights_.size());
  for (std::uint32_t part = 0; part < partCount(); ++part)
  {
    const std::uint32_t root = sets_.find(part);  // the smallest member
    component_of_part_[part] = root == part ? component_count_++ : component_of_part_[root];
  }
}

/// What noise bends smooth surfaces by, told by the ground: lidars differ, and where their beams are close to each
/// other noise alone bends three returns by more than these lie apart.
void ScanComponents::measureNoise(const std::vector<GroundedReturn>& returns)
{
  constexpr float kLeast = 0.04F;       // [m] grass and gravel
  constexpr float kDeviations = 1.5F;   // of a bend's noise, that a smooth surface is hardly ever beyond
  constexpr float kOfMedian = 1.4826F;  // a normal distribution's standard deviation
  constexpr std::size_t kTriples = 4096, kFewest = 100;
  const auto isGround = [&](std::size_t i) { return returns[i].height < distances_.above; };  // false for no return
  bends_.clear();
  const std::size_t stride = returns.size() / kTriples | 1U;
  bends_.reserve(returns.size() / stride + 1);
  for (std::size_t i = stride + 1; i < returns.size(); i += stride)
    if (i % columns_ >= 2 && isGround(i) && isGround(i - 1) && isGround(i - 2))
      bends_.push_back(std::abs(bendOf(&returns[i])));
  bend_noise_ = kLeast;
  if (bends_.size() < kFewest) return;
  const auto middle = bends_.begin() + static_cast<std::ptrdiff_t>(bends_.size() / 2);
  std::nth_element(bends_.begin(), middle, bends_.end());
  bend_noise_ = std::max(kLeast, kDeviations * kOfMedian * *middle);
}

/// Of the sensor's highest beams, those that do not point down: a scan in which nothing is as high as the sensor does
/// not tell where they are.
void ScanComponents::examineTops(const LabelledCloud& cloud)
{
  const std::uint32_t columns = cloud.width, begin = down_ == columns_ ? 0 : (cloud.height - 1) * columns;
  for (std::uint32_t pixel = begin; pixel < begin + columns && cloud.height > 0; ++pixel)
    if (part_of_[pixel] != kNone && cloud.points[pixel].z > 0.0F) heights_[part_of_[pixel]].open_top = true;
}

void ScanComponents::examineFeet(const std::vector<GroundedReturn>& returns)
{
  feet_.clear();
  const std::uint32_t step = down_, size = rows_ * columns_;
  const std::uint32_t* const part_of = part_of_.data();
  for (const std::uint32_t pixel : pixels_)
  {
    const std::uint32_t under = pixel + step;                         // above row 0 it wraps to beyond the last
    if (under >= size || part_of[under] == part_of[pixel]) continue;  // as most are
    examineFoot(returns, pixel);
  }
}

/// What the next beams below a return of a part met, down its foot: `pixel` is above the ground.
void ScanComponents::examineFoot(const std::vector<GroundedReturn>& returns, std::uint32_t pixel)
{
  constexpr float kUnder = 0.15F;  // [m] more than a wall's foot and range noise
  // [m] above the ground at the foot: from the noise of ground and ranges on; what is undercut is seen to be so
  constexpr float kFoot = 0.05F;
  const std::uint32_t part = part_of_[pixel], size = rows_ * columns_;
  const std::uint32_t step = down_;
  const auto isInside = [size](std::uint32_t at) { return at < size; };  // above row 0 it wraps to beyond the last
  bool is_first = true, is_through = false, is_face = true;
  for (std::uint32_t over = pixel, under = pixel, rows = 0;;)
  {
    do under += step, ++rows;
    while (isInside(under) && !returns[under].isReturn());
    if (!isInside(under) || part_of_[under] == part) return;
    const float beyond = returns[under].range - returns[over].range;
    ScanComponent& c = described_[description_of_part_[part]];
    if (const std::uint32_t other = part_of_[under]; other != kNone)
    {
      const bool is_before = component_of_part_[part] != component_of_part_[other] && beyond < -kUnder;
      c.hidden += !is_through && is_before ? 1U : 0U;
      return;
    }
    if (rows > kRowReach) return;
    const bool is_as_far = std::abs(beyond) <= kUnder, is_above = returns[under].height > kFoot;
    if (is_first)
    {
      c.undercut += beyond > kUnder ? 1U : 0U;
      c.blocked += is_as_far && is_above ? 1U : 0U;
    }
    is_first = false, is_through |= beyond > kUnder, is_face &= beyond <= kUnder;
    if (beyond > kUnder) continue;
    // down to the ground, which comes nearer from beam to beam by far more than it falls
    is_face = is_face && returns[over].height - returns[under].height > -beyond;
    if (!is_as_far || !(is_above || is_face)) return;
    part_of_[under] = part;
    feet_.push_back(under);
    over = under, rows = 0, is_face = true;
  }
}

/// Adds a run to what its part is described by: its extent, how rough its surface is, and whether it goes on where the
/// part ends.
void ScanComponents::measureRun(const LabelledCloud& cloud, const std::vector<GroundedReturn>& returns,
                                std::uint32_t run)
{
  const std::uint32_t begin = begin_of_run_[run], end = begin_of_run_[run + 1];
  for (std::uint32_t k = begin; k < end;)
  {
    const std::uint32_t first = pixels_[k];
    std::uint32_t length = 1;
    while (k + length < end && pixels_[k + length] == first + length) ++length;
    measurePiece(cloud, returns, first, length);
    k += length;
  }
}

/// Adds pixels side by side.
void ScanComponents::measurePiece(const LabelledCloud& cloud, const std::vector<GroundedReturn>& returns,
                                  std::uint32_t first, std::uint32_t length)
{
  const std::uint32_t part = part_of_[first], component = component_of_part_[part], end = first + length;
  const std::uint32_t row_begin = first / cloud.width * cloud.width, row_end = row_begin + cloud.width;
  ScanComponent& c = described_[description_of_part_[part]];
  const LabelledPoint* const points = cloud.points.data();
  const GroundedReturn* const at = returns.data();
  for (std::uint32_t pixel = first; pixel < end; ++pixel) c.footprint.add(points[pixel].x, points[pixel].y);

  if (first == row_begin || part_of_[first - 1] != part) examineEnd(cloud, returns, first, -1);
  if (end == row_end || part_of_[end] != part) examineEnd(cloud, returns, end - 1, 1);
  const auto isInside = [&](std::uint32_t back) { return first >= row_begin + back && of(first - back) == component; };
  const bool one_before = isInside(1), two_before = one_before && isInside(2);
  // of a triple the last
  const std::uint32_t from = first + (two_before ? 0 : one_before ? 1 : 2);
  if (from >= end) return;
  c.triples += end - from;
  for (std::uint32_t pixel = from; pixel < end; ++pixel)
    c.rough_triples += isRough(&points[pixel], &at[pixel], bend_noise_) ? 1U : 0U;
}

/// A part ends with this pixel, unless it goes on beyond columns that have no return at all, as an image of more
/// columns than firings has now and then; it stands free where what comes next lies behind, or nothing does.
void ScanComponents::examineEnd(const LabelledCloud& cloud, const std::vector<GroundedReturn>& returns,
                                std::uint32_t pixel, std::int32_t direction)
{
  constexpr float kBehind = 0.3F;    // [m]
  constexpr std::int32_t kNext = 3;  // columns in which what comes next is looked for
  const std::uint32_t part = part_of_[pixel];
  ScanComponent& c = described_[description_of_part_[part]];
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

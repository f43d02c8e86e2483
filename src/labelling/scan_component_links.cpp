// How ScanComponents ties the returns of a row to each other and to those above.
#include "four_floats.h"

#include "lidar_panoptic_clustering/labelling/scan_components.h"

#include <cstring>

namespace lidar_panoptic_clustering
{
namespace
{
/// How closely four returns hang together with four others, as bits.
struct Ties
{
  std::uint32_t tight;  ///< within the step, or on one surface
  std::uint32_t loose;  ///< within the link, and not tight
};

FourFloats squaredNorms(const FourFloats& x, const FourFloats& y, const FourFloats& z)
{
  return x * x + (y * y + z * z);
}

/// Without branches: no predictor knows which returns lie apart.
inline Ties tiesOf(const FourPoints& a, const FourPoints& b, float squared_step, float squared_link)
{
  const FourFloats squared = squaredNorms(a.x - b.x, a.y - b.y, a.z - b.z);
  constexpr float kSlant = 4.0F;  // the squared cosine of 60 degrees, inverted; |a x b| / |a| is across the beam
  const FourFloats across = squaredNorms(a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x);
  const FourFloats range = squaredNorms(a.x, a.y, a.z), seen = squared * range;
  const FourInts is_surface = seen < kSlant * across;
  const FourInts tight = (squared < squared_step) | (is_surface & (seen - across < squared_step * range));
  return {bitsOf(tight), bitsOf(((squared < squared_link) | is_surface) & ~tight)};
}
}  // namespace

/// Runs of neighbours along a line are one from the start; each pair of runs, one below the other, is tried until it
/// hangs together. `part_of_` holds a pixel's run until numberParts().
class ScanComponents::RowLinker
{
public:
  RowLinker(ScanComponents& to, const LabelledCloud& cloud, std::uint32_t row_begin)
      : to_(to),
        points_(cloud.points.data()),
        row_begin_(row_begin),
        squared_step_(to.distances_.step * to.distances_.step),
        squared_link_(to.distances_.link * to.distances_.link),
        run_of_(to.part_of_.data())
  {
  }

  /// The returns of the row that are above the ground.
  void link(const std::uint32_t* pixels, std::uint32_t count, std::uint32_t place)
  {
    std::uint32_t k = 0;
    for (; k + 4 <= count; k += 4) linkFour(pixels + k, 4, place + k);
    if (k == count) return;
    std::uint32_t rest[4];
    for (std::uint32_t i = 0; i < 4; ++i) rest[i] = pixels[k + i < count ? k + i : count - 1];
    linkFour(rest, count - k, place + k);
  }

  /// The row's ends are neighbours.
  void closeRow(std::uint32_t first, std::uint32_t last)
  {
    if (first == last || first + to_.columns_ - last > kColumnReach) return;
    const LabelledPoint &a = points_[first], &b = points_[last];
    const Ties around = tiesOf({a, a, a, a}, {b, b, b, b}, squared_step_, squared_link_);
    if (around.tight != 0) to_.sets_.unite(run_of_[first], run_);
    if (around.loose != 0) to_.loose_.push_back({run_of_[first], run_});
  }

private:
  /// `count` of four pixels, the first of them at `place` in the list.
  void linkFour(const std::uint32_t* pixels, std::uint32_t count, std::uint32_t place)
  {
    std::uint32_t over[4], are_over = 0;
    const std::uint32_t reach = kRowReach * to_.columns_;
    for (std::uint32_t i = 0; i < 4; ++i)
    {
      std::uint32_t& before = to_.pixel_before_[pixels[i] - row_begin_];
      const bool is_near = pixels[i] - before <= reach;
      over[i] = is_near ? before : pixels[i];
      are_over |= static_cast<std::uint32_t>(is_near) << i;
    }
    for (std::uint32_t i = 0; i < count; ++i) to_.pixel_before_[pixels[i] - row_begin_] = pixels[i];
    const auto at = [&](std::uint32_t pixel) -> const LabelledPoint& { return points_[pixel]; };
    const FourPoints here(at(pixels[0]), at(pixels[1]), at(pixels[2]), at(pixels[3]));
    const Ties beside =
        tiesOf(here, {at(last_ == kNone ? pixels[0] : last_), at(pixels[0]), at(pixels[1]), at(pixels[2])},
               squared_step_, squared_link_);
    const Ties above = are_over == 0 ? Ties{0, 0}
                                     : tiesOf(here, {at(over[0]), at(over[1]), at(over[2]), at(over[3])}, squared_step_,
                                              squared_link_);
    for (std::uint32_t i = 0; i < count; ++i)
    {
      const bool reaches = last_ != kNone && pixels[i] - last_ <= kColumnReach;
      if (!reaches || (beside.tight >> i & 1U) == 0) startRun(place + i, reaches && (beside.loose >> i & 1U) != 0);
      last_ = pixels[i];
      run_of_[last_] = run_;
      if ((are_over >> i & 1U) != 0) tieTo(run_of_[over[i]], above.tight >> i & 1U, above.loose >> i & 1U);
    }
  }

  void startRun(std::uint32_t place, bool is_loose)
  {
    const std::uint32_t next = to_.sets_.add();
    to_.begin_of_run_.push_back(place);
    if (is_loose) to_.loose_.push_back({next, run_});
    run_ = next, run_above_ = loose_above_ = kNone;
  }

  void tieTo(std::uint32_t over_run, std::uint32_t is_tight, std::uint32_t is_loose)
  {
    if (over_run == run_above_) return;
    if (is_tight != 0)
    {
      run_above_ = over_run;
      to_.sets_.unite(run_, over_run);
    }
    else if (is_loose != 0 && over_run != loose_above_)
    {
      loose_above_ = over_run;
      to_.loose_.push_back({run_, over_run});
    }
  }

  ScanComponents& to_;
  const LabelledPoint* points_;
  std::uint32_t row_begin_;
  float squared_step_, squared_link_;
  std::uint32_t* run_of_;
  std::uint32_t last_ = kNone, run_ = kNone, run_above_ = kNone, loose_above_ = kNone;
};

void ScanComponents::addRow(std::uint32_t row, const LabelledCloud& cloud, const std::vector<GroundedReturn>& returns)
{
  const std::uint32_t begin = row * columns_;
  static_assert(kNone == 0xFFFFFFFF);  // in bytes: several times as fast
  if (columns_ > 0) std::memset(&part_of_[begin], 0xFF, columns_ * sizeof(part_of_[0]));
  row_pixels_.resize(columns_ + 1);
  const std::size_t count = gatherRow(returns.data() + begin, begin, row_pixels_.data());
  if (count == 0) return;
  RowLinker linker(*this, cloud, begin);
  linker.link(row_pixels_.data(), static_cast<std::uint32_t>(count), static_cast<std::uint32_t>(pixels_.size()));
  if (full_turn_) linker.closeRow(row_pixels_[0], row_pixels_[count - 1]);
  pixels_.insert(pixels_.end(), row_pixels_.begin(), row_pixels_.begin() + static_cast<std::ptrdiff_t>(count));
}

/// Writes the pixels of the returns of a row that are above the ground; returns how many. `to` has a place more than
/// there are columns.
std::size_t ScanComponents::gatherRow(const GroundedReturn* row, std::uint32_t begin, std::uint32_t* to)
{
  const std::uint32_t* const start = to;
  const float above = distances_.above;
  const auto take = [&](std::uint32_t column, bool is_above)
  {
    *to = begin + column;
    to += is_above ? 1 : 0;
  };
  std::uint32_t column = 0;
  for (; column + 4 <= columns_; column += 4)
  {
    const float* const values = &row[column].range;
    const FourFloats front = loadFour(values), back = loadFour(values + 4);
    const FourFloats range = {front[0], front[2], back[0], back[2]}, height = {front[1], front[3], back[1], back[3]};
    FourInts has_return = range > 0.0F, before;
    std::memcpy(&before, &has_return_[column], sizeof(before));
    has_return |= before;
    std::memcpy(&has_return_[column], &has_return, sizeof(before));
    const std::uint32_t bits = bitsOf(height >= above);  // false for no return too
    if (bits == 0) continue;
    for (std::uint32_t k = 0; k < 4; ++k) take(column + k, (bits >> k & 1U) != 0);
  }
  for (; column < columns_; ++column)
  {
    has_return_[column] |= row[column].isReturn() ? -1 : 0;
    take(column, row[column].height >= above);
  }
  return static_cast<std::size_t>(to - start);
}
}  // namespace lidar_panoptic_clustering

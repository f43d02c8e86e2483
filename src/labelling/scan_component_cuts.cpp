// How ScanComponents parts people from what they lean on.
#include "lidar_panoptic_clustering/labelling/scan_components.h"

#include <algorithm>

namespace lidar_panoptic_clustering
{
namespace
{
constexpr std::uint32_t kLastRun = ScanComponents::kNone - 1;
}  // namespace

void ScanComponents::cutColumns(const LabelledCloud& cloud, const std::vector<GroundedReturn>& returns,
                                const std::vector<std::uint32_t>& parts)
{
  if (parts.empty()) return;
  first_run_.assign(partCount(), kNone);
  for (const std::uint32_t part : parts) first_run_[part] = kLastRun;
  next_run_.resize(part_of_run_.size());
  for (auto run = static_cast<std::uint32_t>(part_of_run_.size()); run-- > 0;)
  {
    std::uint32_t& first = first_run_[part_of_run_[run]];
    if (first == kNone) continue;
    next_run_[run] = first;
    first = run;
  }
  for (const std::uint32_t part : parts) cutPart(cloud, returns, part);
}

void ScanComponents::cutPart(const LabelledCloud& cloud, const std::vector<GroundedReturn>& returns, std::uint32_t part)
{
  profile_.start(columns_, pixels_[begin_of_run_[first_run_[part]]] % columns_);
  for (std::uint32_t run = first_run_[part]; run != kLastRun; run = next_run_[run])
  {
    const std::uint32_t begin = begin_of_run_[run], row_begin = pixels_[begin] / columns_ * columns_;
    for (std::uint32_t k = begin; k < begin_of_run_[run + 1]; ++k)
      profile_.add(pixels_[k] - row_begin, returns[pixels_[k]].height);
  }
  for (const ColumnProfile::Columns& columns : profile_.find())
  {
    gatherCut(part, columns);
    if (isFreeAbove(returns)) addCut(cloud, returns, part);
  }
}

/// The pixels of a part in some columns, in row-major order.
void ScanComponents::gatherCut(std::uint32_t part, const ColumnProfile::Columns& columns)
{
  cut_.clear();
  for (std::uint32_t run = first_run_[part]; run != kLastRun; run = next_run_[run])
  {
    const std::uint32_t begin = begin_of_run_[run], row_begin = pixels_[begin] / columns_ * columns_;
    for (std::uint32_t k = begin; k < begin_of_run_[run + 1]; ++k)
      if (columns.holds(pixels_[k] - row_begin, columns_)) cut_.push_back(pixels_[k]);
  }
}

/// Whether above most of the columns of a cut the beams go farther.
bool ScanComponents::isFreeAbove(const std::vector<GroundedReturn>& returns) const
{
  constexpr float kBehind = 0.3F;  // [m]
  const std::uint32_t step = highest_first_ ? 0U - columns_ : columns_, size = rows_ * columns_;
  std::uint32_t free = 0, blocked = 0;
  for (const std::uint32_t pixel : cut_)
  {
    std::uint32_t over = pixel + step, rows = 1;
    for (; over < size && rows <= kRowReach && !returns[over].isReturn(); ++rows) over += step;
    if (over < size && part_of_[over] == part_of_[pixel]) continue;
    const bool is_free = over >= size || rows > kRowReach || returns[over].range > returns[pixel].range + kBehind;
    ++(is_free ? free : blocked);
  }
  return free >= blocked;
}

/// Makes a part of pixels of another one, with what of its feet lies below them.
void ScanComponents::addCut(const LabelledCloud& cloud, const std::vector<GroundedReturn>& returns, std::uint32_t from)
{
  const auto part = partCount();
  const std::uint32_t step = highest_first_ ? columns_ : 0U - columns_, size = rows_ * columns_;
  HeightRange height;
  height.point_count = static_cast<std::uint32_t>(cut_.size());
  for (const std::uint32_t pixel : cut_)
    height.bottom = std::min(height.bottom, returns[pixel].height),
    height.top = std::max(height.top, returns[pixel].height);
  heights_.push_back(height);
  component_of_part_.push_back(component_of_part_[from]);
  description_of_part_.push_back(kNone);
  describeApart(part);
  for (const std::uint32_t pixel : cut_) part_of_[pixel] = part;
  for (const std::uint32_t pixel : cut_)
  {
    std::uint32_t under = pixel + step;
    if (under < size && part_of_[under] == kNone) examineFoot(returns, pixel, highest_first_);
    for (; under < size && part_of_[under] == from; under += step) part_of_[under] = part;
  }
  component_of_part_[part] = kNone - 1;
  for (std::size_t k = 0; k < cut_.size();)
  {
    std::uint32_t length = 1;
    const std::uint32_t first = cut_[k], row_end = (first / columns_ + 1) * columns_;
    while (k + length < cut_.size() && cut_[k + length] == first + length && first + length < row_end) ++length;
    measurePiece(cloud, returns, first, length);
    k += length;
  }
  component_of_part_[part] = component_of_part_[from];
}
}  // namespace lidar_panoptic_clustering

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
  const std::uint32_t count = profile_.find();
  if (count == 0) return;
  gatherCuts(part, count);
  for (std::uint32_t cut = 0; cut < count; ++cut)
    if (isFreeAbove(returns, cuts_[cut])) addCut(cloud, returns, part, cuts_[cut]);
}

/// The pixels of a part's cuts, in row-major order.
void ScanComponents::gatherCuts(std::uint32_t part, std::uint32_t count)
{
  if (cuts_.size() < count) cuts_.resize(count);
  for (std::uint32_t cut = 0; cut < count; ++cut) cuts_[cut].clear();
  for (std::uint32_t run = first_run_[part]; run != kLastRun; run = next_run_[run])
  {
    const std::uint32_t begin = begin_of_run_[run], row_begin = pixels_[begin] / columns_ * columns_;
    for (std::uint32_t k = begin; k < begin_of_run_[run + 1]; ++k)
      if (const std::uint32_t cut = profile_.cutOf(pixels_[k] - row_begin); cut != ColumnProfile::kNone)
        cuts_[cut].push_back(pixels_[k]);
  }
}

/// Whether above most of the columns of a cut the beams go farther.
bool ScanComponents::isFreeAbove(const std::vector<GroundedReturn>& returns,
                                 const std::vector<std::uint32_t>& cut) const
{
  constexpr float kBehind = 0.3F;  // [m]
  const std::uint32_t step = 0U - down_, size = rows_ * columns_;
  std::uint32_t free = 0, blocked = 0;
  for (const std::uint32_t pixel : cut)
  {
    std::uint32_t over = pixel + step, rows = 1;
    for (; over < size && rows <= kRowReach && !returns[over].isReturn(); ++rows) over += step;
    if (over < size && part_of_[over] == part_of_[pixel]) continue;
    const bool is_free = over >= size || rows > kRowReach || returns[over].range > returns[pixel].range + kBehind;
    ++(is_free ? free : blocked);
  }
  return free >= blocked;
}

/// Makes a part of some pixels of another one.
void ScanComponents::addCut(const LabelledCloud& cloud, const std::vector<GroundedReturn>& returns, std::uint32_t from,
                            const std::vector<std::uint32_t>& cut)
{
  const std::uint32_t part = partCount();
  heights_.emplace_back();
  heights_[part].point_count = static_cast<std::uint32_t>(cut.size());
  for (const std::uint32_t pixel : cut) heights_[part].widen(returns[pixel].height);
  component_of_part_.push_back(component_of_part_[from]);
  description_of_part_.push_back(kNone);
  describeApart(part);
  for (const std::uint32_t pixel : cut) part_of_[pixel] = part;
  takeFeet(returns, from, cut);
  component_of_part_[part] = kNone - 1;  // nobody's: the edge to what is left is not its surface's roughness
  for (std::size_t k = 0; k < cut.size();)
  {
    std::uint32_t length = 1;
    const std::uint32_t first = cut[k], row_end = (first / columns_ + 1) * columns_;
    while (k + length < cut.size() && cut[k + length] == first + length && first + length < row_end) ++length;
    measurePiece(cloud, returns, first, length);
    k += length;
  }
  component_of_part_[part] = component_of_part_[from];
}

/// What of the feet of the part that pixels were cut from lies below them comes with them; elsewhere beams may have
/// come by underneath.
void ScanComponents::takeFeet(const std::vector<GroundedReturn>& returns, std::uint32_t from,
                              const std::vector<std::uint32_t>& cut)
{
  const std::uint32_t step = down_, size = rows_ * columns_;
  for (const std::uint32_t pixel : cut)
  {
    std::uint32_t under = pixel + step;  // above row 0 it wraps to beyond the last
    if (under < size && part_of_[under] == kNone) examineFoot(returns, pixel);
    for (; under < size && part_of_[under] == from; under += step) part_of_[under] = part_of_[pixel];
  }
}
}  // namespace lidar_panoptic_clustering

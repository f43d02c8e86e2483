#include "lidar_panoptic_clustering/evaluation/object_recall.h"

#include "core/plain_numbers.h"

#include <cstdio>

namespace lidar_panoptic_clustering
{
namespace
{
void appendCounts(const std::string& name, const RecallCounts& c, std::string& out)
{
  if (c.objects == 0) return;
  const double percent = 100.0 / static_cast<double>(c.objects);
  appendText(out, "%-16.40s %7llu %6.1f %6.1f %6llu %7llu %6llu %6llu\n", name.c_str(),
             static_cast<unsigned long long>(c.objects), percent * static_cast<double>(c.iou_50),
             percent * static_cast<double>(c.iou_70), static_cast<unsigned long long>(c.lost),
             static_cast<unsigned long long>(c.merged), static_cast<unsigned long long>(c.split),
             static_cast<unsigned long long>(c.cut));
}
}  // namespace

std::string formatObjectRecall(const ObjectRecall& recall)
{
  std::string out;
  appendText(out, "[%%, objects]     objects    R50    R70   lost  merged  split    cut\n");
  appendCounts("all", recall.all(), out);
  for (const auto& [name, counts] : recall.byClass()) appendCounts(name, counts, out);
  float begin = 0.0F;
  for (std::size_t bin = 0; bin < recall.byRange().size(); ++bin)
  {
    const float end = recall.config().range_ends_m[bin];
    std::string name;
    appendText(name, "%.0f to %.0f m", static_cast<double>(begin), static_cast<double>(end));
    appendCounts(name, recall.byRange()[bin], out);
    begin = end;
  }
  const double scans = recall.scanCount() == 0 ? 1.0 : static_cast<double>(recall.scanCount());
  appendText(out, "\nFalse segments of %u points or more: %.1f a scan, with %.0f points\n", recall.config().min_points,
             static_cast<double>(recall.falseSegments()) / scans, static_cast<double>(recall.falsePoints()) / scans);
  appendText(out, "Ground: precision %.1f, recall %.1f, IoU %.1f\n", 100 * recall.ground().precision(),
             100 * recall.ground().recall(), 100 * recall.ground().iou());
  appendText(out, "Entropy a scan: over-segmentation %.2f, under-segmentation %.2f\n",
             recall.overSegmentation() / scans, recall.underSegmentation() / scans);
  if (recall.shownTwice() > 0)
    appendText(out, "Flips: %llu of %llu objects shown by two scans in a row were found in one alone (%.1f %%)\n",
               static_cast<unsigned long long>(recall.flips()), static_cast<unsigned long long>(recall.shownTwice()),
               100.0 * static_cast<double>(recall.flips()) / static_cast<double>(recall.shownTwice()));
  appendText(out, "Scans evaluated: %llu\n", static_cast<unsigned long long>(recall.scanCount()));
  return out;
}
}  // namespace lidar_panoptic_clustering

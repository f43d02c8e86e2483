#include "lidar_panoptic_clustering/evaluation/object_recall.h"

#include <cstdarg>
#include <cstdio>

namespace lidar_panoptic_clustering
{
namespace
{
__attribute__((format(printf, 2, 3))) void append(std::string& out, const char* format, ...)
{
  char line[256];
  va_list arguments;
  va_start(arguments, format);
  std::vsnprintf(line, sizeof line, format, arguments);
  va_end(arguments);
  out += line;
}

void appendCounts(const std::string& name, const RecallCounts& c, std::string& out)
{
  if (c.objects == 0) return;
  const double percent = 100.0 / static_cast<double>(c.objects);
  append(out, "%-16.40s %7llu %6.1f %6.1f %6llu %7llu %6llu %6llu\n", name.c_str(),
         static_cast<unsigned long long>(c.objects), percent * static_cast<double>(c.iou_50),
         percent * static_cast<double>(c.iou_70), static_cast<unsigned long long>(c.lost),
         static_cast<unsigned long long>(c.merged), static_cast<unsigned long long>(c.split),
         static_cast<unsigned long long>(c.cut));
}
}  // namespace

std::string formatObjectRecall(const ObjectRecall& recall)
{
  std::string out;
  append(out, "[%%, objects]     objects    R50    R70   lost  merged  split    cut\n");
  appendCounts("all", recall.all(), out);
  for (const auto& [name, counts] : recall.byClass()) appendCounts(name, counts, out);
  float begin = 0.0F;
  for (std::size_t bin = 0; bin < recall.byRange().size(); ++bin)
  {
    const float end = recall.config().range_ends_m[bin];
    char name[32];
    std::snprintf(name, sizeof name, "%.0f to %.0f m", static_cast<double>(begin), static_cast<double>(end));
    appendCounts(name, recall.byRange()[bin], out);
    begin = end;
  }
  const double scans = recall.scanCount() == 0 ? 1.0 : static_cast<double>(recall.scanCount());
  append(out, "\nFalse segments of %u points or more: %.1f a scan, with %.0f points\n", recall.config().min_points,
         static_cast<double>(recall.falseSegments()) / scans, static_cast<double>(recall.falsePoints()) / scans);
  append(out, "Ground: precision %.1f, recall %.1f, IoU %.1f\n", 100 * recall.ground().precision(),
         100 * recall.ground().recall(), 100 * recall.ground().iou());
  append(out, "Entropy a scan: over-segmentation %.2f, under-segmentation %.2f\n", recall.overSegmentation() / scans,
         recall.underSegmentation() / scans);
  append(out, "Scans evaluated: %llu\n", static_cast<unsigned long long>(recall.scanCount()));
  return out;
}
}  // namespace lidar_panoptic_clustering

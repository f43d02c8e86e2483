#include "lidar_panoptic_clustering/evaluation/evaluation_report.h"

#include "core/plain_numbers.h"
#include "core/printable.h"

#include <cstdio>

namespace lidar_panoptic_clustering
{
namespace
{
void appendClasses(const PanopticQuality& quality, ClassKind kind, std::string& out)
{
  for (std::size_t c = 0; c < quality.classes().size(); ++c)
  {
    const ClassInfo& info = quality.table()[static_cast<ClassIndex>(c)];
    const ClassCounts& counts = quality.classes()[c];
    if (info.kind != kind) continue;
    appendText(out, "%-16.40s", printable(info.name, false).c_str());
    appendText(out, "%7.1f %6.1f %6.1f %6.1f", 100 * counts.pq(), 100 * counts.sq(), 100 * counts.rq(),
               100 * counts.iou());
    appendText(out, " %8llu %7llu %7llu\n", static_cast<unsigned long long>(counts.tp),
               static_cast<unsigned long long>(counts.fp), static_cast<unsigned long long>(counts.fn));
  }
}

void appendTemporal(const EvaluationReport& report, std::string& out)
{
  const TemporalFigures f = report.temporal->figures();
  appendText(out, "\nOver time: LSTQ %.1f, S_assoc %.1f, S_cls %.1f", 100 * f.lstq, 100 * f.s_assoc, 100 * f.s_cls);
  if (report.id_switches) appendText(out, ", id switches %llu", static_cast<unsigned long long>(*report.id_switches));
  appendText(out, "\n[%%]             S_assoc   tubes\n");
  for (std::size_t c = 0; c < f.tubes.size(); ++c)
  {
    const ClassInfo& info = report.temporal->table()[static_cast<ClassIndex>(c)];
    if (info.isThing())
      appendText(out, "%-16.40s%7.1f %7llu\n", info.name.c_str(), 100 * f.association[c],
                 static_cast<unsigned long long>(f.tubes[c]));
  }
}
}  // namespace

std::string formatReport(const EvaluationReport& report)
{
  const PlainNumbers plain;
  const PanopticFigures f = report.quality.figures();
  std::string out;
  appendText(out, "[%%]                 PQ     SQ     RQ    IoU       TP      FP      FN\n");
  appendClasses(report.quality, ClassKind::kThing, out);
  appendClasses(report.quality, ClassKind::kStuff, out);
  appendText(out, "\n%-16s%7.1f %6.1f %6.1f %6.1f   PQ-dagger %.1f\n", "all", 100 * f.pq, 100 * f.sq, 100 * f.rq,
             100 * f.miou, 100 * f.pq_dagger);
  appendText(out, "%-16s%7.1f %6.1f %6.1f          PQ over the classes that occur %.1f\n", "things", 100 * f.pq_th,
             100 * f.sq_th, 100 * f.rq_th, 100 * f.pq_th_present);
  appendText(out, "%-16s%7.1f %6.1f %6.1f\n", "stuff", 100 * f.pq_st, 100 * f.sq_st, 100 * f.rq_st);

  const ObjectErrorCounts& objects = report.objects;
  appendText(out,
             "\nTrue objects of %d points or more: %llu, of which matched %llu, split %llu, merged %llu, missed %llu\n",
             report.quality.minPoints(), static_cast<unsigned long long>(objects.total()),
             static_cast<unsigned long long>(objects.matched), static_cast<unsigned long long>(objects.split),
             static_cast<unsigned long long>(objects.merged), static_cast<unsigned long long>(objects.missed));
  if (report.temporal) appendTemporal(report, out);
  appendText(out, "%sScans evaluated: %llu, skipped: %zu\n", report.temporal ? "\n" : "",
             static_cast<unsigned long long>(report.quality.scanCount()), report.skipped.size());
  return out;
}
}  // namespace lidar_panoptic_clustering

// Any text as a saved report: refused, or a report that is written as it was read.
#include "fuzz_input.h"
#include "lidar_panoptic_clustering/evaluation/benchmark_report.h"

using namespace lidar_panoptic_clustering;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size)
{
  static const auto table = std::make_shared<const ClassTable>(
      ClassTable::parse("classes: [{name: car, kind: thing, ids: [10], color: [0, 0, 0], size: [4, 2], link: 1}, "
                        "{name: road, kind: stuff, ids: [40], color: [0, 0, 0]}]",
                        "two"));
  const std::string text(reinterpret_cast<const char*>(bytes), size);
  mayRefuse([&] { EvaluationReport::classTableOf(text, "input.json"); });
  mayRefuse([&] { BenchmarkReport::classTableOf(text, "input.json"); });
  mayRefuse(
      [&]
      {
        EvaluationReport report = EvaluationReport::fromJsonText(text, "input.json", table);
        formatReport(report);
        const std::string saved = report.toJsonText();
        mustHold(EvaluationReport::fromJsonText(saved, "saved.json", table).toJsonText() == saved, "saved as read");
        report += report;
      });
  mayRefuse(
      [&]
      {
        BenchmarkReport report = BenchmarkReport::fromJsonText(text, "input.json", table);
        formatBenchmark(report);
        const std::string saved = report.toJsonText();
        mustHold(BenchmarkReport::fromJsonText(saved, "saved.json", table).toJsonText() == saved, "saved as read");
        formatComparison({report, report}, {"a", "b"});
        BenchmarkReport sum = report;
        sum += report;
      });
  return 0;
}

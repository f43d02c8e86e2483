#include "lidar_panoptic_clustering/evaluation/evaluation_report.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <nlohmann/json.hpp>

namespace lidar_panoptic_clustering
{
namespace
{
using nlohmann::json;

std::shared_ptr<const ClassTable> kitti()
{
  static const auto table = std::make_shared<const ClassTable>(ClassTable::load("semantic_kitti"));
  return table;
}

/// Counts that no double holds exactly.
EvaluationReport largeReport()
{
  EvaluationReport report(kitti(), 30);
  std::vector<ClassCounts> counts(kitti()->size());
  ClassCounts& car = counts[kitti()->findByName("car")];
  car.tp = (std::uint64_t{1} << 60U) + 1U, car.fp = 7, car.fn = 11;
  car.iou_sum = {(std::uint64_t{1} << 59U) + 3U, (std::uint64_t{1} << 53U) - 1U};
  car.points_both = (std::uint64_t{1} << 61U) + 5U, car.points_predicted = car.points_true = car.points_both + 9U;
  report.quality.restore(counts, 4071);
  report.objects.matched = 1, report.objects.split = 2, report.objects.merged = 3, report.objects.missed = 4;
  report.skipped = {{"08/000001", "no \"file\"\n"}, {"08/000000", "caf\xC3\xA9"}};
  return report;
}

/// The message of the exception that reading the report gives after `change`; "" without one.
std::string complaint(const std::function<void(json&)>& change)
{
  json report = json::parse(largeReport().toJsonText());
  change(report);
  try
  {
    EvaluationReport::fromJsonText(report.dump(), "some.json", kitti());
  }
  catch (const std::invalid_argument& error)
  {
    return error.what();
  }
  return "";
}
}  // namespace

TEST(EvaluationReport, SavedAndLoadedIsTheSame)
{
  const EvaluationReport report = largeReport();
  const std::string text = report.toJsonText();
  const auto loaded = EvaluationReport::fromJsonText(text, "report", kitti());
  EXPECT_TRUE(loaded.quality == report.quality);
  EXPECT_TRUE(loaded.objects == report.objects);
  EXPECT_EQ(loaded.quality.minPoints(), 30);
  EXPECT_EQ(loaded.toJsonText(), text);
  EXPECT_EQ(EvaluationReport::classTableOf(text, "report"), "semantic_kitti");
}

TEST(EvaluationReport, MergedInEitherOrderGivesTheSameBytes)
{
  EvaluationReport one(kitti(), 30);
  one.skipped = {{"08/000009", "short"}};
  EvaluationReport left = one, right = largeReport();
  left += largeReport();
  right += one;
  EXPECT_EQ(left.toJsonText(), right.toJsonText());
  EXPECT_EQ(json::parse(left.toJsonText()).at("scans_skipped"), 3);
  EXPECT_EQ(json::parse(left.toJsonText()).at("scans"), 4071);
}

TEST(EvaluationReport, NamesWhatIsWrong)
{
  EXPECT_EQ(complaint([](json&) {}), "");
  EXPECT_EQ(complaint([](json& r) { r.erase("scans"); }), "some.json: key 'scans' is missing");
  EXPECT_EQ(complaint([](json& r) { r["min_points"] = -1; }),
            "some.json: key 'min_points' is -1, expected a whole number");
  EXPECT_EQ(complaint([](json& r) { r["per_class"]["car"]["tp"] = 0.5; }),
            "some.json: class 'car': key 'tp' is 0.5, expected a whole number");
  EXPECT_EQ(complaint([](json& r) { r["per_class"].erase("road"); }), "some.json: class 'road': key 'road' is missing");
  EXPECT_EQ(complaint([](json& r) { r["per_class"]["tree"] = 1; }),
            "some.json: key 'per_class' has 20 classes, class table 'semantic_kitti' evaluates 19");
  EXPECT_NE(complaint([](json& r) { r["per_class"]["car"]["kind"] = "stuff"; }), "");
  EXPECT_NE(complaint([](json& r) { r["per_class"]["car"]["iou_sum"]["fraction_2_53"] = 1ULL << 53U; }), "");
  EXPECT_NE(complaint([](json& r) { r["skipped"] = 3; }), "");
  EXPECT_NE(complaint([](json& r) { r = 3; }), "");
  EXPECT_THROW(EvaluationReport::fromJsonText("{\"pq\":", "some.json", kitti()), std::invalid_argument);
}

TEST(EvaluationReport, FormatShowsEveryClassOnce)
{
  const std::string table = formatReport(largeReport());
  for (std::size_t c = 1; c < kitti()->size(); ++c)
  {
    const ClassInfo& info = (*kitti())[static_cast<ClassIndex>(c)];
    const std::size_t found = ("\n" + table).find("\n" + info.name + " ");
    EXPECT_EQ(found != std::string::npos, info.kind != ClassKind::kIgnored) << info.name << "\n" << table;
  }
  EXPECT_NE(table.find("30 points or more: 10, of which matched 1, split 2, merged 3, missed 4"), std::string::npos);
}
}  // namespace lidar_panoptic_clustering

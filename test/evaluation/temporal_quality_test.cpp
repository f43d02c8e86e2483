#include "lidar_panoptic_clustering/evaluation/temporal_quality.h"

#include "lidar_panoptic_clustering/datasets/semantic_kitti.h"
#include "lidar_panoptic_clustering/evaluation/evaluation_report.h"
#include "recorded_data.h"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <random>
#include <set>

namespace lidar_panoptic_clustering
{
namespace
{
using Labels = std::vector<std::uint32_t>;

std::shared_ptr<const ClassTable> kitti()
{
  static const auto table = std::make_shared<const ClassTable>(ClassTable::load("semantic_kitti"));
  return table;
}

struct Scan
{
  std::string sequence;
  Labels predicted, truth;
};

void add(TemporalQuality& quality, const Scan& scan)
{
  SegmentOverlaps overlaps(kitti());
  overlaps.count(ScanLabels::packed(scan.predicted.data()), ScanLabels::packed(scan.truth.data()), scan.truth.size());
  quality.addScan(scan.sequence, overlaps);
}

/// `n` points of class and instance.
Labels points(std::uint32_t class_id, std::uint32_t instance, std::size_t n)
{
  return Labels(n, instance << 16U | class_id);
}

Labels operator+(Labels a, const Labels& b)
{
  a.insert(a.end(), b.begin(), b.end());
  return a;
}

/// The rules on sets of points, tube by tube.
class BruteForce
{
public:
  BruteForce(const std::vector<Scan>& scans, std::size_t min_points) : scans_(scans), min_points_(min_points) {}

  double sAssoc() const
  {
    std::set<std::tuple<std::string, ClassIndex, std::uint32_t>> truth;
    std::set<std::pair<std::string, std::uint32_t>> predicted;
    for (const Scan& scan : scans_)
      for (std::size_t i = 0; i < scan.truth.size(); ++i)
      {
        predicted.insert({scan.sequence, rawInstance(scan.predicted[i])});
        truth.insert({scan.sequence, classOf(scan.truth[i]), rawInstance(scan.truth[i])});
      }
    double sum = 0.0;
    std::size_t tubes = 0;
    for (const auto& [sequence, c, instance] : truth)
    {
      if (instance == 0 || !(*kitti())[c].isThing()) continue;
      const Points in_truth = truePoints(sequence, c, instance);
      if (in_truth.empty()) continue;
      ++tubes;
      for (const auto& [other, id] : predicted)
        if (id != 0 && other == sequence) sum += association(in_truth, predictedPoints(sequence, id));
    }
    return tubes == 0 ? 0.0 : sum / static_cast<double>(tubes);
  }

  double sCls() const
  {
    double sum = 0.0;
    int classes = 0;
    for (std::size_t c = 0; c < kitti()->size(); ++c)
    {
      std::size_t both = 0, either = 0;
      for (const Scan& scan : scans_)
        for (std::size_t i = 0; i < scan.truth.size(); ++i)
        {
          if (isIgnored(scan.truth[i])) continue;
          const auto evaluated = [](std::uint32_t l) { return isIgnored(l) ? 0U : std::uint32_t{classOf(l)}; };
          const bool p = evaluated(scan.predicted[i]) == c, t = evaluated(scan.truth[i]) == c;
          both += p && t, either += p || t;
        }
      if (either == 0) continue;
      sum += static_cast<double>(both) / static_cast<double>(either);
      ++classes;
    }
    return classes == 0 ? 0.0 : sum / classes;
  }

private:
  using Points = std::set<std::pair<std::size_t, std::size_t>>;  // scan, point

  static ClassIndex classOf(std::uint32_t l) { return kitti()->find(rawClass(l)); }
  static bool isIgnored(std::uint32_t l) { return (*kitti())[classOf(l)].kind == ClassKind::kIgnored; }

  Points truePoints(const std::string& sequence, ClassIndex c, std::uint32_t instance) const
  {
    Points tube;
    for (std::size_t s = 0; s < scans_.size(); ++s)
    {
      Points here;
      for (std::size_t i = 0; i < scans_[s].truth.size(); ++i)
        if (scans_[s].sequence == sequence && classOf(scans_[s].truth[i]) == c &&
            rawInstance(scans_[s].truth[i]) == instance)
          here.insert({s, i});
      if (here.size() > min_points_) tube.insert(here.begin(), here.end());
    }
    return tube;
  }
  Points predictedPoints(const std::string& sequence, std::uint32_t id) const
  {
    Points tube;
    for (std::size_t s = 0; s < scans_.size(); ++s)
      for (std::size_t i = 0; i < scans_[s].truth.size(); ++i)
        if (scans_[s].sequence == sequence && rawInstance(scans_[s].predicted[i]) == id &&
            !isIgnored(scans_[s].truth[i]))
          tube.insert({s, i});
    return tube;
  }
  static double association(const Points& truth, const Points& predicted)
  {
    double both = 0.0;
    for (const auto& point : truth) both += predicted.count(point) != 0 ? 1.0 : 0.0;
    const auto t = static_cast<double>(truth.size()), p = static_cast<double>(predicted.size());
    return both * both / (t + p - both) / t;
  }

  const std::vector<Scan>& scans_;
  std::size_t min_points_;
};

/// Runs of labels; the prediction mostly repeats the truth.
std::vector<Scan> randomScans(std::mt19937& random)
{
  const Labels ids{0, 1, 10, 252, 18, 30, 40, 50, 777};
  const auto below = [&](std::size_t n) { return static_cast<std::uint32_t>(random() % n); };
  const auto any = [&] { return below(4) << 16U | ids[below(ids.size())]; };
  std::vector<Scan> scans;
  for (int s = 0; s < 6; ++s)
  {
    Scan scan{below(3) == 0 ? "01" : "00", {}, {}};
    for (int run = 0; run < 25; ++run)
    {
      const std::uint32_t truth = any(), predicted = below(3) == 0 ? any() : truth;
      const std::size_t n = 1 + below(6);
      scan.truth = scan.truth + Labels(n, truth);
      scan.predicted = scan.predicted + Labels(n, predicted);
    }
    scans.push_back(scan);
  }
  return scans;
}

TEST(TemporalQuality, EqualsBruteForceOnRandomTubes)
{
  std::mt19937 random(3);
  for (int round = 0; round < 100; ++round)
  {
    const std::vector<Scan> scans = randomScans(random);
    const int min_points = static_cast<int>(random() % 8);
    TemporalQuality quality(kitti(), min_points);
    for (const Scan& scan : scans) add(quality, scan);
    const BruteForce brute(scans, static_cast<std::size_t>(min_points));
    const TemporalFigures figures = quality.figures();
    EXPECT_NEAR(figures.s_assoc, brute.sAssoc(), 1e-12);
    EXPECT_NEAR(figures.s_cls, brute.sCls(), 1e-12);
    EXPECT_NEAR(figures.lstq, std::sqrt(brute.sAssoc() * brute.sCls()), 1e-12);
  }
}

TEST(TemporalQuality, CountsByHand)
{
  // a car of 60 and 40 points under one id, then under another: the second scan of it has too few points to count
  TemporalQuality quality(kitti());
  add(quality, {"00", points(10, 5, 60), points(252, 9, 60)});
  add(quality, {"00", points(10, 6, 40), points(10, 9, 40)});
  EXPECT_DOUBLE_EQ(quality.figures().s_assoc, 1.0);
  // 100 points under the second id: |truth| 160, |5| 60, |6| 140, of which 100 are shared
  add(quality, {"00", points(10, 6, 100), points(10, 9, 100)});
  EXPECT_DOUBLE_EQ(quality.figures().s_assoc, (60.0 * 60 / 160 + 100.0 * 100 / 200) / 160);
  // the same ids in another sequence are other tubes
  add(quality, {"01", points(10, 6, 100), points(10, 9, 100)});
  EXPECT_DOUBLE_EQ(quality.figures().s_assoc, ((60.0 * 60 / 160 + 100.0 * 100 / 200) / 160 + 1.0) / 2);
  EXPECT_DOUBLE_EQ(quality.figures().s_cls, 1.0);
}

TEST(TemporalQuality, AnIdIsOneTubeWhateverItsClass)
{
  TemporalQuality quality(kitti());
  add(quality, {"00", points(18, 1, 60) + points(30, 1, 60), points(10, 7, 60) + points(30, 8, 60)});
  EXPECT_DOUBLE_EQ(quality.figures().s_assoc, 0.5);
  EXPECT_DOUBLE_EQ(quality.figures().s_cls, 1.0 / 3);  // car and truck 0, person 1
}

TEST(TemporalQuality, EvaluatedPointsPredictedToBeIgnoredAreAClassOfTheirOwn)
{
  TemporalQuality quality(kitti());
  add(quality, {"00", points(40, 0, 50) + points(0, 0, 50), points(40, 0, 100)});
  EXPECT_DOUBLE_EQ(quality.figures().s_cls, 0.25);
}

TEST(TemporalQuality, PartsAddUpInAnyOrderAndSurviveAReport)
{
  std::mt19937 random(5);
  const std::vector<Scan> scans = randomScans(random);
  EvaluationReport whole(kitti()), forth(kitti()), back(kitti());
  for (EvaluationReport* report : {&whole, &forth, &back}) report->temporal.emplace(kitti(), 3);
  for (const Scan& scan : scans) add(*whole.temporal, scan);
  for (std::size_t i = 0; i < scans.size(); ++i) add(i < 3 ? *forth.temporal : *back.temporal, scans[i]);
  back += forth;
  EXPECT_EQ(back.toJsonText(), whole.toJsonText());
  EXPECT_EQ(EvaluationReport::fromJsonText(whole.toJsonText(), "x.json", kitti()).toJsonText(), whole.toJsonText());
  EXPECT_THROW(back += EvaluationReport(kitti()), std::invalid_argument);
  EXPECT_THROW(*back.temporal += TemporalQuality(kitti(), 4), std::invalid_argument);
}

TEST(TemporalQuality, RefusesAReportThatContradictsItself)
{
  EvaluationReport report(kitti());
  report.temporal.emplace(kitti());
  add(*report.temporal, {"00", points(10, 5, 60), points(10, 9, 60)});
  auto json = nlohmann::json::parse(report.toJsonText());
  json["temporal"]["sequences"]["00"]["shared"]["car"][0][2] = 61;
  EXPECT_THROW(EvaluationReport::fromJsonText(json.dump(), "x.json", kitti()), std::invalid_argument);
  json["temporal"]["sequences"]["00"]["shared"]["car"][0] = {1, 2};
  EXPECT_THROW(EvaluationReport::fromJsonText(json.dump(), "x.json", kitti()), std::invalid_argument);
  json["temporal"]["sequences"]["00"] = {{"shared", nlohmann::json::object()}};
  EXPECT_THROW(EvaluationReport::fromJsonText(json.dump(), "x.json", kitti()), std::invalid_argument);
}

TEST(TemporalQuality, EqualsTheOfficialEvaluatorOnRecordedScans)
{
  REQUIRE_RECORDED_DATA(data);
  const std::string root = data + "/semantickitti";
  std::ifstream file(root + "/expected_lstq.json");
  const auto expected = nlohmann::json::parse(file);
  for (const std::string set : {"perturbed", "mininet"})
  {
    TemporalQuality quality(kitti());
    for (const std::string name : {"00", "05", "07"})
    {
      const SemanticKittiSequence sequence(root, name, root + "/predictions/" + set);
      for (std::size_t i = 0; i < sequence.size(); ++i)
      {
        Scan scan{name, {}, {}};
        readLabelFile(root + "/sequences/" + name + "/labels/" + sequence.scanName(i) + ".label", scan.truth);
        sequence.readPredictions(i, scan.truth.size(), scan.predicted);
        add(quality, scan);
      }
    }
    const TemporalFigures figures = quality.figures();
    EXPECT_NEAR(figures.lstq, expected[set]["lstq"].get<double>(), 1e-9) << set;
    EXPECT_NEAR(figures.s_assoc, expected[set]["s_assoc"].get<double>(), 1e-9) << set;
    EXPECT_NEAR(figures.s_cls, expected[set]["s_cls"].get<double>(), 1e-9) << set;
    std::uint64_t tubes = 0;
    for (const std::uint64_t n : figures.tubes) tubes += n;
    EXPECT_EQ(tubes, expected[set]["tubes"].get<std::uint64_t>()) << set;
    for (const auto& [name, value] : expected[set]["assoc_per_class"].items())
      EXPECT_NEAR(figures.association[kitti()->findByName(name)], value.get<double>(), 1e-9) << set << " " << name;
  }
}

TEST(IdSwitches, CountsChangesOfTheIdThatCoversMost)
{
  SegmentOverlaps overlaps(kitti());
  IdSwitches switches(50);
  const auto addScan = [&](const Labels& predicted)
  {
    const Labels truth = points(10, 9, 100);
    overlaps.count(ScanLabels::packed(predicted.data()), ScanLabels::packed(truth.data()), truth.size());
    switches.addScan(overlaps);
  };
  addScan(points(10, 5, 100));
  addScan(points(10, 6, 40) + points(10, 5, 60));  // a part under another id
  EXPECT_EQ(switches.count(), 0U);
  addScan(points(10, 0, 100));  // not found
  addScan(points(18, 5, 100));
  EXPECT_EQ(switches.count(), 0U);
  addScan(points(10, 7, 100));
  EXPECT_EQ(switches.count(), 1U);
  addScan(points(10, 5, 100));
  EXPECT_EQ(switches.count(), 2U);
  switches.startSequence();
  addScan(points(10, 8, 100));
  EXPECT_EQ(switches.count(), 2U);
}
}  // namespace
}  // namespace lidar_panoptic_clustering

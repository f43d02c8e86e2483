#pragma once

#include "lidar_panoptic_clustering/core/class_table.h"
#include "lidar_panoptic_clustering/evaluation/panoptic_quality.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <map>
#include <set>
#include <vector>

namespace lidar_panoptic_clustering
{
/// The official rules on sets of points, class by class.
class BruteForcePanopticQuality
{
public:
  using Labels = std::vector<std::uint32_t>;

  BruteForcePanopticQuality(const ClassTable& table, std::size_t min_points) : table_(&table), min_points_(min_points)
  {
  }

  void add(const Labels& predicted, const Labels& truth)
  {
    for (std::size_t c = 0; c < table_->size(); ++c)
    {
      const auto index = static_cast<ClassIndex>(c);
      if ((*table_)[index].kind != ClassKind::kIgnored) addClass(index, predicted, truth);
    }
  }

  std::map<ClassIndex, ClassCounts> counts;
  std::map<ClassIndex, double> iou_sum;

private:
  using Points = std::set<std::size_t>;

  std::map<std::uint32_t, Points> segments(ClassIndex c, const Labels& labels, const Labels& truth) const
  {
    std::map<std::uint32_t, Points> result;
    for (std::size_t i = 0; i < labels.size(); ++i)
      if (!isIgnored(truth[i]) && table_->find(labels[i] & 0xFFFFU) == c) result[labels[i]].insert(i);
    return result;
  }
  bool isIgnored(std::uint32_t l) const { return (*table_)[table_->find(l & 0xFFFFU)].kind == ClassKind::kIgnored; }
  static std::size_t shared(const Points& a, const Points& b)
  {
    return static_cast<std::size_t>(std::count_if(a.begin(), a.end(), [&](std::size_t i) { return b.count(i) != 0; }));
  }
  static Points all(const std::map<std::uint32_t, Points>& segments)
  {
    Points points;
    for (const auto& segment : segments) points.insert(segment.second.begin(), segment.second.end());
    return points;
  }

  void addClass(ClassIndex c, const Labels& predicted, const Labels& truth)
  {
    const auto predicted_segments = segments(c, predicted, truth), true_segments = segments(c, truth, truth);
    ClassCounts& result = counts[c];
    std::set<std::uint32_t> matched_predicted, matched_truth;
    for (const auto& [p, predicted_points] : predicted_segments)
      for (const auto& [t, true_points] : true_segments)
      {
        const auto both = static_cast<double>(shared(predicted_points, true_points));
        const double iou = both / (static_cast<double>(predicted_points.size() + true_points.size()) - both);
        if (!(iou > 0.5)) continue;
        ++result.tp;
        iou_sum[c] += iou;
        EXPECT_TRUE(matched_predicted.insert(p).second && matched_truth.insert(t).second) << "matched twice";
      }
    for (const auto& [p, points] : predicted_segments)
      if (matched_predicted.count(p) == 0 && points.size() >= min_points_) ++result.fp;
    for (const auto& [t, points] : true_segments)
      if (matched_truth.count(t) == 0 && points.size() >= min_points_) ++result.fn;
    const Points in_prediction = all(predicted_segments), in_truth = all(true_segments);
    result.points_both += shared(in_prediction, in_truth);
    result.points_predicted += in_prediction.size();
    result.points_true += in_truth.size();
  }

  const ClassTable* table_;
  std::size_t min_points_;
};
}  // namespace lidar_panoptic_clustering

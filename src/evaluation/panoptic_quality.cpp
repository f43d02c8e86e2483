#include "lidar_panoptic_clustering/evaluation/panoptic_quality.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>
#include <tuple>
#include <utility>

namespace lidar_panoptic_clustering
{
namespace
{
bool sameClasses(const ClassTable& a, const ClassTable& b)
{
  if (&a == &b) return true;
  if (a.size() != b.size()) return false;
  for (std::size_t c = 0; c < a.size(); ++c)
  {
    const ClassInfo& left = a[static_cast<ClassIndex>(c)];
    const ClassInfo& right = b[static_cast<ClassIndex>(c)];
    if (left.name != right.name || left.kind != right.kind || left.ids != right.ids) return false;
  }
  return true;
}

struct Means
{
  double pq = 0.0, rq = 0.0, sq = 0.0;
  int count = 0;

  void add(const ClassCounts& counts)
  {
    pq += counts.pq(), rq += counts.rq(), sq += counts.sq();
    ++count;
  }
  std::tuple<double, double, double> means() const
  {
    const double n = std::max(count, 1);
    return {pq / n, rq / n, sq / n};
  }
};
}  // namespace

void ExactSum::add(double value)
{
  *this += {0, static_cast<std::uint64_t>(std::ldexp(value, kFractionBits))};
}

ExactSum& ExactSum::operator+=(const ExactSum& other)
{
  fraction += other.fraction;
  whole += other.whole + (fraction >> kFractionBits);
  fraction &= (std::uint64_t{1} << kFractionBits) - 1;
  return *this;
}

double ExactSum::value() const
{
  return static_cast<double>(whole) + std::ldexp(static_cast<double>(fraction), -kFractionBits);
}

double ClassCounts::sq() const
{
  return tp == 0 ? 0.0 : iou_sum.value() / static_cast<double>(tp);
}

double ClassCounts::rq() const
{
  return occurs() ? static_cast<double>(2 * tp) / static_cast<double>(2 * tp + fp + fn) : 0.0;
}

double ClassCounts::iou() const
{
  const std::uint64_t united = points_predicted + points_true - points_both;
  return united == 0 ? 0.0 : static_cast<double>(points_both) / static_cast<double>(united);
}

ClassCounts& ClassCounts::operator+=(const ClassCounts& other)
{
  tp += other.tp, fp += other.fp, fn += other.fn;
  iou_sum += other.iou_sum;
  points_both += other.points_both;
  points_predicted += other.points_predicted;
  points_true += other.points_true;
  return *this;
}

bool ClassCounts::operator==(const ClassCounts& other) const
{
  const auto all = [](const ClassCounts& c)
  { return std::tie(c.tp, c.fp, c.fn, c.points_both, c.points_predicted, c.points_true); };
  return all(*this) == all(other) && iou_sum == other.iou_sum;
}

PanopticQuality::PanopticQuality(std::shared_ptr<const ClassTable> table, int min_points)
    : min_points_(min_points), overlaps_(table)
{
  if (!table) throw std::invalid_argument("panoptic quality needs a class table");
  if (min_points < 0)
    throw std::invalid_argument("min_points is " + std::to_string(min_points) + ", expected 0 or more");
  counts_.resize(table->size());
}

void PanopticQuality::addScan(ScanLabels predicted, ScanLabels truth, std::size_t point_count)
{
  overlaps_.count(predicted, truth, point_count);
  countMatches();
  countUnmatched(overlaps_.predicted(), predicted_matched_, &ClassCounts::fp);
  countUnmatched(overlaps_.truth(), truth_matched_, &ClassCounts::fn);
  ++scan_count_;
}

void PanopticQuality::countMatches()
{
  predicted_matched_.assign(overlaps_.predicted().size(), false);
  truth_matched_.assign(overlaps_.truth().size(), false);
  for (const Overlap& overlap : overlaps_.overlaps())
  {
    const Segment& predicted = overlaps_.predicted()[overlap.predicted];
    const Segment& truth = overlaps_.truth()[overlap.truth];
    if (isEvaluated(predicted.class_index)) counts_[predicted.class_index].points_predicted += overlap.points;
    counts_[truth.class_index].points_true += overlap.points;
    if (predicted.class_index != truth.class_index) continue;

    ClassCounts& counts = counts_[truth.class_index];
    counts.points_both += overlap.points;
    if (!isMatch(overlap.points, predicted.points, truth.points)) continue;
    ++counts.tp;
    counts.iou_sum.add(static_cast<double>(overlap.points) /
                       (static_cast<double>(predicted.points) + truth.points - overlap.points));
    predicted_matched_[overlap.predicted] = true;
    truth_matched_[overlap.truth] = true;
  }
}

void PanopticQuality::countUnmatched(const std::vector<Segment>& segments, const std::vector<bool>& matched,
                                     std::uint64_t ClassCounts::*counter)
{
  const auto min_points = static_cast<std::uint32_t>(min_points_);
  for (std::size_t i = 0; i < segments.size(); ++i)
    if (!matched[i] && segments[i].points >= min_points && isEvaluated(segments[i].class_index))
      ++(counts_[segments[i].class_index].*counter);
}

PanopticQuality& PanopticQuality::operator+=(const PanopticQuality& other)
{
  if (min_points_ != other.min_points_)
    throw std::invalid_argument("panoptic qualities with min_points " + std::to_string(min_points_) + " and " +
                                std::to_string(other.min_points_) + " cannot be added");
  if (!sameClasses(table(), other.table()))
    throw std::invalid_argument("panoptic qualities with the classes of '" + table().name() + "' and of '" +
                                other.table().name() + "' cannot be added: names, order, kinds or ids differ");
  for (std::size_t c = 0; c < counts_.size(); ++c) counts_[c] += other.counts_[c];
  scan_count_ += other.scan_count_;
  return *this;
}

bool PanopticQuality::operator==(const PanopticQuality& other) const
{
  return min_points_ == other.min_points_ && scan_count_ == other.scan_count_ && counts_ == other.counts_ &&
         sameClasses(table(), other.table());
}

void PanopticQuality::restore(std::vector<ClassCounts> counts, std::uint64_t scan_count)
{
  if (counts.size() != counts_.size())
    throw std::invalid_argument("counts of " + std::to_string(counts.size()) + " classes, expected " +
                                std::to_string(counts_.size()));
  counts_ = std::move(counts);
  scan_count_ = scan_count;
}

PanopticFigures PanopticQuality::figures() const
{
  Means all, things, stuff, present;
  double dagger = 0.0, iou = 0.0;
  for (std::size_t c = 0; c < counts_.size(); ++c)
  {
    const auto index = static_cast<ClassIndex>(c);
    if (!isEvaluated(index)) continue;
    const ClassInfo& info = table()[index];
    const ClassCounts& counts = counts_[c];
    all.add(counts);
    (info.isThing() ? things : stuff).add(counts);
    if (info.isThing() && counts.occurs()) present.add(counts);
    dagger += info.isThing() ? counts.pq() : counts.iou();
    iou += counts.iou();
  }
  PanopticFigures figures;
  std::tie(figures.pq, figures.rq, figures.sq) = all.means();
  std::tie(figures.pq_th, figures.rq_th, figures.sq_th) = things.means();
  std::tie(figures.pq_st, figures.rq_st, figures.sq_st) = stuff.means();
  figures.pq_th_present = std::get<0>(present.means());
  figures.pq_dagger = dagger / std::max(all.count, 1);
  figures.miou = iou / std::max(all.count, 1);
  return figures;
}
}  // namespace lidar_panoptic_clustering

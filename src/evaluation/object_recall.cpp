#include "lidar_panoptic_clustering/evaluation/object_recall.h"

#include "lidar_panoptic_clustering/core/class_mapping.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <tuple>

namespace lidar_panoptic_clustering
{
namespace
{
double ratio(std::uint64_t part, std::uint64_t whole)
{
  return static_cast<double>(part) / static_cast<double>(whole);
}

double entropyOf(std::uint32_t part, std::uint32_t whole)
{
  const double share = ratio(part, whole);
  return -share * std::log(share);
}

void count(const RecalledObject& object, RecallCounts& counts)
{
  ++counts.objects;
  counts.iou_50 += object.best_iou > 0.5 ? 1U : 0U;
  counts.iou_70 += object.best_iou > 0.7 ? 1U : 0U;
  counts.lost += object.outcome == RecallOutcome::kLost ? 1U : 0U;
  counts.merged += object.outcome == RecallOutcome::kMerged ? 1U : 0U;
  counts.split += object.outcome == RecallOutcome::kSplit ? 1U : 0U;
  counts.cut += object.outcome == RecallOutcome::kCut ? 1U : 0U;
}

auto tied(const ObjectRecallConfig& c)
{
  return std::tie(c.min_points, c.no_ground_truth, c.range_ends_m);
}
}  // namespace

const char* nameOf(RecallOutcome outcome)
{
  constexpr std::array<const char*, 5> kNames = {"found", "lost", "merged", "split", "cut"};
  return kNames[static_cast<std::size_t>(outcome)];
}

RecallCounts& RecallCounts::operator+=(const RecallCounts& other)
{
  objects += other.objects, iou_50 += other.iou_50, iou_70 += other.iou_70;
  lost += other.lost, merged += other.merged, split += other.split, cut += other.cut;
  return *this;
}

bool RecallCounts::operator==(const RecallCounts& other) const
{
  const auto all = [](const RecallCounts& c)
  { return std::tie(c.objects, c.iou_50, c.iou_70, c.lost, c.merged, c.split, c.cut); };
  return all(*this) == all(other);
}

double GroundCounts::iou() const
{
  const std::uint64_t either = found + truth - both;
  return either == 0 ? 0.0 : ratio(both, either);
}

ObjectRecall::ObjectRecall(std::shared_ptr<const ClassTable> table, ObjectRecallConfig config)
    : config_(std::move(config)), table_(std::move(table)), by_range_(config_.range_ends_m.size())
{
  if (!table_) throw std::invalid_argument("expected a class table, found none");
  const ClassTable object = ClassTable::load("object");
  ground_id_ = object[object.findByName("ground")].ids.at(0);
  const ClassMapping mapping(*table_, object);
  for (std::size_t index = 0; index < table_->size(); ++index)
  {
    const ClassInfo& info = (*table_)[static_cast<ClassIndex>(index)];
    is_ground_.push_back(!info.ids.empty() && mapping(info.ids[0]) == ground_id_ ? 1 : 0);
  }
}

void ObjectRecall::addScan(const RecallScan& scan)
{
  countPairs(scan);
  countGround(scan);
  judgeObjects();
  judgeSegments();
  countFlips(scan.follows);
  ++scan_count_;
}

void ObjectRecall::countFlips(bool follows)
{
  std::map<std::pair<std::uint32_t, std::uint32_t>, bool> is_found;
  for (const RecalledObject& object : objects_)
  {
    const std::pair<std::uint32_t, std::uint32_t> key(object.class_id, object.instance);
    is_found[key] = object.outcome == RecallOutcome::kFound;
    const auto before = was_found_.find(key);
    if (!follows || before == was_found_.end()) continue;
    ++shown_twice_;
    flips_ += before->second != is_found[key] ? 1U : 0U;
  }
  was_found_ = std::move(is_found);
}

void ObjectRecall::countPairs(const RecallScan& scan)
{
  pair_index_.clear(), segment_index_.clear(), object_index_.clear();
  pairs_.clear();
  segments_.assign(1, {});
  all_objects_.assign(1, {});
  range_sum_.assign(1, 0.0);
  for (std::size_t i = 0; i < scan.size; ++i)
  {
    std::uint32_t segment = 0, object = 0;
    const std::uint32_t instance = scan.found_instance[i];
    if (instance != 0) segment = 1 + segment_index_.indexOf(instance, 0);
    if (segment == segments_.size()) segments_.push_back({instance, 0, 0});

    const std::uint32_t id = scan.truth.classId(i), true_instance = scan.truth.instanceId(i);
    const ClassKind kind = table_->kindOf(id);
    if (kind == ClassKind::kThing && true_instance != 0) object = 1 + object_index_.indexOf(scan.truth.key(i), 0);
    if (object == all_objects_.size())
    {
      all_objects_.push_back({id, true_instance});
      range_sum_.push_back(0.0);
    }
    ++segments_[segment].points;
    segments_[segment].no_thing += kind != ClassKind::kThing ? 1U : 0U;
    ++all_objects_[object].points;
    range_sum_[object] += scan.range_m == nullptr ? 0.0 : static_cast<double>(scan.range_m[i]);

    const std::uint32_t pair = pair_index_.indexOf(segment, object);
    if (pair == pairs_.size()) pairs_.push_back({segment, object, 0});
    ++pairs_[pair].points;
  }
}

void ObjectRecall::countGround(const RecallScan& scan)
{
  const auto& out = config_.no_ground_truth;
  for (std::size_t i = 0; i < scan.size; ++i)
  {
    const std::uint32_t id = scan.truth.classId(i);
    if (std::find(out.begin(), out.end(), id) != out.end()) continue;
    const bool truth = is_ground_[table_->find(id)] != 0, found = scan.found_class[i] == ground_id_;
    ground_.truth += truth ? 1U : 0U, ground_.found += found ? 1U : 0U, ground_.both += truth && found ? 1U : 0U;
  }
}

void ObjectRecall::judgeObjects()
{
  struct Best
  {
    double iou = -1.0, precision = 0.0;
    std::uint32_t in_none = 0, pieces = 0;
    double entropy = 0.0;
  };
  std::vector<Best> best(all_objects_.size());
  for (const Pair& pair : pairs_)
  {
    const FoundSegment& segment = segments_[pair.segment];
    const std::uint32_t size = all_objects_[pair.object].points;
    Best& b = best[pair.object];
    b.entropy += entropyOf(pair.points, size);
    if (pair.segment == 0)
    {
      b.in_none = pair.points;
      continue;
    }
    const double iou = ratio(pair.points, std::uint64_t{size} + segment.points - pair.points);
    const double precision = ratio(pair.points, segment.points);
    if (precision > 0.5 && 10 * std::uint64_t{pair.points} >= size) ++b.pieces;
    if (iou > b.iou) b.iou = iou, b.precision = precision;
  }
  objects_.clear();
  for (std::size_t k = 1; k < all_objects_.size(); ++k)
  {
    RecalledObject& object = all_objects_[k];
    if (object.points < config_.min_points) continue;
    const Best& b = best[k];
    object.range_m = static_cast<float>(range_sum_[k] / object.points);
    object.best_iou = std::max(0.0, b.iou);
    object.outcome = object.best_iou > 0.5                          ? RecallOutcome::kFound
                     : 2 * std::uint64_t{b.in_none} > object.points ? RecallOutcome::kLost
                     : b.precision < 0.5                            ? RecallOutcome::kMerged
                     : b.pieces > 1                                 ? RecallOutcome::kSplit
                                                                    : RecallOutcome::kCut;
    over_ += b.entropy;
    objects_.push_back(object);
    count(object, all_);
    count(object, by_class_[(*table_)[table_->find(object.class_id)].name]);
    for (std::size_t bin = 0; bin < by_range_.size(); ++bin)
      if (object.range_m < config_.range_ends_m[bin])
      {
        count(object, by_range_[bin]);
        break;
      }
  }
}

void ObjectRecall::judgeSegments()
{
  for (const Pair& pair : pairs_)
    segments_[pair.segment].entropy += entropyOf(pair.points, segments_[pair.segment].points);
  last_false_.clear();
  for (std::size_t k = 1; k < segments_.size(); ++k)
  {
    const FoundSegment& segment = segments_[k];
    if (segment.points < config_.min_points) continue;
    under_ += segment.entropy;
    if (2 * std::uint64_t{segment.no_thing} <= segment.points) continue;
    last_false_.push_back({segment.instance, segment.points});
    ++false_segments_;
    false_points_ += segment.points;
  }
}

ObjectRecall& ObjectRecall::operator+=(const ObjectRecall& other)
{
  if (tied(config_) != tied(other.config_) || table_->name() != other.table_->name())
    throw std::invalid_argument("expected object recall of the same rules, found other ones");
  all_ += other.all_;
  for (const auto& [name, counts] : other.by_class_) by_class_[name] += counts;
  for (std::size_t bin = 0; bin < by_range_.size(); ++bin) by_range_[bin] += other.by_range_[bin];
  ground_.both += other.ground_.both, ground_.found += other.ground_.found, ground_.truth += other.ground_.truth;
  scan_count_ += other.scan_count_;
  false_segments_ += other.false_segments_, false_points_ += other.false_points_;
  shown_twice_ += other.shown_twice_, flips_ += other.flips_;
  over_ += other.over_, under_ += other.under_;
  return *this;
}
}  // namespace lidar_panoptic_clustering

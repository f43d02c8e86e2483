#include "lidar_panoptic_clustering/core/label_numbering.h"

#include "lidar_panoptic_clustering/core/class_mapping.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <stdexcept>

namespace lidar_panoptic_clustering
{
namespace
{
constexpr std::uint32_t kBeyond = 0x10000;  // no table has ids from here on; networks' -1 is read as 0xFFFFFFFF
constexpr std::uint16_t kNoSlot = 0xFFFF;
constexpr std::uint32_t kMinusOne = 0xFFFFFFFFU;
constexpr int kCleanScans = 10;
constexpr std::uint64_t kFirstScans = 20, kScansALook = 4;  // shapes hardly change later

/// "24 (30512 points), 28 (9033 points)", the most frequent ones.
std::string describeCounts(const std::multimap<std::size_t, std::uint32_t, std::greater<>>& ids_by_count)
{
  constexpr std::size_t kNamed = 5;
  std::string text;
  std::size_t named = 0;
  for (const auto& [count, id] : ids_by_count)
  {
    if (named++ == kNamed) return text + " and others";
    text += (text.empty() ? "" : ", ") + idText(id) + " (" + std::to_string(count) + " points)";
  }
  return text;
}

std::string percent(double share)
{
  return std::to_string(std::lround(100.0 * share)) + " %";
}
}  // namespace

std::string idText(std::uint32_t id)
{
  return id == kMinusOne ? "-1" : std::to_string(id);
}

LabelNumbering::Candidate::Candidate(std::shared_ptr<const ClassTable> class_table) : table(std::move(class_table))
{
  static const ClassTable objects = ClassTable::load("object");
  static const std::uint32_t ground = objects[objects.findByName("ground")].ids[0];
  const ClassMapping to_objects(*table, objects);
  of_class.resize(table->size());
  for (std::size_t i = 1; i < table->size(); ++i)
  {
    const ClassInfo& info = (*table)[static_cast<ClassIndex>(i)];
    Expectation& expected = of_class[i];
    if (info.kind == ClassKind::kIgnored)
      expected.shape = Shape::kNotGround;
    else if (to_objects(info.ids[0]) == ground)
      expected.shape = Shape::kFlat;
    else
      expected.shape = Shape::kStanding;
    const std::string& group = table->groupName(info.group);
    if (info.isThing() && group == "person") expected.longest_run = 0;
    if (info.isThing() && group == "two-wheeler") expected.longest_run = 1;
    if (info.isThing() && group == "vehicle") expected.longest_run = 3;
  }
}

const std::vector<LabelNumbering::Candidate>& LabelNumbering::shippedCandidates()
{
  static const std::vector<Candidate> candidates = []
  {
    std::vector<Candidate> all;
    for (const std::string& name : ClassTable::shippedNames())
      if (name != "object") all.emplace_back(std::make_shared<const ClassTable>(ClassTable::load(name)));
    return all;
  }();
  return candidates;
}

LabelNumbering::LabelNumbering(std::shared_ptr<const ClassTable> table, const Config& config)
    : own_(std::move(table)), config_(config), slot_of_id_(std::size_t{kBeyond} + 1, kNoSlot)
{
  shippedCandidates();  // read once, not in the first scan
}

void LabelNumbering::check(const LabelledCloud& image, const std::vector<std::uint32_t>& hidden)
{
  ++scan_;
  count(image, hidden);
  const bool looks = scan_ <= kFirstScans || scan_ % kScansALook == 0;
  if (config_.check_shapes && looks && image.height > 1)
  {
    lookAtShapes(image);
    lookAlongLines(image);
    forgetHalf();
  }
  requireIds();
  requireShapes();
  describeDoubt();
}

LabelNumbering::Seen& LabelNumbering::seen(std::uint32_t id)
{
  std::uint16_t& slot = slot_of_id_[std::min(id, kBeyond)];
  if (slot != kNoSlot) return seen_[slot];
  slot = static_cast<std::uint16_t>(std::min<std::size_t>(seen_.size(), kNoSlot - 1));
  if (slot == seen_.size()) seen_.emplace_back();
  Seen& added = seen_[slot];
  added.id = id;
  const bool known = own_.table->find(id) != kUnknownClass;
  const bool no_class = id == 0 || (id == kMinusOne && own_.table->ignoresMinusOne());
  added.lacking = !known && !no_class;
  added.distinctive = known;
  for (const Candidate& other : shippedCandidates())
    if (other.table->name() != own_.table->name() && other.table->find(id) != kUnknownClass) added.distinctive = false;
  return added;
}

void LabelNumbering::count(const LabelledCloud& image, const std::vector<std::uint32_t>& hidden)
{
  const auto add = [this](std::uint32_t id, std::size_t returns)
  {
    Seen& entry = seen(id);
    if (entry.scan != scan_) entry.scan = scan_, entry.returns = 0;
    entry.returns += returns;
  };
  // neighbours mostly have the same id
  std::uint32_t last = 0;
  std::size_t same = 0;
  const auto next = [&](std::uint32_t id)
  {
    if (id != last && same > 0) add(last, same), same = 0;
    last = id;
    ++same;
  };
  for (const LabelledPoint& point : image.points)
    if (isReturn(point)) next(point.label);
  for (const std::uint32_t id : hidden) next(id);
  if (same > 0) add(last, same);
}

/// Names all ids so far, none of which looks like something else, and has things among them.
bool LabelNumbering::fits(const Candidate& candidate) const
{
  bool thing = false;
  for (const Seen& id : seen_)
  {
    if (id.id == kMinusOne && candidate.table->ignoresMinusOne()) continue;
    const ClassIndex index = candidate.table->find(id.id);
    if ((index == kUnknownClass && id.id != 0) || misfit(id, candidate) != Misfit::kNone) return false;
    thing = thing || (*candidate.table)[index].isThing();
  }
  return thing;
}

/// "; the ids so far (0, 6, 9) fit the table 'a' or 'b': set label_table to it", those first whose road has most of the
/// flat ground.
std::string LabelNumbering::fittingTables() const
{
  std::multimap<double, std::string, std::greater<>> by_road;
  for (const Candidate& other : shippedCandidates())
  {
    if (other.table->name() == own_.table->name() || !fits(other)) continue;
    double road = 0.0;
    for (const Seen& id : seen_)
    {
      const std::string& name = (*other.table)[other.table->find(id.id)].name;
      if (name == "road" || name == "driveable_surface") road += id.flat;
    }
    by_road.emplace(road, other.table->name());
  }
  std::string names;
  for (const auto& [road, name] : by_road) names += (names.empty() ? "'" : ", '") + name + "'";
  if (names.empty())
    return "; none of the tables that ship fits the ids so far (" + seenIds() +
           "): write one of your own and set label_table to its path";
  return "; the ids so far (" + seenIds() + ") fit " + names + ": set label_table";
}

std::string LabelNumbering::seenIds() const
{
  constexpr std::size_t kNamed = 24;
  std::vector<std::int64_t> ids;
  for (const Seen& id : seen_) ids.push_back(id.id == kMinusOne ? -1 : static_cast<std::int64_t>(id.id));
  std::sort(ids.begin(), ids.end());
  std::string text;
  for (std::size_t i = 0; i < ids.size() && i < kNamed; ++i) text += (i == 0 ? "" : ", ") + std::to_string(ids[i]);
  return text + (ids.size() > kNamed ? ", ..." : "");
}

std::string LabelNumbering::expectedTable() const
{
  return "expected class ids of the table '" + own_.table->name() + "' (parameter label_table" +
         (config_.chosen ? ")" : ", which is not set)");
}

void LabelNumbering::requireIds()
{
  std::size_t labelled = 0, lacking = 0;
  bool distinctive = false;
  for (const Seen& id : seen_)
  {
    distinctive = distinctive || id.distinctive;
    if (id.scan != scan_ || (id.id == 0 && own_.table->kindOf(0) == ClassKind::kIgnored)) continue;
    if (id.lacking) lacking += id.returns;
    if (id.lacking || own_.table->find(id.id) != kUnknownClass) labelled += id.returns;
  }
  if (static_cast<double>(lacking) > config_.max_unknown_labels * static_cast<double>(labelled))
  {
    lacking_ = true, clean_scans_ = 0;
    std::multimap<std::size_t, std::uint32_t, std::greater<>> by_count;
    for (const Seen& id : seen_)
      if (id.scan == scan_ && id.lacking) by_count.emplace(id.returns, id.id);
    throw std::invalid_argument(expectedTable() + ", found that " + std::to_string(lacking) + " of " +
                                std::to_string(labelled) +
                                " labelled returns have others: " + describeCounts(by_count) + fittingTables());
  }
  if (config_.chosen && ++clean_scans_ >= kCleanScans) lacking_ = false;
  if (!lacking_ || distinctive) return;
  std::string others;
  for (const Seen& id : seen_)
    if (id.lacking && others.size() < 40) others += (others.empty() ? "" : ", ") + idText(id.id);
  throw std::invalid_argument(expectedTable() + ", found that scans before this one had others: " + others +
                              fittingTables());
}

void LabelNumbering::requireShapes() const
{
  if (!config_.check_shapes) return;
  for (const Seen& id : seen_)
  {
    const Misfit found = misfit(id, own_);
    if (found == Misfit::kNone) continue;
    const auto longest = static_cast<std::size_t>(std::max(0, own_.of_class[own_.table->find(id.id)].longest_run));
    const std::string looks =
        found == Misfit::kFlat ? "is as flat as the ground in " + percent(id.flat / id.pairs) + " of the places"
        : found == Misfit::kUpright
            ? "stands upright in " + percent(id.steep / id.pairs) + " of the places"
            : "has " + percent(id.long_run_points[longest] / id.run_points) + " of its points in pieces longer than " +
                  std::to_string(std::lround(kRunLengths[longest])) + " m";
    throw std::invalid_argument(expectedTable() + ", found that id " + idText(id.id) + ", '" +
                                (*own_.table)[own_.table->find(id.id)].name + "' there, " + looks + fittingTables() +
                                ", or check_label_shapes to false where it is right");
  }
}

void LabelNumbering::describeDoubt()
{
  if (config_.chosen || (seen_.size() == described_ && scan_ % 10 != 0)) return;
  described_ = seen_.size();
  std::string others;
  for (const Candidate& other : shippedCandidates())
    if (other.table->name() != own_.table->name() && fits(other)) others += ", '" + other.table->name() + "'";
  doubt_ = others.empty() ? ""
                          : "the label ids so far (" + seenIds() + ") fit several tables: taken for '" +
                                own_.table->name() + "', fit " + others.substr(2) + " as well: set label_table";
}
}  // namespace lidar_panoptic_clustering

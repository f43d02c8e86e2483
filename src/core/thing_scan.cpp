#include "lidar_panoptic_clustering/core/thing_scan.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>

namespace lidar_panoptic_clustering
{
namespace
{
constexpr double kPi = 3.14159265358979323846;
constexpr std::size_t kMaxUnknownLabels = 16;

bool isReturn(const LabelledPoint& p, float max_squared_range)
{
  const float squared_range = p.x * p.x + p.y * p.y + p.z * p.z;
  return squared_range > 0.0F && squared_range <= max_squared_range;  // false for NaN and infinity
}

/// Link key by class index, 0..count-1 over the thing classes: what the policy calls the same.
std::array<std::uint8_t, 256> linkKeys(const ClassTable& table, ClassPolicy policy, std::uint32_t& count)
{
  std::array<std::uint8_t, 256> keys{};
  std::array<int, 256> key_of_group;
  key_of_group.fill(-1);
  count = 0;
  for (std::size_t c = 0; c < table.size(); ++c)
  {
    const ClassInfo& info = table[static_cast<ClassIndex>(c)];
    if (!info.isThing()) continue;
    int& shared = key_of_group[policy == ClassPolicy::kGroup ? info.group : 0];
    if (shared < 0 || policy == ClassPolicy::kClass) shared = static_cast<int>(count++);
    keys[c] = static_cast<std::uint8_t>(shared);
  }
  return keys;
}

/// Between neighbouring columns, where they span a turn [rad].
float fullTurnAngle(std::uint32_t columns)
{
  return static_cast<float>(2.0 * kPi / std::max(1U, columns));
}

void noteUnknown(std::vector<std::uint32_t>& labels, std::uint32_t label)
{
  if (labels.size() < kMaxUnknownLabels && std::find(labels.begin(), labels.end(), label) == labels.end())
    labels.push_back(label);
}
}  // namespace

const std::vector<std::string>& fieldOfViewNames()
{
  static const std::vector<std::string> names = {"auto", "full_turn", "sector"};
  return names;
}

float measureColumnAngle(const LabelledCloud& cloud, float max_range_m)
{
  constexpr std::uint32_t kRows = 8, kSamples = 32, kWidestGap = 8;  // the latter: one in so many columns
  constexpr int kEnough = 64;
  const float max_squared_range = max_range_m * max_range_m;
  const std::uint32_t row_step = std::max(1U, cloud.height / kRows), step = std::max(1U, cloud.width / kSamples);
  double turned = 0.0, columns = 0.0;
  int pairs = 0;
  for (std::uint32_t row = row_step / 2; row < cloud.height; row += row_step)
  {
    const LabelledPoint* line = cloud.points.data() + static_cast<std::size_t>(row) * cloud.width;
    std::uint32_t last = cloud.width;
    double line_turned = 0.0, line_columns = 0.0;
    for (std::uint32_t column = 0; column < cloud.width; column += step)
    {
      if (!isReturn(line[column], max_squared_range)) continue;
      if (last < column && (column - last == step || (column - last) * kWidestGap <= cloud.width))
      {
        const LabelledPoint &a = line[last], &b = line[column];
        line_turned += std::atan2(a.x * b.y - a.y * b.x, a.x * b.x + a.y * b.y);
        line_columns += column - last;
        ++pairs;
      }
      last = column;
    }
    turned += std::abs(line_turned), columns += line_columns;
  }
  return pairs < kEnough ? 0.0F : static_cast<float>(turned / columns);
}

const std::vector<std::string>& classPolicyNames()
{
  static const std::vector<std::string> names = {"class", "group", "any"};
  return names;
}

ClassPolicy classPolicyFromName(const std::string& name)
{
  const auto& names = classPolicyNames();
  const auto found = std::find(names.begin(), names.end(), name);
  if (found == names.end()) throw std::invalid_argument("class_policy is '" + name + "', expected class, group or any");
  return static_cast<ClassPolicy>(found - names.begin());
}

bool closesOnItself(const std::string& field_of_view, float column_angle, std::uint32_t columns)
{
  constexpr float kNearlyAll = 0.9F;
  if (field_of_view != "auto") return field_of_view == "full_turn";
  return column_angle == 0.0F || column_angle > kNearlyAll * fullTurnAngle(columns);
}

namespace
{
void findFieldOfView(const LabelledCloud& cloud, const SelectionConfig& config, ThingScan& scan)
{
  scan.column_angle = fullTurnAngle(scan.columns);
  scan.full_turn = true;
  if (config.field_of_view == "full_turn") return;
  const float measured = measureColumnAngle(cloud, static_cast<float>(config.max_range_m));
  scan.full_turn = closesOnItself(config.field_of_view, measured, scan.columns);
  if (!scan.full_turn) scan.column_angle = measured;
}
}  // namespace

namespace
{
/// What the class table says of a raw id, looked up anew only where it is another one than the point's before.
class LabelLookUp
{
public:
  explicit LabelLookUp(const ClassTable& table) : table_(table) {}
  /// Whether it is another id than before.
  bool look(std::uint32_t label)
  {
    if (label == label_ && is_known_) return false;
    label_ = label, is_known_ = true;
    kind = table_.kindOf(label);
    class_index = table_.find(label);
    rgb = table_.rgbOf(label);
    return true;
  }

  ClassKind kind = ClassKind::kIgnored;
  ClassIndex class_index = kUnknownClass;
  std::uint32_t rgb = 0;

private:
  const ClassTable& table_;
  std::uint32_t label_ = 0;
  bool is_known_ = false;
};

/// A point in its class's colour: two stores of 16 bytes.
void copyPoint(const LabelledPoint& from, std::uint32_t rgb, PanopticPoint& to)
{
  to.getVector4fMap() = from.getVector4fMap();
  to.intensity = from.intensity;
  to.label = from.label;
  to.instance = 0;
  to.rgb = rgb;
}

void copyFrame(const LabelledCloud& cloud, PanopticCloud& out)
{
  out.header = cloud.header;
  out.width = cloud.width, out.height = cloud.height;
  out.is_dense = cloud.is_dense;
  out.sensor_origin_ = cloud.sensor_origin_, out.sensor_orientation_ = cloud.sensor_orientation_;
  out.points.resize(cloud.points.size());
}

/// The things of some pixels, which the scan takes over together.
struct Batch
{
  static constexpr std::uint32_t kPixels = 256;

  ThingPoint points[kPixels];
  std::uint8_t link[kPixels];
  ClassIndex class_index[kPixels];
  std::uint32_t count = 0;

  void moveInto(ThingScan& scan)
  {
    scan.points.insert(scan.points.end(), points, points + count);
    scan.link.insert(scan.link.end(), link, link + count);
    scan.class_index.insert(scan.class_index.end(), class_index, class_index + count);
    count = 0;
  }
};

void beginScan(const LabelledCloud& cloud, const ClassTable& table, const SelectionConfig& config, ThingScan& scan)
{
  const std::size_t pixels = static_cast<std::size_t>(cloud.width) * cloud.height;
  if (cloud.points.size() != pixels)
    throw std::invalid_argument("cloud is " + std::to_string(cloud.width) + " x " + std::to_string(cloud.height) +
                                " (width x height) but holds " + std::to_string(cloud.points.size()) + " points");
  scan.class_link_distance.resize(table.size());
  for (std::size_t c = 0; c < table.size(); ++c)
    scan.class_link_distance[c] =
        static_cast<float>(config.link_distance_scale) * table[static_cast<ClassIndex>(c)].link_distance_m;
  scan.class_count = static_cast<std::uint32_t>(table.size());
  scan.rows = cloud.height, scan.columns = cloud.width;
  scan.points.clear(), scan.link.clear(), scan.class_index.clear(), scan.unknown_labels.clear();
  scan.line_begin.resize(scan.rows + 1);
  findFieldOfView(cloud, config, scan);
}

/// One pass over the cloud; `copy(k, rgb)` is called for its k-th point.
template <class Copy>
void select(const LabelledCloud& cloud, const ClassTable& table, const SelectionConfig& config, ThingScan& scan,
            const Copy& copy)
{
  const auto max_squared_range = static_cast<float>(config.max_range_m * config.max_range_m);
  const auto keys = linkKeys(table, classPolicyFromName(config.class_policy), scan.link_count);
  constexpr std::size_t kAhead = 64;  // 2 KB: the processor's own guesses end with the page
  LabelLookUp of(table);
  Batch batch;
  std::size_t k = 0;
  for (std::uint32_t row = 0; row < scan.rows; ++row)
  {
    scan.line_begin[row] = static_cast<std::uint32_t>(scan.points.size());
    for (std::uint32_t begin = 0; begin < scan.columns; begin += Batch::kPixels)
    {
      const std::uint32_t end = std::min(begin + Batch::kPixels, scan.columns);
      for (std::uint32_t column = begin; column < end; ++column, ++k)
      {
        const LabelledPoint& p = cloud.points[k];
        if (of.look(p.label) && of.kind == ClassKind::kIgnored && of.class_index == kUnknownClass)
          noteUnknown(scan.unknown_labels, p.label);
        __builtin_prefetch(cloud.points.data() + k + kAhead);
        copy(k, of.rgb);
        if (of.kind != ClassKind::kThing || !isReturn(p, max_squared_range)) continue;
        batch.points[batch.count] = {p.x, p.y, p.z, column};
        batch.link[batch.count] = keys[of.class_index];
        batch.class_index[batch.count++] = of.class_index;
      }
      if (batch.count > 0) batch.moveInto(scan);
    }
  }
  scan.line_begin[scan.rows] = static_cast<std::uint32_t>(scan.points.size());
}
}  // namespace

void selectThings(const LabelledCloud& cloud, const ClassTable& table, const SelectionConfig& config, ThingScan& scan)
{
  beginScan(cloud, table, config, scan);
  select(cloud, table, config, scan, [](std::size_t, std::uint32_t) {});
}

void selectThings(const LabelledCloud& cloud, const ClassTable& table, const SelectionConfig& config, ThingScan& scan,
                  PanopticCloud& out)
{
  beginScan(cloud, table, config, scan);
  copyFrame(cloud, out);
  PanopticPoint* const to = out.points.data();
  select(cloud, table, config, scan,
         [&cloud, to](std::size_t k, std::uint32_t rgb) { copyPoint(cloud.points[k], rgb, to[k]); });
}

void copyInClassColors(const LabelledCloud& cloud, const ClassTable& table, PanopticCloud& out)
{
  copyFrame(cloud, out);
  LabelLookUp of(table);
  for (std::size_t k = 0; k < cloud.points.size(); ++k)
  {
    of.look(cloud.points[k].label);
    copyPoint(cloud.points[k], of.rgb, out.points[k]);
  }
}
}  // namespace lidar_panoptic_clustering

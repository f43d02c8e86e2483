#include "lidar_panoptic_clustering/projection/sensor_model.h"

#include "core/plain_numbers.h"
#include "core/yaml_source.h"
#include "shipped_files.h"

#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace lidar_panoptic_clustering
{
namespace
{
constexpr double kPi = 3.14159265358979323846;
constexpr double kAlmostNothing = 1e-6;                 // [rad]: far less than a column
constexpr double kLeastFov = 0.1 * kPi / 180.0 - 1e-9;  // [rad]
constexpr std::uint32_t kMaxRows = 4096, kMaxColumns = 65536;
constexpr float kMaxRange = 10000.0F, kMaxNoise = 100.0F, kLeastHeight = 0.01F, kMaxHeight = 1000.0F;  // [m]

/// Reads one sensor file; `source` begins each message.
class SensorReader
{
public:
  SensorReader(const YAML::Node& root, const std::string& source) : root_(root), source_(source)
  {
    if (!root.IsMap()) throw std::invalid_argument(source + ": expected a map with 'elevations_deg' and 'columns'");
  }

  SensorModel read()
  {
    SensorModel model;
    model.name = source_;
    optional("name", "a name", model.name);
    const auto elevations = required<std::vector<double>>("elevations_deg", "a list of angles, the highest first");
    std::transform(elevations.begin(), elevations.end(), std::back_inserter(model.elevations_rad),
                   [](double degrees) { return static_cast<float>(degrees * kPi / 180.0); });
    model.columns = readColumns();
    double fov_deg = 360.0;
    optional("horizontal_fov_deg", "an angle", fov_deg);
    model.horizontal_fov_rad = fov_deg * kPi / 180.0;
    optional("min_range_m", "a distance", model.min_range_m);
    optional("max_range_m", "a distance", model.max_range_m);
    optional("range_noise_m", "a distance", model.range_noise_m);
    optional("dropout", "a probability", model.dropout);
    optional("mount_height_m", "a height", model.mount_height_m);
    refuseOtherKeys();
    return model;
  }

private:
  std::uint32_t readColumns()
  {
    const auto columns = required<std::int64_t>("columns", "the number of firings");
    if (columns < 1 || columns > kMaxColumns)
      throw std::invalid_argument(source_ + ": columns: expected 1 to " + std::to_string(kMaxColumns) + ", found " +
                                  std::to_string(columns));
    return static_cast<std::uint32_t>(columns);
  }

  template <class T>
  T required(const std::string& key, const std::string& expected)
  {
    if (!root_[key]) throw std::invalid_argument(source_ + ": has no '" + key + "', expected " + expected);
    T value{};
    optional(key, expected, value);
    return value;
  }

  template <class T>
  void optional(const std::string& key, const std::string& expected, T& value)
  {
    known_.push_back(key);
    const YAML::Node node = root_[key];
    if (!node) return;
    if (!readYaml(node, value))
      throw std::invalid_argument(source_ + ": '" + key + "': expected " + expected + ", found " + describeYaml(node));
  }

  void refuseOtherKeys() const
  {
    for (const auto& entry : root_)
    {
      const auto key = entry.first.as<std::string>();
      if (std::find(known_.begin(), known_.end(), key) != known_.end()) continue;
      std::string list;
      for (const auto& name : known_) list += ", " + name;
      throw std::invalid_argument(source_ + ": unknown key '" + key + "', expected one of" + list.substr(1));
    }
  }

  const YAML::Node root_;  // const: looking up a key must not add it
  const std::string& source_;
  std::vector<std::string> known_;
};
}  // namespace

bool SensorModel::fullTurn() const
{
  return horizontal_fov_rad > 2.0 * kPi - kAlmostNothing;
}

float SensorModel::azimuth(std::uint32_t column) const
{
  return static_cast<float>(0.5 * horizontal_fov_rad - (column + 0.5) * horizontal_fov_rad / columns);
}

SensorModel SensorModel::load(const std::string& name_or_path)
{
  const YamlSource yaml = readYamlSource("sensor", shippedSensors(), name_or_path);
  return parse(yaml.text, yaml.source);
}

SensorModel SensorModel::parse(const std::string& yaml, const std::string& source)
try
{
  SensorModel model = SensorReader(parseYaml(yaml, source), source).read();
  validateSensorModel(model, source);
  return model;
}
catch (const YAML::Exception& error)
{
  throw std::invalid_argument(source + ": " + error.what());
}

std::vector<std::string> SensorModel::shippedNames()
{
  return namesOf(shippedSensors());
}

void validateSensorModel(const SensorModel& model, const std::string& source)
{
  const auto require = [&source](bool holds, const std::string& member, const std::string& expected, double value)
  {
    if (!holds)
      throw std::invalid_argument(source + ": " + member + ": expected " + expected + ", found " + shortText(value));
  };
  const auto degrees = [](double radians) { return radians * 180.0 / kPi; };

  require(model.rows() > 0 && model.rows() <= kMaxRows, "number of elevations", "1 to " + shortText(kMaxRows),
          model.rows());
  for (std::size_t i = 0; i < model.elevations_rad.size(); ++i)
  {
    const float elevation = model.elevations_rad[i];
    const std::string member = "elevation of ring " + std::to_string(i);
    require(std::abs(elevation) < kPi / 2, member, "an angle between -90 and 90 degrees", degrees(elevation));
    if (i == 0) continue;
    const float above = model.elevations_rad[i - 1];
    require(elevation < above, member, "less than the ring's before, " + shortText(degrees(above)), degrees(elevation));
  }
  require(model.columns > 0 && model.columns <= kMaxColumns, "columns", "1 to " + shortText(kMaxColumns),
          model.columns);
  const double fov = model.horizontal_fov_rad;
  require(fov >= kLeastFov && fov <= 2.0 * kPi + kAlmostNothing, "horizontal field of view", "0.1 to 360 degrees",
          degrees(fov));
  require(model.min_range_m >= 0.0F, "min_range_m", "0 or more", model.min_range_m);
  require(model.max_range_m > model.min_range_m && model.max_range_m <= kMaxRange, "max_range_m",
          "more than min_range_m and at most 10000", model.max_range_m);
  require(model.range_noise_m >= 0.0F && model.range_noise_m <= kMaxNoise, "range_noise_m", "0 to 100",
          model.range_noise_m);
  require(model.dropout >= 0.0F && model.dropout <= 1.0F, "dropout", "a probability", model.dropout);
  require(model.mount_height_m >= kLeastHeight && model.mount_height_m <= kMaxHeight, "mount_height_m", "0.01 to 1000",
          model.mount_height_m);
}
}  // namespace lidar_panoptic_clustering

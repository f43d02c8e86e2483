#include "lidar_panoptic_clustering/projection/scan_fields.h"

#include <algorithm>
#include <array>
#include <cstring>
#include <stdexcept>

namespace lidar_panoptic_clustering
{
namespace
{
/// Names in common use, the likeliest first, and the parameter that names another.
struct UsualNames
{
  const char* parameter;
  const char* content;
  std::array<const char*, 13> names;  ///< null for none
};

// Autoware: class_id; ouster-ros and Livox: reflectivity; SemanticKITTI: remission; kitti2bag: i; SICK: intensities;
// hesai, robosense and ouster-ros: ring
constexpr UsualNames kLabel = {"label_field", "class ids", {"label", "class_id", "semantic", "class"}};
constexpr UsualNames kIntensity = {
    "intensity_field",
    "intensities",
    {"intensity", "reflectivity", "remission", "i", "intensities", "reflectance", "remissions", "Intensity",
     "Reflectivity", "Remission", "Reflectance", "I", "INTENSITY"}};
constexpr UsualNames kRing = {"ring_field", "ring numbers", {"ring", "channel"}};

const RawField* find(const RawCloud& cloud, const char* name)
{
  for (const auto& field : cloud.fields)
    if (field.name == name) return &field;
  return nullptr;
}

const RawField* find(const RawCloud& cloud, const std::string& given, const UsualNames& usual)
{
  if (!given.empty())
  {
    const RawField* field = find(cloud, given.c_str());
    if (field == nullptr)
      throw std::invalid_argument("expected a field '" + given + "' with " + usual.content +
                                  " (named by the parameter " + usual.parameter + "), found " + describeFields(cloud));
    return field;
  }
  for (const char* name : usual.names)
    if (const RawField* field = name != nullptr ? find(cloud, name) : nullptr) return field;
  return nullptr;
}

[[noreturn]] void throwMissing(const RawCloud& cloud, const UsualNames& usual)
{
  std::string text = "expected a field";
  for (const char* name : usual.names)
    if (name != nullptr) text += (name == usual.names[0] ? " '" : ", '") + std::string(name) + '\'';
  throw std::invalid_argument(text + " or one named by the parameter " + usual.parameter + ", with " + usual.content +
                              ", found " + describeFields(cloud));
}

const RawField* findCoordinate(const RawCloud& cloud, const char* name)
{
  const RawField* field = find(cloud, name);
  if (field == nullptr)
    throw std::invalid_argument(std::string("expected a field '") + name + "', found " + describeFields(cloud));
  return field;
}

bool isFloat(const RawField* field)
{
  return field != nullptr && field->type() == NumberType::kFloat32;
}

/// Whether the coordinates are float32 and lie one after the other, as of nearly all drivers.
bool areFloatsInARow(const ScanFields& fields)
{
  return isFloat(fields.x) && isFloat(fields.y) && isFloat(fields.z) &&
         fields.y->offset == fields.x->offset + sizeof(float) && fields.z->offset == fields.y->offset + sizeof(float);
}

/// These, and an intensity of the same type, in one go; without one the intensities are 0.
void copyPoints(const PointRun& run, const ScanFields& fields, ScanPoint* to)
{
  constexpr float kNone = 0.0F;
  const bool has_intensity = isFloat(fields.intensity);
  const std::uint8_t* place = run.first + fields.x->offset;
  const std::uint8_t* intensity =
      has_intensity ? run.first + fields.intensity->offset : reinterpret_cast<const std::uint8_t*>(&kNone);
  const std::size_t step = has_intensity ? run.step : 0;
  for (std::size_t i = 0; i < run.count; ++i, ++to, place += run.step, intensity += step)
  {
    std::memcpy(&to->x, place, 3 * sizeof(float));
    std::memcpy(&to->remission, intensity, sizeof(float));
  }
}

void readPoints(const PointRun& run, const ScanFields& fields, bool in_a_row, ScanPoint* to)
{
  if (in_a_row)
  {
    copyPoints(run, fields, to);
    if (fields.intensity == nullptr || isFloat(fields.intensity)) return;
  }
  else
  {
    readFloats(run, *fields.x, &to->x, sizeof(ScanPoint));
    readFloats(run, *fields.y, &to->y, sizeof(ScanPoint));
    readFloats(run, *fields.z, &to->z, sizeof(ScanPoint));
  }
  if (fields.intensity != nullptr)
    readFloats(run, *fields.intensity, &to->remission, sizeof(ScanPoint));
  else
    for (std::size_t i = 0; i < run.count; ++i) to[i].remission = 0.0F;
}
}  // namespace

const RawField& findLabelField(const RawCloud& cloud, const std::string& name)
{
  const RawField* field = find(cloud, name, kLabel);
  if (field == nullptr) throwMissing(cloud, kLabel);
  return *field;
}

ScanFields findScanFields(const RawCloud& cloud, const FieldNames& names, bool with_labels)
{
  checkSizes(cloud);
  ScanFields fields;
  fields.x = findCoordinate(cloud, "x");
  fields.y = findCoordinate(cloud, "y");
  fields.z = findCoordinate(cloud, "z");
  if (with_labels) fields.label = &findLabelField(cloud, names.label);
  fields.intensity = find(cloud, names.intensity, kIntensity);
  fields.ring = find(cloud, names.ring, kRing);
  for (const RawField* field : {fields.x, fields.y, fields.z, fields.label, fields.intensity, fields.ring})
    if (field != nullptr) checkField(cloud, *field);
  return fields;
}

void readScan(const RawCloud& cloud, const ScanFields& fields, std::size_t row, std::size_t column, std::size_t count,
              ScanPoint* points, std::uint32_t* labels)
{
  const bool in_a_row = areFloatsInARow(fields);
  constexpr std::size_t kRun = 256;  // all fields of a run are read from the cache
  for (std::size_t begin = 0; begin < count; begin += kRun)
  {
    const PointRun run{cloud.point(row, column + begin), cloud.point_step, std::min(kRun, count - begin)};
    readPoints(run, fields, in_a_row, points + begin);
    if (fields.label != nullptr)
      readIds(run, *fields.label, labels + begin, sizeof(std::uint32_t));
    else
      std::fill_n(labels + begin, run.count, 0U);
  }
}
}  // namespace lidar_panoptic_clustering

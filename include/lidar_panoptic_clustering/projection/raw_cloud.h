#pragma once

#include "lidar_panoptic_clustering/core/point_types.h"

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace lidar_panoptic_clustering
{
/// The number types of sensor_msgs/PointField, with its codes.
enum class NumberType : std::uint8_t
{
  kInt8 = 1,
  kUint8 = 2,
  kInt16 = 3,
  kUint16 = 4,
  kInt32 = 5,
  kUint32 = 6,
  kFloat32 = 7,
  kFloat64 = 8
};

/// One field of a point as the sender describes it; nothing of it is to be believed before checkLayout().
struct RawField
{
  std::string name;           ///< as in the message
  std::uint32_t offset = 0;   ///< bytes from the point's start; may be odd
  std::uint8_t datatype = 0;  ///< a NumberType, or anything
  std::uint32_t count = 1;    ///< elements; the first one is read

  /// To be asked only where the datatype is known to be one.
  NumberType type() const { return static_cast<NumberType>(datatype); }
};

/// A cloud as it comes over the wire (sensor_msgs/PointCloud2), without its header: a view that owns no data.
///
/// Row r, column c starts at data + r * row_step + c * point_step; rows may be padded, points may be packed.
struct RawCloud
{
  std::uint32_t width = 0, height = 0;         ///< in points
  std::uint32_t point_step = 0, row_step = 0;  ///< bytes
  bool is_bigendian = false;                   ///< such clouds are refused
  std::vector<RawField> fields;                ///< in any order
  const std::uint8_t* data = nullptr;          ///< height rows of row_step bytes; not owned
  std::size_t data_size = 0;                   ///< bytes

  /// The first byte of a point; has to lie inside.
  const std::uint8_t* point(std::size_t row, std::size_t column) const
  {
    return data + row * row_step + column * point_step;
  }
};

/// The rows an empty cloud may claim to have (its columns likewise): enough for any lidar, harmless to loop over.
constexpr std::uint32_t kMaxEmptySide = 65536;

/// The label of points whose own is no class id: negative, fractional, not finite or beyond 32 bits.
constexpr std::uint32_t kUnreadableLabel = 0xFFFFFFFFU;

/// "x float32, y float32, label uint8", for messages.
std::string describeFields(const RawCloud& cloud);

/// Bytes of one number of a field's datatype; 0 for a datatype that is none.
std::uint32_t bytesOfType(std::uint8_t datatype);

/// The field called `name`, the first where there are several; nullptr where there is none.
const RawField* findField(const RawCloud& cloud, const std::string& name);

/// Checks byte order, point_step, row_step and the size of the data against each other. Throws std::invalid_argument
/// that says what was expected and what was found.
void checkSizes(const RawCloud& cloud);

/// Checks a field's type, count and place inside the point; throws likewise.
void checkField(const RawCloud& cloud, const RawField& field);

/// Makes sure that reading the named fields of every point stays inside the data.
///
/// Checks byte order, point_step, row_step, size of data, and of the `required` fields and those `optional` ones that
/// are there: type, count and place inside the point. Fields nobody reads may be as odd as they like. Throws
/// std::invalid_argument that says what was expected and what was found.
void checkLayout(const RawCloud& cloud, const std::vector<std::string>& required,
                 const std::vector<std::string>& optional = {});

/// `count` points, `step` bytes from one to the next: a piece of a row, or of a column.
struct PointRun
{
  const std::uint8_t* first = nullptr;  ///< the first point of the run
  std::size_t step = 0;                 ///< bytes from one point to the next
  std::size_t count = 0;                ///< number of points
};

/// Reads a field of any number type as float, into a member of consecutive points `out_step` bytes apart.
/// A float64 beyond float's range becomes infinite. Field and run must have passed checkLayout().
void readFloats(const PointRun& run, const RawField& field, float* out, std::size_t out_step);

/// Reads a field of any number type as class or instance id; kUnreadableLabel for values that are none.
void readIds(const PointRun& run, const RawField& field, std::uint32_t* out, std::size_t out_step);

/// The names under which a sender may have the fields of a LabelledPoint.
struct LabelledFields
{
  std::string x = "x", y = "y", z = "z";  ///< names of the coordinates' fields
  std::string intensity = "intensity";    ///< may be absent, then 0
  std::string label = "label";            ///< name of the field with the class ids
};

enum class RowOrder
{
  kAsSent,
  kTransposed  ///< the sender's rows become columns
};

/// Reads x, y, z, intensity and label of any types and layout. The header is left alone; is_dense is set to false.
///
/// Throws std::invalid_argument as checkLayout() does. Linear in the points; the cloud's memory is reused.
void readLabelled(const RawCloud& raw, const LabelledFields& names, LabelledCloud& cloud,
                  RowOrder order = RowOrder::kAsSent);

/// The same with `instance` required (0, no instance, where it is no id) and `rgb` taken where it is there (a float32
/// for its bits, as PCL sends colours).
void readPanoptic(const RawCloud& raw, PanopticCloud& cloud);
}  // namespace lidar_panoptic_clustering

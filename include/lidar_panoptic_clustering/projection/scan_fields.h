#pragma once

#include "lidar_panoptic_clustering/projection/point_projection.h"
#include "lidar_panoptic_clustering/projection/raw_cloud.h"

#include <string>

namespace lidar_panoptic_clustering
{
/// What the sender calls its fields; an empty name stands for the first of the usual ones that is there.
struct FieldNames
{
  std::string label;      ///< usual: label, class_id, semantic, class
  std::string intensity;  ///< usual: intensity, reflectivity, remission, i, intensities, reflectance, capitalised too
  std::string ring;       ///< usual: ring, channel
};

/// The fields of one message that make a scan; pointers into RawCloud::fields.
struct ScanFields
{
  const RawField *x = nullptr, *y = nullptr, *z = nullptr;
  const RawField* label = nullptr;      ///< null where labels come from elsewhere
  const RawField* intensity = nullptr;  ///< null where it is not sent
  const RawField* ring = nullptr;       ///< null where it is not sent
};

/// The field with the class ids, by FieldNames::label. Throws std::invalid_argument, with what was expected and found,
/// where there is none; its place in the point is not checked.
const RawField& findLabelField(const RawCloud& cloud, const std::string& name);

/// Finds the fields and makes sure that reading them at every point stays inside the data. Allocates nothing.
///
/// `with_labels`: whether the cloud has to carry class ids. Throws std::invalid_argument, with what was expected and
/// found, as checkLayout() does, when x, y, z or the label are missing, and when a field with a given name is.
ScanFields findScanFields(const RawCloud& cloud, const FieldNames& names, bool with_labels);

/// Reads the points [column, column + count) of a row; labels are kUnreadableLabel where they are no ids, and 0 where
/// there are none in the cloud. A missing intensity is 0.
void readScan(const RawCloud& cloud, const ScanFields& fields, std::size_t row, std::size_t column, std::size_t count,
              ScanPoint* points, std::uint32_t* labels);
}  // namespace lidar_panoptic_clustering

#pragma once

#include "lidar_panoptic_clustering/core/class_mapping.h"
#include "lidar_panoptic_clustering/core/class_table.h"
#include "lidar_panoptic_clustering/labelling/ground_labeler.h"
#include "lidar_panoptic_clustering/projection/organized_scan.h"
#include "lidar_panoptic_clustering/projection/separate_labels.h"

#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace lidar_panoptic_clustering
{
/// Where the classes come from, and what they are turned into.
struct ScanLabellerConfig
{
  std::string labels = "field";     ///< of the cloud; or image, cloud: of their own topic; or none: from the geometry
  std::string label_table;          ///< of the labels that come; empty: semantic_kitti, for none always object
  std::string class_table;          ///< of the labels that go out; empty: the same
  double max_unknown_labels = 0.5;  ///< share of the labelled returns above which a scan's labels are of another table
  GroundLabelerConfig ground;

  template <class Self, class Visitor>
  static void visit(Self& self, Visitor&& visitor)
  {
    visitor("labels", self.labels, std::vector<std::string>{"field", "image", "cloud", "none"});
    visitor("label_table", self.label_table, std::vector<std::string>{});
    visitor("class_table", self.class_table, std::vector<std::string>{});
    visitor("max_unknown_labels", self.max_unknown_labels, 0.0, 1.0);
    GroundLabelerConfig::visit(self.ground, visitor);
  }

  /// Labels come on a topic of their own.
  bool separate() const { return labels == "image" || labels == "cloud"; }
};

/// Gives an organised scan its classes, as raw ids of the table clustered with.
///
/// Each function throws std::invalid_argument, with what was expected and found, when the labels do not fit the scan or
/// the share of ids that their table does not name tells that they belong to another one. Linear in points and pixels;
/// buffers are kept between scans. Not shared between threads.
class ScanLabeller
{
public:
  /// Throws std::runtime_error or std::invalid_argument when a table cannot be read or has no place for objects without
  /// a class.
  explicit ScanLabeller(const ScanLabellerConfig& config);

  /// The labels that came with the cloud.
  void takeOwn(OrganizedScan& scan);
  void takeImage(const RawImage& image, OrganizedScan& scan);
  /// `cloud` is what `scan` was made of.
  void takeCloud(const RawCloud& labels, const std::string& label_field, const RawCloud& cloud, OrganizedScan& scan);
  /// Ground, structure and objects by geometry. The scan's points are labelled `all` only where somebody needs them;
  /// the pixels always are.
  void takeGeometry(OrganizedScan& scan, bool all);

  /// Of the labels that go out.
  const std::shared_ptr<const ClassTable>& classTable() const { return class_table_; }

private:
  void requireObjects() const;
  void checkTable(const OrganizedScan& scan) const;
  void mapIds(OrganizedScan& scan) const;

  double max_unknown_;
  std::unique_ptr<const ClassTable> label_table_;
  std::shared_ptr<const ClassTable> class_table_;
  std::optional<ClassMapping> mapping_;  ///< where the tables differ
  GroundLabeler ground_;
  std::vector<std::uint32_t> separate_;  ///< by pixel or point
};
}  // namespace lidar_panoptic_clustering

#pragma once

#include "lidar_panoptic_clustering/core/class_mapping.h"
#include "lidar_panoptic_clustering/core/class_table.h"
#include "lidar_panoptic_clustering/core/label_numbering.h"
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
  double max_unknown_labels = 0.0;  ///< share of a scan's labelled returns whose ids the table may lack
  bool check_label_shapes = true;   ///< refuse ids that look like another class's, see LabelNumbering
  /// Where labels is "none": the image's points carry their height over the ground [m] in the place of the intensity;
  /// NaN in scans without ground.
  bool height_as_intensity = false;
  GroundLabelerConfig ground;  ///< where labels is "none"

  template <class Self, class Visitor>
  static void visit(Self& self, Visitor&& visitor)
  {
    visitor("labels", self.labels, std::vector<std::string>{"field", "image", "cloud", "none"});
    visitor("label_table", self.label_table, std::vector<std::string>{});
    visitor("class_table", self.class_table, std::vector<std::string>{});
    visitor("max_unknown_labels", self.max_unknown_labels, 0.0, 1.0);
    visitor("check_label_shapes", self.check_label_shapes);
    visitor("height_as_intensity", self.height_as_intensity);
    GroundLabelerConfig::visit(self.ground, visitor);
  }

  /// Labels come on a topic of their own.
  bool separate() const { return labels == "image" || labels == "cloud"; }
};

/// Gives an organised scan its classes, as raw ids of the table clustered with.
///
/// Each function throws std::invalid_argument, with what was expected and found, when the labels do not fit the scan or
/// LabelNumbering finds that they are not of their table. Ids beyond 65535 are labels of a .label file: the class is
/// their low half, the instance in the high half is not used. Linear in points and pixels; buffers are kept between
/// scans. Not shared between threads.
class ScanLabeller
{
public:
  /// Throws std::runtime_error or std::invalid_argument when a table cannot be read or has no place for objects without
  /// a class.
  explicit ScanLabeller(const ScanLabellerConfig& config);

  /// The labels that came with the cloud.
  void takeOwn(OrganizedScan& scan);
  /// A picture of the range image; a pixel a pixel.
  void takeImage(const RawImage& image, OrganizedScan& scan);
  /// `cloud` is what `scan` was made of.
  void takeCloud(const RawCloud& labels, const std::string& label_field, const RawCloud& cloud, OrganizedScan& scan);
  /// Ground, structure and objects by geometry, with scan lines or without. The scan's points are labelled `all` only
  /// where somebody needs them; the pixels always are.
  void takeGeometry(OrganizedScan& scan, bool all);
  /// What the last geometry tells of the ground.
  GroundReport ground() const { return ground_.ground(); }

  /// Of the labels that go out.
  const std::shared_ptr<const ClassTable>& classTable() const { return class_table_; }
  /// Which other tables the labels so far may be of, see LabelNumbering::doubt().
  const std::string& doubt() const { return numbering_.doubt(); }

private:
  void requireObjects() const;
  void takeClasses(OrganizedScan& scan);
  void findHiddenLabels(const OrganizedScan& scan);
  std::uint32_t classIn(std::uint32_t label) const;
  void mapIds(OrganizedScan& scan) const;
  void writeHeights(LabelledCloud& cloud) const;

  std::shared_ptr<const ClassTable> label_table_;
  std::shared_ptr<const ClassTable> class_table_;
  std::optional<ClassMapping> mapping_;  ///< where the tables differ
  LabelNumbering numbering_;
  std::uint32_t no_class_;  ///< of the labels that come
  bool height_as_intensity_;
  GroundLabeler ground_;
  std::vector<std::uint32_t> separate_;       ///< by pixel or point
  std::vector<std::uint32_t> hidden_labels_;  ///< of returns that no pixel shows
};
}  // namespace lidar_panoptic_clustering

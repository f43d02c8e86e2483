#pragma once

#include "lidar_panoptic_clustering/core/class_mapping.h"
#include "lidar_panoptic_clustering/core/class_table.h"
#include "python/array_views.h"

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

namespace lidar_panoptic_clustering
{
/// What the labels of arrays mean: as ScanLabellerConfig says of messages.
struct ClassLabelsConfig
{
  std::string class_table = "semantic_kitti";  ///< clustered with, and of the labels that go out
  std::string label_table;                     ///< of the labels that come in; empty: the same
  double max_unknown_labels = 0.0;             ///< share of an array's labels whose ids the table may lack

  template <class Self, class Visitor>
  static void visit(Self& self, Visitor&& visitor)
  {
    visitor("class_table", self.class_table, std::vector<std::string>{});
    visitor("label_table", self.label_table, std::vector<std::string>{});
    visitor("max_unknown_labels", self.max_unknown_labels, 0.0, 1.0);
  }
};

/// Turns labels of an array into classes of the class table.
class ClassLabels
{
public:
  /// Throws std::invalid_argument or std::runtime_error where a table cannot be read.
  explicit ClassLabels(const ClassLabelsConfig& config);

  /// Writes a raw class id of the class table a label. An instance in the high 16 bits is left out. Throws
  /// std::invalid_argument with what was expected and found on negative numbers, and where the table lacks more ids
  /// than allowed. Linear.
  void read(const IdsView& view, std::vector<std::uint32_t>& classes) const;

  /// Of the labels that go out; never null.
  const std::shared_ptr<const ClassTable>& table() const { return table_; }

private:
  std::uint32_t minusOneStandsFor(std::uint32_t no_class) const;
  [[noreturn]] void refuse(const IdsView& view) const;

  std::shared_ptr<const ClassTable> table_, label_table_;
  double max_unknown_;
  std::uint32_t no_class_;                     ///< of the labels that come in
  std::vector<std::uint32_t> class_of_label_;  ///< by the low half; the highest bit where the table lacks the id
};
}  // namespace lidar_panoptic_clustering

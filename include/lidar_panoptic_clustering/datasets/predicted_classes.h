#pragma once

#include "lidar_panoptic_clustering/core/class_mapping.h"
#include "lidar_panoptic_clustering/core/class_table.h"
#include "lidar_panoptic_clustering/datasets/semantic_kitti.h"

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace lidar_panoptic_clustering
{
/// The classes of a sequence's prediction files, in whatever numbering their network has, by a class table's own ids.
///
/// read() may be called from several threads.
class PredictedClasses
{
public:
  /// `label_table`: the table of the files' ids; empty: taken for that of `class_table`. Looks at a few scans of the
  /// sequence, spread evenly, and throws std::runtime_error with a file's name where LabelNumbering refuses all of
  /// them. A single bad file is left to read().
  PredictedClasses(const SemanticKittiSequence& sequence, std::shared_ptr<const ClassTable> class_table,
                   const std::string& label_table);

  /// As SemanticKittiSequence::readPredictions() of the sequence, with the classes in the low half turned into those of
  /// the class table. Throws std::runtime_error naming file, point and id where the table of labels lacks one.
  void read(const SemanticKittiSequence& sequence, std::size_t scan, std::size_t point_count,
            std::vector<std::uint32_t>& labels) const;

  /// See LabelNumbering::doubt().
  const std::string& doubt() const { return doubt_; }

private:
  void look(const SemanticKittiSequence& sequence, bool chosen);
  std::uint32_t classOf(std::uint32_t label) const;

  std::shared_ptr<const ClassTable> label_table_;
  std::uint32_t no_class_;               ///< of the label table
  std::optional<ClassMapping> mapping_;  ///< where the tables differ
  std::string doubt_;
};

/// Throws std::runtime_error naming `file`, the point, its id and the shipped tables that name all ids of the file,
/// where a label's class (its low half) is not in the table. -1 is one where it stands for no class.
void requireKnownClasses(const std::vector<std::uint32_t>& labels, const ClassTable& table, const std::string& file);
}  // namespace lidar_panoptic_clustering

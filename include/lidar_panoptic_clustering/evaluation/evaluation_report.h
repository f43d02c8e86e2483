#pragma once

#include "lidar_panoptic_clustering/evaluation/object_errors.h"
#include "lidar_panoptic_clustering/evaluation/panoptic_quality.h"
#include "lidar_panoptic_clustering/evaluation/temporal_quality.h"

#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

namespace lidar_panoptic_clustering
{
/// The figures under the key names of SemanticKITTI's evaluations (pq, pq_dagger, .. per_class: pq, sq, rq, iou, tp,
/// fp, fn) and, beside them, all integer sums, so that panopticQualityFromJson gives the same object back.
nlohmann::json toJson(const PanopticQuality& quality);

/// Throws std::invalid_argument naming the key when one is missing or of the wrong type, and when the classes saved are
/// not those of `table`.
PanopticQuality panopticQualityFromJson(const nlohmann::json& json, std::shared_ptr<const ClassTable> table);

nlohmann::json toJson(const ObjectErrorCounts& counts);
/// Throws std::invalid_argument naming the key.
ObjectErrorCounts objectErrorCountsFromJson(const nlohmann::json& json);

/// The figures under the key names of SemanticKITTI's 4D evaluation (lstq, s_assoc, s_cls, assoc_per_class), and all
/// tubes, so that temporalQualityFromJson gives the same object back.
nlohmann::json toJson(const TemporalQuality& quality);
/// Throws std::invalid_argument naming the key.
TemporalQuality temporalQualityFromJson(const nlohmann::json& json, std::shared_ptr<const ClassTable> table);

/// A scan that could not be evaluated.
struct SkippedScan
{
  std::string scan;    ///< "sequence/scan", 08/000123
  std::string reason;  ///< with what was expected and found
};

/// What an evaluation leaves behind: counts that can be merged, saved and loaded without loss.
struct EvaluationReport
{
  PanopticQuality quality;                   ///< over all scans
  ObjectErrorCounts objects;                 ///< over all scans
  std::optional<TemporalQuality> temporal;   ///< where ids were followed from scan to scan
  std::optional<std::uint64_t> id_switches;  ///< where scans came in their order, see IdSwitches
  std::vector<SkippedScan> skipped;          ///< in the order of the scans

  /// Empty; unmatched segments of fewer points than `min_points` will not count.
  explicit EvaluationReport(std::shared_ptr<const ClassTable> table, int min_points = 50)
      : quality(std::move(table), min_points)
  {
  }

  /// Throws std::invalid_argument when the classes or min_points differ, or one holds temporal figures and the other
  /// none.
  EvaluationReport& operator+=(const EvaluationReport& other);

  /// The same counts give the same bytes, in whatever order they came together.
  std::string toJsonText() const;
  /// Throws std::invalid_argument with `source` and what is wrong with the text.
  static EvaluationReport fromJsonText(const std::string& text, const std::string& source,
                                       std::shared_ptr<const ClassTable> table);
  /// The name of the class table a saved report was made with. Throws as fromJsonText.
  static std::string classTableOf(const std::string& text, const std::string& source);
};

/// The tables a person reads: a line a class, the means, the objects.
std::string formatReport(const EvaluationReport& report);
}  // namespace lidar_panoptic_clustering

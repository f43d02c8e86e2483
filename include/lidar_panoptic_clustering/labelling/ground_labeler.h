#pragma once

#include "lidar_panoptic_clustering/core/point_types.h"
#include "lidar_panoptic_clustering/labelling/ground_surface.h"
#include "lidar_panoptic_clustering/labelling/scan_components.h"

#include <cstdint>
#include <vector>

namespace lidar_panoptic_clustering
{
struct GroundLabelerConfig
{
  double max_range_m = 300.0;
  bool full_turn = true;
  double max_slope = 0.05;
  double ground_height_m = 0.15;
  double link_m = 0.5;
  double max_height_m = 4.2;
  double max_length_m = 20.0;
  double floating_m = 2.0;

  template <class Self, class Visitor>
  static void visit(Self& self, Visitor&& visitor)
  {
    visitor("max_range_m", self.max_range_m, 1.0, 10000.0);
    visitor("full_turn", self.full_turn);
    visitor("max_slope", self.max_slope, 0.0, 1.0);
    visitor("ground_height_m", self.ground_height_m, 0.05, 1.0);
    visitor("link_m", self.link_m, 0.05, 5.0);
    visitor("max_height_m", self.max_height_m, 0.5, 100.0);
    visitor("max_length_m", self.max_length_m, 0.5, 1000.0);
    visitor("floating_m", self.floating_m, 0.1, 10.0);
  }
};

class GroundLabeler
{
public:
  explicit GroundLabeler(const GroundLabelerConfig& config);
  void label(LabelledCloud& cloud);
  const ScanComponents& components() const { return components_; }
  const std::vector<float>& heights() const { return height_; }
  const GroundSurface& surface() const { return surface_; }

private:
  bool isStructure(const ScanComponent& c) const;
  GroundLabelerConfig config_;
  GroundSurface surface_;
  ScanComponents components_;
  std::vector<float> height_;
  std::vector<std::uint32_t> label_of_component_;
  std::uint32_t ignored_, ground_, structure_, object_;
};
}  // namespace lidar_panoptic_clustering

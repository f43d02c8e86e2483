#pragma once

#include "lidar_panoptic_clustering/labelling/ground_labeler.h"
#include "ray_scene.h"

#include <cstdint>
#include <utility>
#include <vector>

namespace lidar_panoptic_clustering
{
constexpr std::uint32_t kIgnoredId = 0, kGroundId = 1, kStructureId = 2, kObjectId = 3;

inline const SceneBox kCarAhead{{8.0F, -0.9F, 0.22F}, {12.2F, 0.9F, 1.5F}};
inline const SceneBox kCarBeside{{-2.0F, 5.0F, 0.22F}, {2.2F, 6.8F, 1.5F}};

/// Legs, torso and head of someone who stands at (x, y) and looks along x.
inline std::vector<SceneBox> personAt(float x, float y)
{
  const auto box = [x, y](float half_depth, float left, float right, float low, float high) {
    return SceneBox{{x - half_depth, y + left, low}, {x + half_depth, y + right, high}};
  };
  return {box(0.08F, 0.06F, 0.2F, 0.0F, 0.85F), box(0.08F, -0.2F, -0.06F, 0.0F, 0.85F),
          box(0.15F, -0.25F, 0.25F, 0.85F, 1.5F), box(0.1F, -0.1F, 0.1F, 1.5F, 1.75F)};
}

/// Shares of what a box's returns, or the ground's, are labelled as.
struct Shares
{
  int count = 0;
  double ground = 0.0, structure = 0.0, object = 0.0;
};

inline Shares sharesOf(const LabelledCloud& cloud, const std::vector<int>& hits, int hit)
{
  Shares shares;
  for (std::size_t i = 0; i < cloud.size(); ++i)
  {
    if (hits[i] != hit) continue;
    ++shares.count;
    shares.ground += cloud.points[i].label == kGroundId ? 1.0 : 0.0;
    shares.structure += cloud.points[i].label == kStructureId ? 1.0 : 0.0;
    shares.object += cloud.points[i].label == kObjectId ? 1.0 : 0.0;
  }
  const double scale = shares.count > 0 ? 1.0 / shares.count : 0.0;
  shares.ground *= scale, shares.structure *= scale, shares.object *= scale;
  return shares;
}

/// A scene's scan, labelled.
struct Labelled
{
  explicit Labelled(const RayScene& scene, const RaySensor& sensor = {}, GroundLabelerConfig config = {})
      : labeler(config), cloud(castScene(scene, sensor, hits))
  {
    labeler.label(cloud);
  }
  Shares of(int hit) const { return sharesOf(cloud, hits, hit); }

  std::vector<int> hits;
  GroundLabeler labeler;
  LabelledCloud cloud;
};

inline RayScene sceneOf(std::vector<SceneBox> boxes)
{
  RayScene scene;
  scene.boxes = std::move(boxes);
  return scene;
}
}  // namespace lidar_panoptic_clustering

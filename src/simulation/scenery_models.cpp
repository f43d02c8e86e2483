#include "lidar_panoptic_clustering/simulation/labels.h"
#include "lidar_panoptic_clustering/simulation/models.h"

#include <cmath>

namespace lidar_panoptic_clustering::simulation
{
namespace
{
constexpr float kFoliage = 0.45F;      // reflectivity
constexpr float kFoliageGaps = 0.35F;  // share of the beams that pass
}  // namespace

void addTree(std::vector<Solid>& solids, const Pose& pose, Random random)
{
  const float girth = random.uniform(0.1F, 0.22F), stem = random.uniform(1.9F, 3.2F);
  const float crown = random.uniform(2.6F, 4.6F);
  const float lean = random.uniform(-0.25F, 0.25F);

  ObjectBuilder tree(solids, pose, label::kTrunk);
  tree.surface(0.3F).bar({0.0F, 0.0F, -0.1F}, {lean, 0.3F * lean, stem + 0.4F * crown}, girth);
  tree.label(label::kVegetation).surface(kFoliage, kFoliageGaps, 1.2F);
  tree.ellipsoid({lean, 0.0F, stem + 0.5F * crown}, {0.85F * crown, 0.85F * crown, crown});
  for (int i = 0; i < 3; ++i)
  {
    const float angle = 2.1F * static_cast<float>(i) + random.uniform(-0.6F, 0.6F);
    const float size = random.uniform(0.4F, 0.65F) * crown, rise = random.uniform(0.15F, 0.6F) * crown;
    tree.ellipsoid({lean + 0.33F * crown * std::cos(angle), 0.33F * crown * std::sin(angle), stem + rise},
                   {size, size, 0.8F * size});
  }
}

void addBush(std::vector<Solid>& solids, const Pose& pose, Random random)
{
  ObjectBuilder bush(solids, pose, label::kVegetation);
  bush.surface(kFoliage, 0.25F, 0.4F);
  for (int i = 0; i < 3; ++i)
  {
    const float size = random.uniform(0.7F, 1.5F), x = random.uniform(-0.6F, 0.6F), y = random.uniform(-0.4F, 0.4F);
    bush.ellipsoid({x, y, 0.4F * size}, {size, size, 1.1F * size});
  }
}

void addHedge(std::vector<Solid>& solids, const Pose& pose, float length, float height)
{
  ObjectBuilder hedge(solids, pose, label::kVegetation);
  hedge.surface(kFoliage, 0.1F, 0.25F).box({0.0F, 0.0F, 0.5F * height}, {length, 0.7F, height});
}

void addFence(std::vector<Solid>& solids, const Pose& pose, float length, Random random)
{
  const float height = random.uniform(0.9F, 1.6F);
  const bool wire = random.chance(0.5);
  ObjectBuilder fence(solids, pose, label::kFence);
  fence.surface(0.35F, wire ? 0.55F : 0.08F);
  fence.box({0.0F, 0.0F, 0.5F * height + 0.03F}, {length, 0.04F, height - 0.06F});
  fence.surface(0.35F);
  fence.box({0.0F, 0.0F, height}, {length, 0.08F, 0.06F});
  const int posts = std::max(1, static_cast<int>(length / 2.5F));
  for (int i = 0; i <= posts; ++i)
  {
    const float x = length * (static_cast<float>(i) / static_cast<float>(posts) - 0.5F);
    fence.bar({x, 0.0F, 0.0F}, {x, 0.0F, height + 0.08F}, 0.05F);
  }
}

void addLamp(std::vector<Solid>& solids, const Pose& pose)
{
  ObjectBuilder lamp(solids, pose, label::kPole);
  lamp.surface(0.45F);
  lamp.bar({0.0F, 0.0F, 0.0F}, {0.0F, 0.0F, 1.1F}, 0.12F);
  lamp.bar({0.0F, 0.0F, 1.0F}, {0.0F, 0.0F, 6.5F}, 0.075F);
  lamp.bar({0.0F, 0.0F, 6.4F}, {0.0F, -1.6F, 6.6F}, 0.05F);
}

void addTrafficSign(std::vector<Solid>& solids, const Pose& pose, Random random)
{
  const bool round = random.chance(0.5);
  const float bottom = random.uniform(1.7F, 2.1F), size = random.uniform(0.55F, 0.75F);
  const float middle = bottom + 0.5F * size;
  ObjectBuilder sign(solids, pose, label::kPole);
  sign.surface(0.5F).bar({0.0F, 0.0F, 0.0F}, {0.0F, 0.0F, bottom + size}, 0.04F);
  sign.label(label::kTrafficSign).surface(0.95F);
  if (round)
    sign.bar({-0.06F, 0.0F, middle}, {-0.03F, 0.0F, middle}, 0.5F * size);
  else
    sign.box({-0.045F, 0.0F, middle}, {0.03F, size, size});
}

void addBuilding(std::vector<Solid>& solids, const Pose& pose, float length, float height, Random random)
{
  constexpr float kDepth = 9.0F, kRecess = 0.25F, kFloor = 3.1F, kSill = 1.0F, kWindow = 1.5F;
  const float stone = random.uniform(0.25F, 0.6F);
  const int bays = std::max(2, static_cast<int>(length / random.uniform(2.6F, 3.6F)));
  const int door = random.below(bays);
  const float bay = length / static_cast<float>(bays);

  // glass and doors lie behind the wall's face: the face is what pillars and bands leave open
  ObjectBuilder building(solids, pose, label::kBuilding);
  building.surface(stone);
  building.box({0.0F, kRecess + 0.5F * kDepth, 0.5F * height}, {length - 0.02F, kDepth, height});
  for (int i = 0; i <= bays; ++i)
  {
    const float width = i == 0 || i == bays ? 0.6F * bay : 0.52F * bay;
    const float x = (static_cast<float>(i) - 0.5F * static_cast<float>(bays)) * bay;
    const float inward = i == 0 ? 0.5F * width : i == bays ? -0.5F * width : 0.0F;
    building.box({x + inward, 0.5F * kRecess, 0.5F * height}, {width, kRecess, height});
  }
  for (float base = 0.0F; base < height; base += kFloor)
  {
    const float top = std::min(height, base + kSill), bottom = base == 0.0F ? 0.0F : base - (kFloor - kSill - kWindow);
    building.box({0.0F, 0.5F * kRecess, 0.5F * (bottom + top)}, {length, kRecess - 0.02F, top - bottom});
  }
  const float door_x = (static_cast<float>(door) + 0.5F - 0.5F * static_cast<float>(bays)) * bay;
  building.box({door_x, -0.5F, 0.17F}, {1.5F, 1.0F, 0.34F});
  if (random.chance(0.5)) building.box({door_x, -0.55F, 2.6F}, {1.9F, 1.1F, 0.12F});
  if (random.chance(0.35))
    building.box({-0.3F * length, -0.35F, 0.5F * height}, {0.3F * length, 0.7F, height});  // bay window
}
}  // namespace lidar_panoptic_clustering::simulation

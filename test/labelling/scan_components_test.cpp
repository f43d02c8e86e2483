#include "lidar_panoptic_clustering/labelling/scan_components.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <map>
#include <random>
#include <string>
#include <tuple>
#include <vector>

namespace lidar_panoptic_clustering
{
namespace
{
constexpr ScanComponents::Distances kDistances = {0.15F, 0.13F, 0.7F};

/// An image of returns at uneven ranges, some on the ground, some missing.
struct RandomScan
{
  RandomScan(std::uint32_t rows, std::uint32_t columns, unsigned seed) : cloud(columns, rows), returns(cloud.size())
  {
    std::mt19937 random(seed);
    std::uniform_real_distribution<float> share(0.0F, 1.0F);
    float range = 5.0F;
    for (std::uint32_t i = 0; i < cloud.size(); ++i)
    {
      const float azimuth = 0.02F * static_cast<float>(i % columns), jump = share(random);
      range = jump < 0.15F ? 4.0F + 6.0F * share(random) : range + 0.3F * (jump - 0.5F);
      LabelledPoint& p = cloud.points[i];
      p.x = range * std::cos(azimuth), p.y = range * std::sin(azimuth);
      p.z = range * (0.1F - 0.03F * static_cast<float>(i / columns));
      const float kind = share(random);
      returns[i] = {std::hypot(p.x, p.y), kind < 0.3F ? 0.05F : p.z + 1.0F};
      constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();
      if (kind < 0.1F) returns[i] = {kNaN, kNaN};
    }
  }

  LabelledCloud cloud;
  std::vector<GroundedReturn> returns;
};

/// The rule of the header's words, pair by pair.
class Oracle
{
public:
  Oracle(const RandomScan& scan, bool full_turn) : scan_(scan), part_(scan.cloud.size()), component_(part_)
  {
    for (std::uint32_t i = 0; i < part_.size(); ++i) part_[i] = component_[i] = i;
    const std::uint32_t columns = scan.cloud.width;
    for (std::uint32_t row = 0; row < scan.cloud.height; ++row)
      for (std::uint32_t column = 0; column < columns; ++column)
      {
        if (!isAbove(row * columns + column)) continue;
        for (std::uint32_t k = 1; k <= 8 && (full_turn || column + k < columns) && k < columns; ++k)
          if (tie(row * columns + column, row * columns + (column + k) % columns)) break;
        for (std::uint32_t k = 1; k <= 4 && row + k < scan.cloud.height; ++k)
          if (tie(row * columns + column, (row + k) * columns + column)) break;
      }
  }

  std::uint32_t partOf(std::uint32_t i) const { return rootOf(part_, i); }
  std::uint32_t componentOf(std::uint32_t i) const { return rootOf(component_, i); }
  bool isAbove(std::uint32_t i) const { return scan_.returns[i].height >= kDistances.above; }

private:
  static std::uint32_t rootOf(const std::vector<std::uint32_t>& sets, std::uint32_t i)
  {
    while (sets[i] != i) i = sets[i];
    return i;
  }

  /// Whether there is a neighbour at all: `k` beyond or below `i`.
  bool tie(std::uint32_t i, std::uint32_t k)
  {
    if (!isAbove(k)) return false;
    const auto vector = [&](std::uint32_t at) { return scan_.cloud.points[at].getVector3fMap().cast<double>().eval(); };
    const auto a = vector(i), b = vector(k);
    const double distance = (a - b).norm(), across = a.cross(b).norm() / b.norm();
    const bool is_surface = distance < 2.0 * across;
    const double along = std::sqrt(std::max(0.0, distance * distance - across * across));
    const bool is_tight = distance < double{kDistances.step} || (is_surface && along < double{kDistances.step});
    if (is_tight) part_[rootOf(part_, i)] = rootOf(part_, k);
    if (is_tight || is_surface || distance < double{kDistances.link})
      component_[rootOf(component_, i)] = rootOf(component_, k);
    return true;
  }

  const RandomScan& scan_;
  std::vector<std::uint32_t> part_, component_;
};

bool isNever(const HeightRange&)
{
  return false;
}

ScanComponents componentsOf(const RandomScan& scan, const std::function<bool(const HeightRange&)>& is_apart)
{
  ScanComponents found;
  found.start(scan.cloud.height, scan.cloud.width, kDistances, true);
  for (std::uint32_t row = 0; row < scan.cloud.height; ++row) found.addRow(row, scan.cloud, scan.returns);
  found.finish(scan.cloud, scan.returns, is_apart);
  return found;
}

void expectSame(const ScanComponent& a, const ScanComponent& b)
{
  EXPECT_EQ(std::make_tuple(a.point_count, a.bottom, a.top, a.open_top),
            std::make_tuple(b.point_count, b.bottom, b.top, b.open_top));
  const auto extent = [](const Footprint& f) { return std::make_tuple(f.minX(), f.maxX(), f.minY(), f.maxY()); };
  EXPECT_EQ(extent(a.footprint), extent(b.footprint));
  EXPECT_EQ(std::make_tuple(a.blocked, a.undercut, a.hidden), std::make_tuple(b.blocked, b.undercut, b.hidden));
  EXPECT_EQ(std::make_tuple(a.triples, a.rough_triples, a.ends, a.free_ends),
            std::make_tuple(b.triples, b.rough_triples, b.ends, b.free_ends));
}

TEST(ScanComponents, AreTheSameWhicheverPartsAreApart)
{
  for (unsigned seed = 0; seed < 50; ++seed)
  {
    SCOPED_TRACE(seed);
    const RandomScan scan(8, 60, seed);
    const ScanComponents together = componentsOf(scan, isNever);
    EXPECT_TRUE(together.partsApart().empty());
    const auto is_large = [](const HeightRange& part) { return part.point_count > 3; };
    for (const auto& is_apart : {std::function<bool(const HeightRange&)>(is_large),
                                 std::function<bool(const HeightRange&)>([](const HeightRange&) { return true; })})
    {
      const ScanComponents apart = componentsOf(scan, is_apart);
      ASSERT_EQ(apart.componentCount(), together.componentCount());
      for (std::uint32_t i = 0; i < apart.componentCount(); ++i) expectSame(apart.component(i), together.component(i));
    }
  }
}

TEST(ScanComponents, DescribesPartsByTheirReturns)
{
  for (unsigned seed = 0; seed < 50; ++seed)
  {
    SCOPED_TRACE(seed);
    const RandomScan scan(8, 60, seed);
    const ScanComponents found = componentsOf(scan, [](const HeightRange& part) { return part.point_count > 3; });
    std::map<std::uint32_t, ScanComponent> expected;
    for (const std::uint32_t pixel : found.pixels())
    {
      const LabelledPoint& p = scan.cloud.points[pixel];
      ScanComponent& part = expected[found.partOf(pixel)];
      ++part.point_count;
      part.bottom = std::min(part.bottom, scan.returns[pixel].height);
      part.top = std::max(part.top, scan.returns[pixel].height);
      part.footprint.add(p.x, p.y);
    }
    std::vector<std::uint32_t> apart;
    for (const auto& [part, is] : expected)
    {
      if (is.point_count <= 3) continue;
      apart.push_back(part);
      const ScanComponent& described = found.part(part);
      EXPECT_EQ(std::make_tuple(is.point_count, is.bottom, is.top),
                std::make_tuple(described.point_count, described.bottom, described.top));
      EXPECT_EQ(is.footprint.minX(), described.footprint.minX());
      EXPECT_EQ(is.footprint.maxY(), described.footprint.maxY());
    }
    EXPECT_EQ(apart, found.partsApart());
    EXPECT_GT(apart.size(), 5U);
  }
}

/// Of any width: four returns at once, and what is left of a row.
TEST(ScanComponents, AreThoseOfEachPairOfNeighbours)
{
  for (const std::uint32_t columns : {1U, 2U, 3U, 4U, 5U, 7U, 9U, 30U, 31U, 32U, 33U, 61U})
    for (const bool full_turn : {false, true})
      for (unsigned seed = 0; seed < 20; ++seed)
      {
        SCOPED_TRACE(std::to_string(columns) + " columns, turn " + std::to_string(full_turn) + ", seed " +
                     std::to_string(seed));
        const RandomScan scan(6, columns, seed);
        ScanComponents found;
        found.start(6, columns, kDistances, full_turn);
        for (std::uint32_t row = 0; row < 6; ++row) found.addRow(row, scan.cloud, scan.returns);
        found.finish(scan.cloud, scan.returns, isNever);

        const Oracle oracle(scan, full_turn);
        std::map<std::uint32_t, std::uint32_t> part, component;  // the oracle's to those found
        std::size_t above = 0;
        for (std::uint32_t i = 0; i < scan.cloud.size(); ++i)
        {
          if (!oracle.isAbove(i)) continue;
          ASSERT_LT(above, found.pixels().size());
          EXPECT_EQ(found.pixels()[above++], i);
          EXPECT_EQ(part.emplace(oracle.partOf(i), found.partOf(i)).first->second, found.partOf(i));
          EXPECT_EQ(component.emplace(oracle.componentOf(i), found.of(i)).first->second, found.of(i));
        }
        EXPECT_EQ(above, found.pixels().size());
        EXPECT_EQ(part.size(), found.partCount());
        EXPECT_EQ(component.size(), found.componentCount());
      }
}
}  // namespace
}  // namespace lidar_panoptic_clustering

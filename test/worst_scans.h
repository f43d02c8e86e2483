#pragma once

#include "scan_fixture.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <random>
#include <string>
#include <vector>

namespace lidar_panoptic_clustering
{
/// Scans built to cost the most: every pixel holds a thing, and what usually saves an algorithm work does not help.
struct WorstScan
{
  std::string name;
  LabelledCloud (*build)(std::uint32_t rows, std::uint32_t columns);
};

/// A scan whose pixel (row, column) holds what `point(row, column)` says.
template <class PointOf>
LabelledCloud filledScan(std::uint32_t rows, std::uint32_t columns, const PointOf& point)
{
  LabelledCloud cloud(columns, rows);
  for (std::uint32_t row = 0; row < rows; ++row)
    for (std::uint32_t column = 0; column < columns; ++column)
      cloud.points[static_cast<std::size_t>(row) * columns + column] = point(row, column);
  return cloud;
}

/// As filledScan, on the beams of a sensor: `range(row, column)` [m].
template <class RangeOf>
LabelledCloud carsAt(std::uint32_t rows, std::uint32_t columns, const RangeOf& range)
{
  return filledScan(
      rows, columns,
      [&](std::uint32_t row, std::uint32_t column)
      { return onBeam(rows, columns, static_cast<float>(row), static_cast<float>(column), range(row, column), kCar); });
}

/// Points `spacing` apart on a square grid about the sensor.
inline LabelledCloud spacedGrid(std::uint32_t rows, std::uint32_t columns, float spacing)
{
  const auto side = static_cast<std::uint32_t>(std::sqrt(static_cast<float>(rows * columns))) + 1;
  return filledScan(rows, columns,
                    [&](std::uint32_t row, std::uint32_t column)
                    {
                      const std::uint32_t k = row * columns + column;
                      const auto at = [&](std::uint32_t n)
                      { return spacing * (static_cast<float>(n) - 0.5F * static_cast<float>(side)); };
                      return labelled(at(k % side), at(k / side) + 0.001F, -1.0F, kCar);
                    });
}

/// Two dense walls 0.8 m apart, the cars' link distance, `heading` from the x axis [rad]; rows on one in turn.
inline LabelledCloud twoWalls(std::uint32_t rows, std::uint32_t columns, float heading)
{
  const float c = std::cos(heading), s = std::sin(heading);
  return filledScan(
      rows, columns,
      [&](std::uint32_t row, std::uint32_t column)
      {
        const float along = 20.0F - 40.0F * (static_cast<float>(column) + 0.01F * static_cast<float>(row)) /
                                        static_cast<float>(columns);
        const float across = row % 2 == 0 ? 5.0F : 5.8001F;
        return labelled(c * across - s * along, s * across + c * along, -0.01F * static_cast<float>(row), kCar);
      });
}

inline std::vector<WorstScan> worstScans()
{
  using U = std::uint32_t;
  return {
      {"room",
       [](U rows, U columns)
       {
         return carsAt(rows, columns,
                       [&](U, U column)
                       {
                         const float azimuth = 6.2831853F * static_cast<float>(column) / static_cast<float>(columns);
                         return 10.0F / std::max(std::abs(std::cos(azimuth)), std::abs(std::sin(azimuth)));
                       });
       }},
      {"half_a_metre", [](U rows, U columns) { return carsAt(rows, columns, [](U, U) { return 0.5F; }); }},
      {"one_spot", [](U rows, U columns)
       { return filledScan(rows, columns, [](U, U) { return labelled(5.0F, 1.0F, -1.0F, kCar); }); }},
      {"runs_of_one", [](U rows, U columns)
       { return carsAt(rows, columns, [](U, U column) { return column % 2 == 0 ? 1.5F : 3.0F; }); }},
      {"runs_of_one_in_four_layers",
       [](U rows, U columns)
       {
         return carsAt(rows, columns,
                       [](U row, U column) { return 1.5F + 0.85F * static_cast<float>((column + 2 * row) % 4); });
       }},
      {"chequered_classes",
       [](U rows, U columns)
       {
         const std::uint32_t labels[] = {kCar, kTruck, kPerson, 20, 11, 31};
         LabelledCloud cloud = carsAt(rows, columns, [](U, U) { return 6.0F; });
         for (U k = 0; k < rows * columns; ++k) cloud.points[k].label = labels[(k % columns + k / columns) % 6];
         return cloud;
       }},
      {"two_walls", [](U rows, U columns) { return twoWalls(rows, columns, 0.0F); }},
      {"two_walls_askew", [](U rows, U columns) { return twoWalls(rows, columns, 0.7F); }},
      {"grid_at_link_distance", [](U rows, U columns) { return spacedGrid(rows, columns, 0.8F); }},
      {"grid_of_single_points", [](U rows, U columns) { return spacedGrid(rows, columns, 0.801F); }},
      {"rings_a_metre_apart",
       [](U rows, U columns)
       {
         return filledScan(rows, columns,
                           [&](U row, U column)
                           {
                             const float azimuth =
                                 6.2831853F * static_cast<float>(column) / static_cast<float>(columns);
                             const float range = 2.0F + 0.45F * static_cast<float>(2 * (column % 2) + row % 2);
                             return labelled(range * std::cos(azimuth), -range * std::sin(azimuth),
                                             -0.95F * static_cast<float>(row), kTruck);
                           });
       }},
      {"spiral",
       [](U rows, U columns)
       {
         return carsAt(rows, columns,
                       [&](U row, U column) {
                         return 2.0F + 0.81F * (static_cast<float>(row) +
                                                static_cast<float>(column) / static_cast<float>(columns));
                       });
       }},
      {"hairy",
       [](U rows, U columns)
       {
         std::mt19937 random(1);
         return carsAt(rows, columns, [&](U, U) { return 2.0F + 0.001F * static_cast<float>(random() % 38000); });
       }},
      {"hairy_in_all_classes",
       [](U rows, U columns)
       {
         const std::uint32_t labels[] = {kCar, kTruck, kPerson, 20, 11, 31};
         std::mt19937 random(2);
         LabelledCloud cloud =
             carsAt(rows, columns, [&](U, U) { return 2.0F + 0.001F * static_cast<float>(random() % 38000); });
         for (auto& p : cloud.points) p.label = labels[random() % 6];
         return cloud;
       }},
  };
}
}  // namespace lidar_panoptic_clustering

#include "lidar_panoptic_clustering/projection/organized_rows.h"

#include "raw_message.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <random>

namespace lidar_panoptic_clustering
{
namespace
{
RawMessage messageOf(std::uint32_t rows, std::uint32_t columns)
{
  std::uint32_t step = 0;
  constexpr auto kF32 = NumberType::kFloat32;
  const auto fields = packed({{"x", kF32}, {"y", kF32}, {"z", kF32}, {"label", NumberType::kUint16}}, step);
  RawMessage message(rows, columns, fields, step);
  for (std::uint32_t r = 0; r < rows; ++r)
    for (std::uint32_t c = 0; c < columns; ++c)
    {
      const bool is_return = (r + c) % 5 != 0;
      message.setPoint(r, c, is_return ? 1.0 + r : 0.0, is_return ? 2.0 + c : 0.0, is_return ? 0.5 : 0.0);
      message.set(r, c, "label", 100 * r + c);
    }
  return message;
}

/// Each point's pixel and label by the meaning of the placement, point by point.
void expectPlaced(const RawMessage& message, const RowPlacement& placement, const OrganizedScan& out)
{
  const RawCloud raw = message.view();
  const bool rows_are_rings = placement.orientation == Orientation::kRowsAreRings;
  const std::uint32_t width = rows_are_rings ? raw.width : raw.height;
  ASSERT_EQ(out.image.cloud.width, width);
  for (std::uint32_t r = 0; r < raw.height; ++r)
    for (std::uint32_t c = 0; c < raw.width; ++c)
    {
      const std::uint32_t line = rows_are_rings ? r : c, column = rows_are_rings ? c : r, point = r * raw.width + c;
      const std::uint32_t row = placement.row_of_line.empty() ? line : placement.row_of_line[line];
      const std::uint32_t pixel = row * width + column;
      ASSERT_EQ(out.image.pixel_of_point[point], pixel) << r << ' ' << c;
      ASSERT_EQ(out.image.points[pixel], point);
      ASSERT_EQ(out.image.begin[pixel], pixel);
      const bool is_return = (r + c) % 5 != 0;
      ASSERT_EQ(out.image.owner_of_pixel[pixel], is_return ? point : Projection::kNone);
      ASSERT_EQ(out.image.cloud.points[pixel].label, 100 * r + c);
      if (is_return)
        ASSERT_EQ(out.image.cloud.points[pixel].y, 2.0F + static_cast<float>(c));
      else
        ASSERT_TRUE(std::isnan(out.image.cloud.points[pixel].y));
    }
}

TEST(OrganizedRows, whateverTheFramesBeforeWere)
{
  std::mt19937 random(7);
  OrganizedScan out;
  const std::pair<std::uint32_t, std::uint32_t> sizes[] = {{4, 12}, {12, 4}, {8, 6}, {6, 8}, {1, 48}, {48, 1}, {4, 4}};
  for (int frame = 0; frame < 400; ++frame)
  {
    const auto [rows, columns] = sizes[random() % std::size(sizes)];
    RowPlacement placement;
    placement.orientation = random() % 2 == 0 ? Orientation::kRowsAreRings : Orientation::kRowsAreFirings;
    if (random() % 3 != 0)
    {
      placement.row_of_line.resize(placement.orientation == Orientation::kRowsAreRings ? rows : columns);
      std::iota(placement.row_of_line.begin(), placement.row_of_line.end(), 0U);
      std::shuffle(placement.row_of_line.begin(), placement.row_of_line.end(), random);
    }
    const RawMessage message = messageOf(rows, columns);
    const RawCloud raw = message.view();
    placeRows(raw, findScanFields(raw, FieldNames(), true), placement, out);
    ASSERT_NO_FATAL_FAILURE(expectPlaced(message, placement, out)) << "frame " << frame;
  }
}
}  // namespace
}  // namespace lidar_panoptic_clustering

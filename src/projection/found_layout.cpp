#include "lidar_panoptic_clustering/projection/found_layout.h"

namespace lidar_panoptic_clustering
{
namespace
{
std::string sequenceOf(LineOrder order)
{
  if (order == LineOrder::kHighestFirst) return "the highest first";
  if (order == LineOrder::kLowestFirst) return "the lowest first";
  return "in the sequence they fire, sorted by elevation";
}

std::string describeRows(const FoundLayout& found)
{
  std::string text = found.orientation == Orientation::kRowsAreRings ? "rows are rings, " : "rows are firings, rings ";
  text += sequenceOf(found.line_order);
  if (found.reshaped)
    text += found.orientation == Orientation::kRowsAreRings
                ? ", declared as firings x rings but laid ring after ring"
                : ", declared as rings x firings but laid firing after firing";
  return text;
}
}  // namespace

std::string describeOrder(const FoundLayout& found)
{
  switch (found.layout)
  {
    case Layout::kOrganized:
      return found.rows == 1 ? "one scan line" : describeRows(found);
    case Layout::kRing:
      if (found.rings_are_rows) return "no field ring, the cloud's " + describeRows(found);
      return "points with the number of their ring, " + sequenceOf(found.line_order);
    case Layout::kBeams:
      return "points placed by the elevations of the sensor file's beams";
    case Layout::kUnfold:
      return std::string("points ring after ring, ") +
             (found.sweep && found.sweep->clockwise ? "clockwise" : "counter-clockwise") + ", " +
             sequenceOf(found.line_order);
    case Layout::kMerged:
      return "points in no order, handed on as they are";
  }
  return "";
}

std::string describe(const FoundLayout& found)
{
  std::string text = describeOrder(found);
  if (found.layout != Layout::kMerged)
  {
    text += ": " + std::to_string(found.rows) + (found.rows == 1 ? " row" : " rows");
    if (found.layout != Layout::kOrganized) text += " x " + std::to_string(found.columns) + " columns";
  }
  text += found.sensor.empty() ? "; no sensor file" : "; sensor file " + found.sensor;
  if (!found.doubt.empty()) text += "; " + found.doubt;
  return text;
}
}  // namespace lidar_panoptic_clustering

#pragma once

#include <lidar_panoptic_clustering/Object.h>
#include <std_msgs/Header.h>
#include <visualization_msgs/MarkerArray.h>

#include <cstdint>
#include <string>
#include <vector>

namespace lidar_panoptic_clustering
{
/// `rgb`: 0xRRGGBB
std_msgs::ColorRGBA toColor(std::uint32_t rgb, float alpha);
/// Of an object's pose and size, in namespace "boxes". Sides are at least 5 cm, so that RViz shows them.
visualization_msgs::Marker boxMarker(const Object& object, std::uint32_t rgb);
/// Above its box, in namespace "texts".
visualization_msgs::Marker textMarker(const Object& object, const std::string& text);

/// The markers of each scan of a stream, and the deletions of those that the list before had and this one has no more.
///
/// RViz keeps each marker by itself until its transform is there, and may take them in another order then: a marker
/// that deletes all would wipe what has just been added. So what is left of an older list is deleted by name, and a
/// lifetime ends what a lost deletion leaves: three intervals between lists, at least three seconds.
class MarkerList
{
public:
  void begin(const std_msgs::Header& header, ros::Time now);
  /// `id` is not used by another marker of this list in its namespace.
  void add(visualization_msgs::Marker&& marker, std::uint32_t id);
  /// The list begun last.
  visualization_msgs::MarkerArrayPtr finish();

private:
  struct Name
  {
    std::string space;
    std::int32_t id;
    bool operator<(const Name& other) const { return space != other.space ? space < other.space : id < other.id; }
  };

  ros::Duration nextLifetime(ros::Time now);

  std_msgs::Header header_;
  ros::Duration lifetime_;
  ros::Time previous_time_;
  visualization_msgs::MarkerArrayPtr array_;
  std::vector<Name> shown_, previous_, gone_;
};
}  // namespace lidar_panoptic_clustering

// What OrganizerNodelet tells in its log and /diagnostics.
#include "core/plain_numbers.h"
#include "ros/organizer_nodelet.h"

#include <utility>

namespace lidar_panoptic_clustering
{
namespace
{
constexpr const char* kNoGround =
    "no ground in the last scan: what it shows is judged without, and nothing is ground; "
    "is z up, and the ground within 20 m?";
}  // namespace

void OrganizerNodelet::tellLayout()
{
  const FoundLayout& found = organizer_->organizer().found();
  if (!found.known() || found.change == told_layout_) return;
  told_layout_ = found.change;
  const std::string text = describe(found);
  NODELET_INFO("clouds on %s: %s", getPrivateNodeHandle().resolveName("input").c_str(), text.c_str());
  diagnostics_.setText("layout", text);
  warn("layout", found.doubt);
}

void OrganizerNodelet::tellGround()
{
  const auto ground = organizer_->ground();
  if (!ground) return;
  if (!ground->found)
  {
    diagnostics_.setFigure("scans without ground", ++without_ground_);
    diagnostics_.setWarning("ground", kNoGround);
    if (!std::exchange(told_no_ground_, true)) NODELET_WARN("%s", kNoGround);
    return;
  }
  diagnostics_.setWarning("ground", "");
  const std::string height = fixedText(ground->sensor_height_m, 2) + " m over the ground";
  diagnostics_.setText("sensor", height);
  const SlopedPlane& plane = ground->plane;
  diagnostics_.setText("ground", "z = " + fixedText(double{plane.slope_x}, 4) + " x + " +
                                     fixedText(double{plane.slope_y}, 4) + " y + " +
                                     fixedText(double{plane.offset}, 3) + " m, sloped by " +
                                     fixedText(ground->slope_deg, 1) + " degrees");
  if (!std::exchange(told_height_, true)) NODELET_INFO("sensor found %s", height.c_str());
}

void OrganizerNodelet::warn(const char* subject, const std::string& doubt)
{
  std::string& told = doubts_[subject];
  if (doubt == told) return;
  told = doubt;
  diagnostics_.setWarning(subject, doubt);
  if (!doubt.empty()) NODELET_WARN("%s", doubt.c_str());
}

void OrganizerNodelet::refuse(const std::string& error)
{
  if (diagnostics_.refused(error)) NODELET_ERROR("%s", error.c_str());
}
}  // namespace lidar_panoptic_clustering

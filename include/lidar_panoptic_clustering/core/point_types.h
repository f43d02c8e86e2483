#pragma once

#include "lidar_panoptic_clustering/core/language.h"

#include <pcl/pcl_macros.h>
#include <pcl/point_cloud.h>
#include <pcl/point_types.h>
#include <pcl/register_point_struct.h>

#include <cstdint>

namespace lidar_panoptic_clustering
{
/// A return with the class a semantic network gave it. 32 bytes.
struct EIGEN_ALIGN16 LabelledPoint
{
  PCL_ADD_POINT4D  ///< x, y, z [m], sensor frame
      float intensity = 0.0F;
  std::uint32_t label = 0;  ///< raw class id of the label source, see ClassTable

  LabelledPoint() { x = y = z = 0.0F, data[3] = 1.0F; }
  EIGEN_MAKE_ALIGNED_OPERATOR_NEW
};

/// The same return with the object it belongs to. 32 bytes, 16 of them shared with LabelledPoint's layout.
struct EIGEN_ALIGN16 PanopticPoint
{
  PCL_ADD_POINT4D
  float intensity = 0.0F;
  std::uint32_t label = 0;
  std::uint32_t instance = 0;  ///< 0: no instance; 1..n within the frame
  std::uint32_t rgb = 0;       ///< 0x00RRGGBB: class colour for stuff, one colour an instance for things

  PanopticPoint() { x = y = z = 0.0F, data[3] = 1.0F; }
  EIGEN_MAKE_ALIGNED_OPERATOR_NEW
};

using LabelledCloud = pcl::PointCloud<LabelledPoint>;
using PanopticCloud = pcl::PointCloud<PanopticPoint>;
}  // namespace lidar_panoptic_clustering

POINT_CLOUD_REGISTER_POINT_STRUCT(lidar_panoptic_clustering::LabelledPoint,
                                  (float, x, x)(float, y, y)(float, z, z)(float, intensity, intensity)  //
                                  (std::uint32_t, label, label))

POINT_CLOUD_REGISTER_POINT_STRUCT(lidar_panoptic_clustering::PanopticPoint,
                                  (float, x, x)(float, y, y)(float, z, z)(float, intensity, intensity)  //
                                  (std::uint32_t, label, label)(std::uint32_t, instance, instance)      //
                                  (std::uint32_t, rgb, rgb))

#include "grid_clusterer.h"

#include <lidar_panoptic_clustering/pipeline/frame_pipeline.h>

#include <nodelet/nodelet.h>
#include <pcl_ros/point_cloud.h>
#include <pluginlib/class_list_macros.hpp>

#include <exception>
#include <memory>

namespace grid_clustering_example
{
namespace lpc = lidar_panoptic_clustering;

/// ~input organised LabelledCloud -> ~output PanopticCloud, the same points with instance ids, by pointer within a
/// manager. Parameters: ~class_table, ~cell_m [m].
class GridClusterNodelet : public nodelet::Nodelet
{
  void onInit() override
  {
    auto& nh = getPrivateNodeHandle();
    const auto table = lpc::ClassTable::load(nh.param<std::string>("class_table", "semantic_kitti"));
    // what surrounds the algorithm, selection and refinement, is the package's own
    pipeline_ =
        std::make_unique<lpc::FramePipeline>(std::make_shared<const lpc::ClassTable>(table), lpc::PipelineConfig(),
                                             std::make_unique<GridClusterer>(nh.param("cell_m", 0.4)));
    output_ = nh.advertise<lpc::PanopticCloud>("output", 1);
    input_ = nh.subscribe<lpc::LabelledCloud>(
        "input", 1, [this](const boost::shared_ptr<const lpc::LabelledCloud>& cloud) { process(*cloud); });
  }

  void process(const lpc::LabelledCloud& cloud)
  {
    try
    {
      const lpc::PanopticCloud::Ptr out(new lpc::PanopticCloud);
      pipeline_->segment(cloud);
      pipeline_->paint(cloud, *out);
      output_.publish(pcl::ros_ptr(out));
    }
    catch (const std::exception& error)
    {
      NODELET_ERROR_THROTTLE(5, "cloud dropped: %s", error.what());
    }
  }

  std::unique_ptr<lpc::FramePipeline> pipeline_;
  ros::Publisher output_;
  ros::Subscriber input_;
};
}  // namespace grid_clustering_example

PLUGINLIB_EXPORT_CLASS(grid_clustering_example::GridClusterNodelet, nodelet::Nodelet)

#pragma once

#include "lidar_panoptic_clustering/core/class_table.h"
#include "lidar_panoptic_clustering/core/point_types.h"
#include "lidar_panoptic_clustering/pipeline/cloud_pool.h"
#include "ros/cloud_subscription.h"
#include "ros/latched_input.h"
#include "ros/mailbox.h"
#include "ros/object_outputs.h"
#include "ros/stream_diagnostics.h"

#include <nodelet/nodelet.h>
#include <ros/ros.h>

#include <functional>
#include <memory>
#include <mutex>
#include <string>
#include <thread>

namespace lidar_panoptic_clustering
{
/// What the nodelets share that make objects of clouds: ~input `Cloud` -> ~output PanopticCloud of the same points,
/// ~objects the object list, which also goes out as ~markers and, where vision_msgs was there, as ~detections;
/// /diagnostics. Subscribes only while someone listens to one of the outputs.
///
/// The callback puts the newest scan into a mailbox of one; a thread of the nodelet's own works on it. A scan that
/// cannot be used is dropped, logged and shown in the diagnostics; the next one is looked at afresh. The scan of a
/// latched input is worked on once a second, for those who begin to listen later.
template <class Cloud>
class ObjectNodelet : public nodelet::Nodelet
{
protected:
  using CloudPtr = boost::shared_ptr<const Cloud>;
  struct Scan
  {
    CloudPtr cloud;
    ros::WallTime arrival;
    ros::Time time;  ///< of arrival
  };

  /// Works on a scan, in the nodelet's thread. What is thrown is why the scan is dropped. No virtual function: what one
  /// calls changes with each destructor that begins, while the thread still runs.
  using Work = std::function<void(const Scan& scan)>;

  /// Reads the parameters; nothing runs yet. What is thrown is why the nodelet is not loaded.
  virtual Work load() = 0;
  /// Advertises what only this nodelet has.
  virtual void advertiseMore() {}
  /// Stops what else calls back, once the thread has ended.
  virtual void stop() {}

  /// Ends the thread and all callbacks: to be called by the destructor of the last class that has members.
  void shutdown();

  bool wantsCloud() const { return output_.getNumSubscribers() > 0; }
  bool wantsMarkers() const { return markers_.getNumSubscribers() > 0; }
  bool wantsObjects() const { return markers_.getNumSubscribers() + objects_.listeners() > 0; }
  /// Whether a newer scan waits.
  bool hasNext() { return mailbox_.hasNext(); }
  /// The class table that ~class_table names.
  std::shared_ptr<const ClassTable> loadClassTable();

  static constexpr const char* kClassTable = "class_table";  ///< parameter

  CloudPool<PanopticCloud> pool_;
  ros::Publisher output_, markers_;
  ObjectOutputs objects_;
  StreamDiagnostics diagnostics_;

private:
  void onInit() final;
  void advertise();
  void connect();
  bool receive(const CloudPtr& cloud);
  Idle describeIdle();
  std::uint32_t listeners() const
  {
    return output_.getNumSubscribers() + markers_.getNumSubscribers() + objects_.listeners();
  }
  void refuse(const std::string& error);
  void run(const Work& work);

  std::mutex connect_mutex_;
  bool closed_ = false;
  ros::Subscriber input_;
  LatchedInput<Cloud> latched_;
  Mailbox<Scan> mailbox_;
  std::thread thread_;
};

extern template class ObjectNodelet<LabelledCloud>;
extern template class ObjectNodelet<PanopticCloud>;
}  // namespace lidar_panoptic_clustering

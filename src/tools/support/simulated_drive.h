#pragma once

#include "lidar_panoptic_clustering/pipeline/factory.h"
#include "lidar_panoptic_clustering/simulation/lidar_simulator.h"
#include "lidar_panoptic_clustering/tracking/cloud_tracker.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
#include <memory>
#include <set>
#include <string>
#include <vector>

namespace lidar_panoptic_clustering
{
/// What tracking made of a simulated drive.
struct DriveFigures
{
  std::size_t objects = 0, kept = 0;     ///< true objects seen long enough, and those of them that kept one id
  std::size_t switches = 0;              ///< of ids, of those objects
  std::size_t tracks = 0, shared = 0;    ///< ids that were some object's, and of more than one true object
  std::vector<double> moving, standing;  ///< errors of vehicles' speeds [m/s]

  DriveFigures& operator+=(const DriveFigures& other)
  {
    objects += other.objects, kept += other.kept, switches += other.switches;
    tracks += other.tracks, shared += other.shared;
    moving.insert(moving.end(), other.moving.begin(), other.moving.end());
    standing.insert(standing.end(), other.standing.begin(), other.standing.end());
    return *this;
  }
};

inline double medianOf(std::vector<double> values)
{
  if (values.empty()) return std::nan("");
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

/// Holds tracks against true objects, scan by scan. An object counts where it has kFewestPoints points or more; one
/// that comes again after more than kLongestGapS is another object; one seen for less than a second is none. Its id in
/// a scan is the one of most of its points.
class DriveJudge
{
public:
  static constexpr std::uint32_t kFewestPoints = 20;
  static constexpr double kLongestGapS = 1.0, kLeastS = 1.0;

  void add(double time_s, const PanopticCloud& truth, const PanopticCloud& tracked)
  {
    std::map<std::uint32_t, std::map<std::uint32_t, std::uint32_t>> points;  // of each track, by true object
    for (std::size_t i = 0; i < truth.size(); ++i)
      if (truth.points[i].instance != 0) ++points[truth.points[i].instance][tracked.points[i].instance];
    for (const auto& [instance, by_track] : points)
    {
      std::uint32_t count = 0, most = 0, track = 0;
      for (const auto& [id, n] : by_track)
      {
        count += n;
        if (n > most) most = n, track = id;
      }
      if (count >= kFewestPoints) see(time_s, instance, track);
    }
  }

  /// The id that an object has now, 0 for none.
  std::uint32_t trackOf(std::uint32_t instance) const
  {
    const auto at = seen_.find(instance);
    return at == seen_.end() ? 0 : at->second.track;
  }

  DriveFigures finish()
  {
    for (const auto& [instance, seen] : seen_) close(seen);
    seen_.clear();
    figures_.tracks = objects_of_.size();
    for (const auto& [track, objects] : objects_of_) figures_.shared += objects.size() > 1 ? 1 : 0;
    return figures_;
  }

  DriveFigures& figures() { return figures_; }

private:
  struct Seen
  {
    double first_s = 0.0, last_s = 0.0;
    std::uint32_t track = 0;
    std::size_t switches = 0;
  };

  void see(double time_s, std::uint32_t instance, std::uint32_t track)
  {
    objects_of_[track].insert(instance);
    const auto [at, is_new] = seen_.emplace(instance, Seen{time_s, time_s, track, 0});
    if (is_new) return;
    Seen& seen = at->second;
    if (time_s - seen.last_s > kLongestGapS + 1e-6)
    {
      close(seen);
      seen = {time_s, time_s, track, 0};
      return;
    }
    if (track != seen.track) ++seen.switches;
    seen.track = track, seen.last_s = time_s;
  }

  void close(const Seen& seen)
  {
    if (seen.last_s - seen.first_s < kLeastS - 1e-6) return;
    ++figures_.objects;
    if (seen.switches == 0) ++figures_.kept;
    figures_.switches += seen.switches;
  }

  std::map<std::uint32_t, Seen> seen_;
  std::map<std::uint32_t, std::set<std::uint32_t>> objects_of_;
  DriveFigures figures_;
};

/// How a drive is made and clustered.
struct DriveOptions
{
  std::string sensor = "hdl32e", algorithm = "birds_eye";  ///< "true": the exact instances in place of an algorithm's
  int seed = 1;
  double seconds = 60.0;
};

/// Drives down a simulated street, clusters its true classes and follows the objects.
class SimulatedDrive
{
public:
  explicit SimulatedDrive(const DriveOptions& options)
      : options_(options),
        table_(std::make_shared<const ClassTable>(ClassTable::load("semantic_kitti"))),
        simulator_(SensorModel::load(options.sensor), configOf(options)),
        tracker_(table_)
  {
    if (options.algorithm == "true") return;
    Algorithm algorithm = makeAlgorithm(options.algorithm, {});
    pipeline_ = std::make_unique<FramePipeline>(table_, algorithm.pipeline, std::move(algorithm.clusterer));
  }

  DriveFigures run()
  {
    const auto frames = static_cast<std::uint64_t>(options_.seconds * simulator_.config().rate_hz);
    for (std::uint64_t frame = 0; frame < frames; ++frame) step(frame);
    return judge_.finish();
  }

private:
  static SimulatorConfig configOf(const DriveOptions& options)
  {
    SimulatorConfig config;
    config.seed = options.seed;
    return config;
  }

  void step(std::uint64_t frame)
  {
    const double time_s = static_cast<double>(frame) / simulator_.config().rate_hz;
    simulator_.scan(frame, truth_);
    cluster();
    const simulation::Pose pose = simulator_.pose(frame);
    Eigen::Isometry3d world_from_sensor = Eigen::Isometry3d::Identity();
    world_from_sensor.linear() = Eigen::AngleAxisd(pose.yaw, Eigen::Vector3d::UnitZ()).toRotationMatrix();
    world_from_sensor.translation() = Eigen::Vector3d(pose.x, pose.y, pose.z);
    tracker_.follow(clustered_, std::llround(1e6 * time_s), world_from_sensor, tracked_);
    judge_.add(time_s, truth_, tracked_);
    judgeSpeeds(frame, world_from_sensor);
  }

  void cluster()
  {
    if (!pipeline_)
    {
      clustered_ = truth_;
      return;
    }
    labelled_.resize(truth_.size());
    labelled_.width = truth_.width, labelled_.height = truth_.height;
    for (std::size_t i = 0; i < truth_.size(); ++i)
    {
      labelled_.points[i].getVector4fMap() = truth_.points[i].getVector4fMap();
      labelled_.points[i].label = truth_.points[i].label;
    }
    pipeline_->segment(labelled_);
    pipeline_->paint(labelled_, clustered_);
  }

  /// Of vehicles within 40 m that have had their track for a second.
  void judgeSpeeds(std::uint64_t frame, const Eigen::Isometry3d& world_from_sensor)
  {
    constexpr double kReachM = 40.0, kOldS = 1.0, kStandsMps = 0.05;
    std::map<std::uint32_t, const ListedTrack*> by_track;
    for (const ListedTrack& listed : tracker_.list(clustered_)) by_track[listed.object.track] = &listed;
    for (const auto& [instance, velocity] : simulator_.velocities(frame, kReachM))
    {
      const auto at = by_track.find(judge_.trackOf(instance));
      if (at == by_track.end() || at->second->instance == 0 || at->second->since_first_seen_s < kOldS) continue;
      const ListedTrack& listed = *at->second;
      const ClassInfo& info = (*table_)[listed.object.class_index];
      if (info.name != "car" && info.name != "truck" && info.name != "other-vehicle") continue;
      if (std::hypot(listed.box.x, listed.box.y) > static_cast<float>(kReachM)) continue;
      const Eigen::Vector3d world = world_from_sensor.linear() * listed.velocity;
      const double error = std::abs(world.head<2>().norm() - velocity.norm());
      (velocity.norm() > kStandsMps ? judge_.figures().moving : judge_.figures().standing).push_back(error);
    }
  }

  DriveOptions options_;
  std::shared_ptr<const ClassTable> table_;
  LidarSimulator simulator_;
  CloudTracker tracker_;
  std::unique_ptr<FramePipeline> pipeline_;
  LabelledCloud labelled_;
  PanopticCloud truth_, clustered_, tracked_;
  DriveJudge judge_;
};
}  // namespace lidar_panoptic_clustering

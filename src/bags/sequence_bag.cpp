#include "bags/sequence_bag.h"

#include "bags/point_message.h"
#include "core/aside_file.h"
#include "core/plain_numbers.h"
#include "ros/pose_message.h"

#include "lidar_panoptic_clustering/core/class_table.h"
#include "lidar_panoptic_clustering/datasets/ground_truth_cloud.h"
#include "lidar_panoptic_clustering/datasets/predicted_classes.h"
#include "lidar_panoptic_clustering/datasets/semantic_kitti.h"

#include <pcl_conversions/pcl_conversions.h>
#include <rosbag/bag.h>
#include <tf2_msgs/TFMessage.h>

#include <cmath>
#include <filesystem>
#include <memory>
#include <optional>
#include <stdexcept>
#include <vector>

namespace lidar_panoptic_clustering
{
namespace
{
constexpr double kScanPeriod = 0.1;  // [s]

rosbag::CompressionType compressionOf(const std::string& name)
{
  if (name == "none") return rosbag::compression::Uncompressed;
  if (name == "lz4") return rosbag::compression::LZ4;
  if (name == "bz2") return rosbag::compression::BZ2;
  throw std::invalid_argument("compression: expected none, lz4 or bz2, found '" + name + "'");
}

/// A bag that gets its name only once it is whole.
class AsideBag
{
public:
  AsideBag(const std::string& path, rosbag::CompressionType compression) : path_(path)
  {
    const auto status = std::filesystem::status(path);
    if (std::filesystem::exists(status) && !std::filesystem::is_regular_file(status))
      throw std::runtime_error("cannot write " + path + ": expected a regular file or none");
    aside_ = makeAside(path);
    try
    {
      bag_->setCompression(compression);
      bag_->open(aside_, rosbag::bagmode::Write);
    }
    catch (const std::exception& error)
    {
      std::filesystem::remove(aside_);
      throw std::runtime_error("cannot write " + path_ + ": " + error.what());
    }
  }
  ~AsideBag()
  {
    if (saved_) return;
    try
    {
      bag_->close();
    }
    catch (const std::exception&)
    {
      abandon(std::move(bag_));
    }
    std::error_code ignored;
    std::filesystem::remove(aside_, ignored);
  }
  AsideBag(const AsideBag&) = delete;
  AsideBag& operator=(const AsideBag&) = delete;

  template <class Message>
  void write(const std::string& topic, const ros::Time& stamp, const Message& message)
  {
    attempt([&] { bag_->write(topic, stamp, message); });
  }

  /// Returns the file's size [bytes].
  std::uint64_t save()
  {
    attempt(
        [&]
        {
          bag_->close();
          std::filesystem::rename(aside_, path_);
        });
    saved_ = true;
    return std::filesystem::file_size(path_);
  }

private:
  template <class Work>
  void attempt(Work work)
  {
    try
    {
      work();
    }
    catch (const std::exception& error)
    {
      throw std::runtime_error("cannot write " + path_ + ": " + error.what());
    }
  }

  /// A bag's destructor writes what it still holds, and where that fails (a full disk) it ends the program: such a bag
  /// is kept until the program ends by itself.
  static void abandon(std::unique_ptr<rosbag::Bag> bag)
  {
    static auto* const abandoned = new std::vector<std::unique_ptr<rosbag::Bag>>;
    abandoned->push_back(std::move(bag));
  }

  std::string path_, aside_;
  std::unique_ptr<rosbag::Bag> bag_ = std::make_unique<rosbag::Bag>();
  bool saved_ = false;
};

class SequenceBagWriter
{
public:
  explicit SequenceBagWriter(const SequenceBagConfig& config)
      : config_(config),
        table_(std::make_shared<const ClassTable>(ClassTable::load(config.class_table))),
        sequence_(config.dataset, config.sequence, config.semantics),
        projector_(config.projection),
        poses_(sequence_.readPoses()),
        times_(sequence_.readTimes())
  {
    if (config.frame_id.empty() || config.frame_id.front() == '/')
      throw std::invalid_argument("frame id: expected a name without a leading slash, found '" + config.frame_id + "'");
    if (!(config.start_s >= 1.0 && config.start_s <= 4e9))
      throw std::invalid_argument("start: expected 1 to 4e9 seconds, found " + shortText(config.start_s));
    if (config.first >= sequence_.size())
      throw std::invalid_argument("first: expected one of the scans 0 to " + std::to_string(sequence_.size() - 1) +
                                  " of sequence " + sequence_.name() + ", found " + std::to_string(config.first));
    if (!config.label_table.empty() && config.semantics.empty())
      throw std::invalid_argument("label table: expected predictions whose ids it says, found none");
    if (config.semantics.empty()) return;
    predicted_.emplace(sequence_, table_, config.label_table);
    summary_.doubt = predicted_->doubt();
  }

  SequenceBagSummary write(const SequenceBagProgress& progress)
  {
    AsideBag bag(config_.output, compressionOf(config_.compression));
    const std::uint64_t left = sequence_.size() - config_.first;
    const std::uint64_t all = config_.count == 0 ? left : std::min(config_.count, left);
    for (std::uint64_t done = 0;; ++done)
    {
      if (!progress(done, all)) throw std::runtime_error("interrupted");
      if (done == all) break;
      writeScan(config_.first + done, bag);
    }
    summary_.bytes = bag.save();
    return summary_;
  }

private:
  void writeScan(std::size_t scan, AsideBag& bag)
  {
    read(scan);
    projector_.project(points_, {}, projection_);
    std_msgs::Header header;
    header.frame_id = config_.frame_id;
    header.stamp = stampOf(scan);
    header.seq = static_cast<std::uint32_t>(scan);
    if (!poses_.empty())
    {
      tf2_msgs::TFMessage message;
      message.transforms.push_back(transformOf(poses_[scan], config_.frame_id, header.stamp));
      bag.write("/tf", header.stamp, message);
    }
    const auto& labels = config_.semantics.empty() ? truth_ : predictions_;
    toPointMessage(points_, projection_, labels, message_);
    message_.header = header;
    bag.write("/points", header.stamp, message_);
    if (!truth_.empty())
    {
      paintGroundTruth(projection_, truth_, *table_, ground_truth_);
      pcl::toROSMsg(ground_truth_, message_);
      message_.header = header;
      bag.write("/ground_truth", header.stamp, message_);
    }
    ++summary_.scans;
    summary_.points += points_.size();
    summary_.labelled = summary_.labelled || !labels.empty();
    summary_.ground_truth = summary_.ground_truth || !truth_.empty();
    summary_.poses = !poses_.empty();
  }

  void read(std::size_t scan)
  {
    sequence_.readScan(scan, points_);
    truth_.clear();
    if (sequence_.hasLabels()) sequence_.readLabels(scan, points_.size(), truth_);
    if (predicted_) predicted_->read(sequence_, scan, points_.size(), predictions_);
  }

  ros::Time stampOf(std::size_t scan) const
  {
    const double elapsed = times_.empty() ? kScanPeriod * static_cast<double>(scan) : times_.at(scan);
    ros::Time stamp;
    stamp.fromNSec(static_cast<std::uint64_t>(std::llround(config_.start_s * 1e6) + std::llround(elapsed * 1e6)) *
                   1000);
    return stamp;
  }

  const SequenceBagConfig& config_;
  std::shared_ptr<const ClassTable> table_;
  SemanticKittiSequence sequence_;
  std::optional<PredictedClasses> predicted_;
  PointProjector projector_;
  std::vector<Eigen::Isometry3d> poses_;
  std::vector<double> times_;

  std::vector<ScanPoint> points_;
  std::vector<std::uint32_t> truth_, predictions_;
  Projection projection_;
  PanopticCloud ground_truth_;
  sensor_msgs::PointCloud2 message_;
  SequenceBagSummary summary_;
};
}  // namespace

SequenceBagSummary writeSequenceBag(const SequenceBagConfig& config, const SequenceBagProgress& progress)
{
  return SequenceBagWriter(config).write(progress);
}
}  // namespace lidar_panoptic_clustering

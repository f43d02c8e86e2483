#include "lidar_panoptic_clustering/tracking/observation.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

namespace lidar_panoptic_clustering
{
bool Extent::fitsTurned(float length, float width) const
{
  constexpr int kHeadings = 16;
  constexpr float kPi = 3.14159265F, kAxis[kAxes] = {0.0F, 0.5F * kPi, 0.25F * kPi, -0.25F * kPi};
  for (int heading = 0; heading < kHeadings; ++heading)
  {
    bool fits = true;
    for (std::size_t k = 0; k < kAxes && fits; ++k)
    {
      const float turn = kPi * static_cast<float>(heading) / kHeadings - kAxis[k];
      fits = max[k] - min[k] <= length * std::abs(std::cos(turn)) + width * std::abs(std::sin(turn));
    }
    if (fits) return true;
  }
  return false;
}

ObservationBuilder::ObservationBuilder(std::shared_ptr<const ClassTable> table) : table_(std::move(table))
{
  if (!table_) throw std::invalid_argument("tracking needs a class table");
  classes_ = table_->size();
}

void ObservationBuilder::begin(const Eigen::Isometry3d& fixed_from_sensor)
{
  rotation_ = fixed_from_sensor.linear().cast<float>();
  observations_.origin = fixed_from_sensor.translation();
  observations_.list.clear();
  place_of_.reset();
  votes_.clear(), sum_.clear();
  last_instance_ = 0;
}

std::uint32_t ObservationBuilder::placeOf(std::uint32_t instance)
{
  if (instance == last_instance_) return last_place_;  // points of an object come in runs
  last_instance_ = instance;
  last_place_ =
      place_of_.insert({static_cast<std::int32_t>(instance & 0xFFFFU), static_cast<std::int32_t>(instance >> 16U), 0});
  if (last_place_ == observations_.list.size())
  {
    observations_.list.emplace_back();
    Observation& observation = observations_.list.back();
    observation.instance = instance;
    observation.min_z = Extent::kFar, observation.max_z = -Extent::kFar;
    votes_.resize(votes_.size() + classes_, 0);
    sum_.push_back(Eigen::Vector2d::Zero());
  }
  return last_place_;
}

std::uint32_t ObservationBuilder::add(std::uint32_t instance, ClassIndex class_index, float x, float y, float z)
{
  const std::uint32_t place = placeOf(instance);
  if (!std::isfinite(x) || !std::isfinite(y) || !std::isfinite(z)) return place;
  const auto along = [&](int row) { return rotation_(row, 0) * x + rotation_(row, 1) * y + rotation_(row, 2) * z; };
  const float px = along(0), py = along(1), pz = along(2);  // a product of Eigen's is a call here
  Observation& observation = observations_.list[place];
  ++observation.point_count;
  ++votes_[place * classes_ + class_index];
  observation.extent.add(px, py);
  observation.min_z = std::min(observation.min_z, pz);
  observation.max_z = std::max(observation.max_z, pz);
  sum_[place].x() += static_cast<double>(px);
  sum_[place].y() += static_cast<double>(py);
  return place;
}

const Observations& ObservationBuilder::finish()
{
  for (std::size_t i = 0; i < observations_.list.size(); ++i)
  {
    Observation& observation = observations_.list[i];
    if (observation.point_count == 0)
    {
      const std::uint32_t instance = observation.instance;
      observation = Observation();
      observation.instance = instance;
      continue;
    }
    const auto* votes = votes_.data() + i * classes_;
    const auto most = std::max_element(votes, votes + classes_) - votes;
    observation.class_index = static_cast<ClassIndex>(most);
    observation.class_share = static_cast<float>(votes[most]) / static_cast<float>(observation.point_count);
    observation.x = static_cast<float>(sum_[i].x() / observation.point_count);
    observation.y = static_cast<float>(sum_[i].y() / observation.point_count);
  }
  return observations_;
}
}  // namespace lidar_panoptic_clustering

#pragma once

#include "lidar_panoptic_clustering/projection/point_projection.h"

#include <Eigen/Core>

#include <cstdint>
#include <optional>
#include <vector>

namespace lidar_panoptic_clustering
{
/// Finds out by their elevations which row each ring of a scan is, however the rings are numbered.
///
/// The elevation is the one in the cloud's frame, z over range; where the rings cannot be told apart by it, the one
/// over the plane in which the rings lie best, so that a tilted frame does not blur them. Looks at one point in 13, so
/// that firings of any usual number of lasers show all of them. Buffers are kept.
class RingOrder
{
public:
  /// `directions`: one a point, `row` being the ring, below `rings`. Linear.
  ///
  /// `remember`: rings that return nothing are taken to be where they were when they did, in an earlier scan that was
  /// looked at so; for streams whose rings keep their numbers.
  void look(const std::vector<ScanPoint>& scan, const std::vector<PointDirection>& directions, std::uint32_t rings,
            bool remember = false);
  /// Begins anew, for another stream.
  void forget() { remembered_.clear(); }

  /// By ring: its row, 0 for the highest. Numbers that rise or fall with the elevation keep their sequence, rings
  /// without a return included; others (lasers numbered as they fire) go by their mean elevation, unless this is too
  /// blurred to tell two rings apart.
  const std::vector<std::uint32_t>& rowOfRing() const { return row_of_ring_; }

  /// Whether the elevations fall (or rise) from ring to ring through the whole scan: the mark of a file whose rings
  /// come one after another. Nine in ten steps go that way, and none goes back by a quarter of the whole.
  bool isMonotone() const;

  /// Whether the elevations give the rings a sequence: they are monotone or distinct.
  bool areOrdered() const { return isMonotone() || areDistinct(); }

  /// Whether the elevations neither fall nor rise through the scan, though neighbours may go to and fro, as those of
  /// sorted rings do in a frame that is not the sensor's. False where there are too few returns to tell.
  bool goesNoWay() const;

  /// Whether hardly any two rings share an elevation, and each keeps to its own: the mark of rings in any sequence.
  bool areDistinct() const;

  /// Whether rings that have no order each keep to an elevation, which some then share: of several lidars, or of
  /// several returns of each laser. False where there are too few returns to tell.
  bool shareElevations() const;

  /// Whether a ring says nothing about the elevation: that varies within a ring as it does in the whole scan, where it
  /// does so at all. False where there are too few returns to tell.
  bool tellsNothing() const;

  /// Between the axis of the rings that could be told apart over it and the cloud's z.
  double tiltRad() const { return tilt_; }
  /// Between the axis about which the rings turn and the cloud's z, whether or not z tells the rings apart. Empty where
  /// they span too little of a turn, or are too blurred, to have one.
  std::optional<double> tiltOfAxis() const;
  double scatterRad() const { return scatter_; }          ///< standard deviation within a ring, mean over rings
  double rangeRad() const { return highest_ - lowest_; }  ///< from the lowest ring's mean to the highest's

private:
  struct Ring
  {
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();              ///< of the directions
    Eigen::Matrix3d sum_of_products = Eigen::Matrix3d::Zero();  ///< likewise
    std::uint32_t count = 0;
    double mean = 0.0, variance = 0.0;  ///< of the elevation's sine over axis_
  };
  void sum(const std::vector<ScanPoint>& scan, const std::vector<PointDirection>& directions, std::uint32_t rings);
  void recall();
  void lookAlong(const Eigen::Vector3d& axis);
  void countSteps();
  std::uint32_t returns() const;  ///< that were looked at
  void collectMeans() const;
  Eigen::Matrix3d scatterWithinRings() const;
  Eigen::Vector3d axisOfRings() const;
  bool canBeSorted() const;
  void sortByElevation();

  std::vector<Ring> rings_, remembered_;
  int falls_ = 0, rises_ = 0, seen_ = 0;  ///< steps from one ring that was seen to the next
  double largest_fall_ = 0.0, largest_rise_ = 0.0, lowest_ = 0.0, highest_ = 0.0, scatter_ = 0.0, tilt_ = 0.0;
  std::vector<std::uint32_t> row_of_ring_, ring_of_row_;
  std::vector<double> elevation_;      ///< by ring; of rings not seen, the one before's
  mutable std::vector<double> means_;  ///< of the rings that were seen
};
}  // namespace lidar_panoptic_clustering

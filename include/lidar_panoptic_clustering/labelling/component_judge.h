#pragma once

#include "lidar_panoptic_clustering/labelling/scan_components.h"

#include <string>
#include <vector>

namespace lidar_panoptic_clustering
{
/// Which side of the bargain between false objects and lost ones.
enum class StructureBias
{
  kStrict,      ///< what may be a wall, a hedge or a pole is: the fewest false objects
  kBalanced,    ///< as far as sizes, feet and surfaces tell
  kKeepObjects  ///< what may be an object is: the fewest lost ones
};

/// "strict", "balanced", "keep_objects"
const std::vector<std::string>& structureBiasNames();
/// Throws std::invalid_argument for any other name.
StructureBias structureBiasFromName(const std::string& name);

/// What decides between an object and a structure, by sizes of vehicles and people, by how things stand and by how
/// light reaches them. Nothing is learnt.
///
/// Structure is what is
/// - higher, longer or wider than any vehicle, hovers above everything that drives or walks, or ends below it;
/// - as thin as a post, or as high as a pole and no longer than a man;
/// - rough as foliage: neighbours in a scan line bend by as much as they are apart; sheet metal, clothes and walls do
///   not. Two-wheelers and their riders do, and cars seen through their windows, but stand on wheels;
/// - a wall: beams that come by where a vehicle has its gap to the ground end at its foot. A beam that meets the ground
///   before it gets there tells nothing, so that a car is not judged by beams that never came near its sill, which are
///   most where beams are far apart. A vehicle's own wheels block a quarter of its length, so half is asked for, and
///   less where the outline is a car's. Columns in which something nearer stands before the foot are no witnesses:
///   where they are four times as many as those that saw it, the foot counts as hidden;
/// - the upper part of something tall whose foot is hidden, and too narrow for a van, or hardly anywhere free: a house
///   over parked cars goes on on either side of them, a lorry ends;
/// - seen through gaps of what is nearer: no gap under it, and hardly an end beyond which the beams go farther, as at
///   the wall behind a hedge. What stands in a street has the street behind it on one side at least; what shows two
///   sides of a car's size is no wall.
///
/// In a structure a part is a person that has a person's size and height, is not rough, does not hang over beams that
/// came by underneath, and stands free on both sides: beyond its outline the beams go farther. The same makes a
/// structure of what is around a person and has nothing of a vehicle: a stall, a bench. What is no larger than a
/// two-wheeler with its rider is none: there is no room for both.
///
/// Who leans on a counter is one part with it. Columns of a part that rise above what is beside them as head and
/// shoulders do (see ColumnProfile), and above which the beams go farther, are judged as such a person if the component
/// is structure or too rough for sheet metal. What goes on above, as a trunk in a hedge, and what shows less than half
/// a chest's depth, as a post and a board, is none. At least half of the outline must stand free, the counter's side
/// included, so that someone is not found who shows more of himself before the counter than above it.
class ComponentJudge
{
public:
  /// [m]
  struct Limits
  {
    float height, length;  ///< of the largest object
  };

  /// `bias`: which error is the smaller one where the geometry leaves both open.
  ComponentJudge(const Limits& limits, StructureBias bias);

  /// Whether a component is a wall, a tree, a pole or the like; a few comparisons.
  bool isStructure(const ScanComponent& component) const;
  /// Whether a part of a component is a person.
  bool isPerson(const ScanComponent& part) const;
  /// Whether columns that were cut from a part are a person (see ColumnProfile): as others, and half a chest's depth is
  /// seen, which a post and what is fixed to it do not show.
  bool isPersonCutOff(const ScanComponent& part) const;
  /// Whether a part may be a person or hold one: it is as high, as low and has as many returns.
  static bool mayHoldPerson(const HeightRange& part);
  /// Whether its surface is no rougher than sheet metal with windows.
  bool isSmooth(const ScanComponent& component) const;
  /// Whether a component that a person was found in is an object nevertheless.
  bool isVehicle(const ScanComponent& component) const;

private:
  struct Appearance;
  /// Thresholds, by bias.
  struct Bargain
  {
    float most_rough;         ///< share of rough triples in an object
    float hidden_foot_width;  ///< [m] of what is tall and shows no foot: from there on it may be a van
    float least_free_tall;    ///< share of the outline of what is tall and whose foot something hides
    float undercut, cars;     ///< least shares of undercut feet, in general and with a car's outline
    float least_free;         ///< share of a person's outline
    float least_in_front;     ///< the same of what shows no foot
  };
  static Bargain bargainOf(StructureBias bias);
  static bool isPole(const ScanComponent& c, const Appearance& a);
  bool isFoliage(const Appearance& a) const;
  bool isWall(const ScanComponent& c, const Appearance& a) const;
  bool isBehind(const ScanComponent& c, const Appearance& a) const;

  Limits limits_;
  Bargain bargain_;
};
}  // namespace lidar_panoptic_clustering

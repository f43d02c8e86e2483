#pragma once

#include <string>
#include <vector>

namespace lidar_panoptic_clustering
{
/// How many letters have to be exchanged, inserted or left out to make one word of the other (Levenshtein 1966). Takes
/// time and memory in proportion to the product of the lengths.
std::size_t editDistance(const std::string& a, const std::string& b);

/// The one of `names` that `name` most likely stands for: the nearest by edit distance (the first of equals), or one of
/// which it is a part, as `distance` is of `distance_m`. Empty where all differ in more than a third of their letters.
std::string nearestName(const std::string& name, const std::vector<std::string>& names);
}  // namespace lidar_panoptic_clustering

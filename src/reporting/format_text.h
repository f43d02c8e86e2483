#pragma once

#include "core/plain_numbers.h"

#include <cstdio>
#include <string>

namespace lidar_panoptic_clustering
{
/// A line of a report by printf's rules, without the locale, cut off after 255 characters.
template <class... Values>
std::string formatText(const char* pattern, Values... values)
{
  const PlainNumbers plain;
  char text[256];
  std::snprintf(text, sizeof(text), pattern, values...);
  return text;
}
}  // namespace lidar_panoptic_clustering

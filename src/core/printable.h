#pragma once

#include <cstdint>
#include <string>

namespace lidar_panoptic_clustering
{
/// Text from outside, as of a report or a file's name, for a terminal: each control character, which could move the
/// cursor or change the window's title, becomes \xNN. Line breaks and tabs stay with `lines`, UTF-8 always.
inline std::string printable(const std::string& text, bool lines = true)
{
  constexpr char kDigits[] = "0123456789abcdef";
  std::string result;
  result.reserve(text.size());
  for (std::size_t i = 0; i < text.size(); ++i)
  {
    const auto c = static_cast<unsigned char>(text[i]);
    const auto next = static_cast<unsigned char>(i + 1 < text.size() ? text[i + 1] : 0);
    const bool high_control = c == 0xC2 && next >= 0x80 && next < 0xA0;  // U+0080 to U+009F
    const bool low_control = (c < 0x20 && !(lines && (c == '\n' || c == '\t'))) || c == 0x7F;
    if (high_control || low_control)
      result += {'\\', 'x', kDigits[(high_control ? next : c) >> 4U], kDigits[(high_control ? next : c) & 15U]};
    else
      result += text[i];
    if (high_control) ++i;
  }
  return result;
}
}  // namespace lidar_panoptic_clustering

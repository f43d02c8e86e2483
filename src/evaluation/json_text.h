#pragma once

#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <string>

namespace lidar_panoptic_clustering
{
/// Of sums of any benchmark; a sum of two still fits into 64 bits.
constexpr std::uint64_t kMostCount = std::uint64_t{1} << 62U;

/// Throws std::invalid_argument, naming `source` and what was `expected`, where the text is not JSON, or nested deeper
/// than any report: nlohmann's dump() calls itself for each level, in older releases its destructor too.
nlohmann::json parseJson(const std::string& text, const std::string& source, const std::string& expected);

/// A value for messages, cut off after 60 characters.
std::string briefly(const nlohmann::json& value);

/// Members of an object. Each throws std::invalid_argument naming the key when it is missing or something else.
const nlohmann::json& jsonMember(const nlohmann::json& object, const char* key);
const nlohmann::json& jsonList(const nlohmann::json& object, const char* key);
std::string jsonText(const nlohmann::json& object, const char* key);
/// A whole number from 0 to `most`.
std::uint64_t jsonNumber(const nlohmann::json& object, const char* key, std::uint64_t most = kMostCount);
}  // namespace lidar_panoptic_clustering

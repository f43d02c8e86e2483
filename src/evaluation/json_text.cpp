#include "evaluation/json_text.h"

#include <algorithm>
#include <nlohmann/json.hpp>
#include <stdexcept>

namespace lidar_panoptic_clustering
{
namespace
{
using nlohmann::json;

constexpr int kMaxDepth = 64;

/// Of brackets outside of text.
int depthOf(const std::string& text)
{
  int open = 0, deepest = 0;
  bool quoted = false;
  for (std::size_t i = 0; i < text.size(); ++i)
  {
    const char c = text[i];
    if (c == '"') quoted = !quoted;
    if (quoted && c == '\\') ++i;
    if (quoted) continue;
    if (c == '[' || c == '{') deepest = std::max(deepest, ++open);
    if (c == ']' || c == '}') --open;
  }
  return deepest;
}

[[noreturn]] void fail(const char* key, const json& value, const std::string& expected)
{
  throw std::invalid_argument("key '" + std::string(key) + "' is " + briefly(value) + ", expected " + expected);
}
}  // namespace

json parseJson(const std::string& text, const std::string& source, const std::string& expected)
{
  if (depthOf(text) > kMaxDepth)
    throw std::invalid_argument(source + ": nested more than " + std::to_string(kMaxDepth) + " deep, expected " +
                                expected);
  json parsed = json::parse(text, nullptr, false);
  if (parsed.is_discarded()) throw std::invalid_argument(source + ": not JSON, expected " + expected);
  return parsed;
}

std::string briefly(const json& value)
{
  constexpr std::size_t kMostShown = 60;
  const std::string text = value.dump(-1, ' ', true, json::error_handler_t::replace);
  return text.size() <= kMostShown ? text : text.substr(0, kMostShown) + "..";
}

const json& jsonMember(const json& object, const char* key)
{
  if (!object.is_object() || object.find(key) == object.end())
    throw std::invalid_argument("key '" + std::string(key) + "' is missing");
  return *object.find(key);
}

const json& jsonList(const json& object, const char* key)
{
  const json& value = jsonMember(object, key);
  if (!value.is_array()) fail(key, value, "a list");
  return value;
}

std::string jsonText(const json& object, const char* key)
{
  const json& value = jsonMember(object, key);
  if (!value.is_string()) fail(key, value, "text");
  return value.get<std::string>();
}

std::uint64_t jsonNumber(const json& object, const char* key, std::uint64_t most)
{
  const json& value = jsonMember(object, key);
  if (!value.is_number_unsigned()) fail(key, value, "a whole number");
  if (value.get<std::uint64_t>() > most) fail(key, value, "at most " + std::to_string(most));
  return value.get<std::uint64_t>();
}
}  // namespace lidar_panoptic_clustering

#include "lidar_panoptic_clustering/core/parameters.h"

#include "core/plain_numbers.h"
#include "core/printable.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace lidar_panoptic_clustering
{
std::string parameterText(const ParameterValue& value)
{
  if (const auto* held = std::get_if<bool>(&value)) return *held ? "true" : "false";
  if (const auto* held = std::get_if<int>(&value)) return std::to_string(*held);
  if (const auto* held = std::get_if<double>(&value)) return shortText(*held, 15);
  return std::get<std::string>(value);
}

namespace detail
{
namespace
{
std::string quoted(const ParameterValue& value)
{
  const std::string text = printable(parameterText(value), false);
  return std::holds_alternative<std::string>(value) ? "'" + text + "'" : text;
}

[[noreturn]] void fail(const std::string& name, const std::string& expected, const ParameterValue& value)
{
  throw std::invalid_argument("parameter '" + name + "': expected " + expected + ", got " + quoted(value));
}

std::string range(double min, double max)
{
  return "from " + shortText(min) + " to " + shortText(max);
}

/// NaN where the value is no number; text that is a number as a whole counts, as command lines give it.
double numberIn(const ParameterValue& value)
{
  if (const auto* held = std::get_if<double>(&value)) return *held;
  if (const auto* held = std::get_if<int>(&value)) return *held;
  if (const auto* held = std::get_if<std::string>(&value)) return parseNumber(*held).value_or(std::nan(""));
  return std::nan("");
}
}  // namespace

int toInt(const std::string& name, const ParameterValue& value, int min, int max)
{
  const double number = numberIn(value);
  if (!(number >= min && number <= max) || number != std::floor(number))
    fail(name, "a whole number " + range(min, max), value);
  return static_cast<int>(number);
}

double toDouble(const std::string& name, const ParameterValue& value, double min, double max)
{
  const double number = numberIn(value);
  if (!(number >= min && number <= max)) fail(name, "a number " + range(min, max), value);
  return number;
}

bool toBool(const std::string& name, const ParameterValue& value)
{
  if (const auto* held = std::get_if<bool>(&value)) return *held;
  if (const auto* held = std::get_if<std::string>(&value))
  {
    if (*held == "true" || *held == "1") return true;
    if (*held == "false" || *held == "0") return false;
  }
  fail(name, "true or false", value);
}

std::string toChoice(const std::string& name, const ParameterValue& value, const std::vector<std::string>& choices)
{
  const auto* held = std::get_if<std::string>(&value);
  if (held != nullptr && (choices.empty() || std::find(choices.begin(), choices.end(), *held) != choices.end()))
    return *held;
  std::string expected = choices.empty() ? "text" : "one of";
  for (const auto& choice : choices) expected += " '" + choice + "'";
  fail(name, expected, value);
}

void throwUnknown(const std::string& name, const std::vector<ParameterInfo>& known)
{
  std::string list;
  for (const auto& info : known) list += (list.empty() ? "" : ", ") + info.name;
  throw std::invalid_argument("there is no parameter '" + name + "'; there are: " + list);
}
}  // namespace detail

void requireOffOrDistance(const std::string& name, double metres, double max)
{
  if (metres != 0.0 && !(metres >= kLeastDistanceM && metres <= max))
    detail::fail(name, "0 or a number " + detail::range(kLeastDistanceM, max), metres);
}
}  // namespace lidar_panoptic_clustering

#include "lidar_panoptic_clustering/core/parameters.h"

#include <algorithm>
#include <cmath>
#include <sstream>
#include <stdexcept>

namespace lidar_panoptic_clustering::detail
{
namespace
{
std::string printed(const ParameterValue& value)
{
  std::ostringstream text;
  std::visit(
      [&text](const auto& held)
      {
        if constexpr (std::is_same_v<std::decay_t<decltype(held)>, std::string>)
          text << '\'' << held << '\'';
        else
          text << std::boolalpha << held;
      },
      value);
  return text.str();
}

[[noreturn]] void fail(const std::string& name, const std::string& expected, const ParameterValue& value)
{
  throw std::invalid_argument("parameter '" + name + "': expected " + expected + ", got " + printed(value));
}

std::string range(double min, double max)
{
  std::ostringstream text;
  text << "from " << min << " to " << max;
  return text.str();
}

/// NaN where the value is no number; text that is a number as a whole counts, as command lines give it.
double numberIn(const ParameterValue& value)
{
  if (const auto* held = std::get_if<double>(&value)) return *held;
  if (const auto* held = std::get_if<int>(&value)) return *held;
  if (const auto* held = std::get_if<std::string>(&value))
  {
    std::istringstream text(*held);
    double number = 0.0;
    if (text >> number && text.eof()) return number;
  }
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
}  // namespace lidar_panoptic_clustering::detail

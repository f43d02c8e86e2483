#pragma once

#include "core/input_file.h"
#include "core/printable.h"
#include "tools/support/interrupt.h"

#include <boost/program_options.hpp>

#include <cstdint>
#include <cstdlib>
#include <exception>
#include <iostream>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

namespace lidar_panoptic_clustering
{
/// What a command line gave, by option.
using Given = boost::program_options::variables_map;
using Options = boost::program_options::options_description;

/// The options of a program: `usage`, what --help prints above their list, and --help itself.
inline Options describeProgram(const char* usage)
{
  Options options(usage, 110, 60);
  options.add_options()("help,h", "this text");
  return options;
}

/// Values of options, for their descriptions.
inline auto textValue(const char* name)
{
  return boost::program_options::value<std::string>()->value_name(name);
}
inline auto textValue(const char* name, const std::string& value)
{
  return textValue(name)->default_value(value);
}
inline auto textValues(const char* name)
{
  return boost::program_options::value<std::vector<std::string>>()->value_name(name)->multitoken();
}
inline auto numberValue(int value)
{
  return boost::program_options::value<int>()->value_name("N")->default_value(value);
}

inline bool isGiven(const Given& given, const char* option)
{
  return given.count(option) != 0;
}

/// "" where it is not given.
inline std::string textOf(const Given& given, const char* option)
{
  return isGiven(given, option) ? given[option].as<std::string>() : "";
}

inline std::vector<std::string> listOf(const Given& given, const char* option)
{
  return isGiven(given, option) ? given[option].as<std::vector<std::string>>() : std::vector<std::string>{};
}

/// Throws std::invalid_argument where it is not given.
inline const std::string& required(const Given& given, const char* option)
{
  if (!isGiven(given, option)) throw std::invalid_argument(std::string("--") + option + " is missing; see --help");
  return given[option].as<std::string>();
}

/// Throws std::invalid_argument outside the range.
inline int numberOf(const Given& given, const char* option, int min, int max)
{
  const int value = given[option].as<int>();
  if (value < min || value > max)
    throw std::invalid_argument("--" + std::string(option) + " is " + std::to_string(value) + ", expected " +
                                std::to_string(min) + " to " + std::to_string(max));
  return value;
}

/// The non-empty parts of a list; throws std::invalid_argument naming `option` when there is none.
inline std::vector<std::string> splitAtCommas(const std::string& list, const std::string& option)
{
  std::vector<std::string> names;
  std::istringstream in(list);
  for (std::string name; std::getline(in, name, ',');)
    if (!name.empty()) names.push_back(name);
  if (names.empty()) throw std::invalid_argument(option + " is given an empty list");
  return names;
}

/// Most that is read of a report [bytes]; one of a whole data set has some 30 MB.
constexpr std::uint64_t kMaxReport = std::uint64_t{1} << 29U;

/// Prints a program's result, parts of which may come from files; throws std::runtime_error where standard output takes
/// none (a full disk, a closed pipe).
inline void printResult(const std::string& text)
{
  std::cout << printable(text) << std::flush;
  if (!std::cout) throw std::runtime_error("cannot write to standard output");
}

/// The whole of main(): reads the options, prints --help, else runs `run`. Its exit status is run's; 1 after an error,
/// which is printed to stderr behind the program's `name`; 128 and the signal's number after an interrupt that ended
/// in an error.
///
/// Options cannot be abbreviated: a later one must not change what a script means.
template <class Run>
int runProgram(const char* name, int argc, char** argv, const Options& options, Run run)
{
  namespace po = boost::program_options;
  try
  {
    Given given;
    const int style = po::command_line_style::default_style & ~po::command_line_style::allow_guessing;
    const po::positional_options_description none;
    po::store(po::command_line_parser(argc, argv).options(options).positional(none).style(style).run(), given);
    if (!isGiven(given, "help")) return run(given);
    std::cout << options;
    return EXIT_SUCCESS;
  }
  catch (const std::exception& error)
  {
    std::cerr << name << ": " << printable(error.what()) << "\n";
    return interrupted() != 0 ? 128 + interrupted() : EXIT_FAILURE;
  }
}
}  // namespace lidar_panoptic_clustering

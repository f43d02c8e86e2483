#pragma once

#include "core/input_file.h"
#include "core/system_error.h"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdint>
#include <filesystem>
#include <map>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace lidar_panoptic_clustering
{
/// A file of one line a scan, "name,field,field;", that threads and processes may write at once: each line is appended
/// in one piece, and nothing is lost when the program is killed. A line begins with its line break: what a full disk
/// cut short before it stays a line of its own, and is left out in reading. Of two lines of a scan the later counts.
class ScanLog
{
public:
  /// Reads what is there. Throws std::runtime_error.
  ScanLog(std::string path, std::size_t fields) : path_(std::move(path))
  {
    if (!std::filesystem::exists(path_)) return;
    const std::string text = readTextFile(path_, std::uint64_t{1} << 30U);
    for (std::size_t begin = 0; begin < text.size();)
    {
      const std::size_t end = std::min(text.find('\n', begin), text.size());
      readLine(text.substr(begin, end - begin), fields);
      begin = end + 1;
    }
  }

  /// What was there of a scan when this was made; null where that was nothing.
  const std::vector<std::string>* find(const std::string& scan) const
  {
    const auto found = lines_.find(scan);
    return found == lines_.end() ? nullptr : &found->second;
  }

  /// Throws std::runtime_error with the path and the system's reason.
  void append(const std::string& scan, const std::vector<std::string>& fields) const
  {
    std::string line = "\n" + escaped(scan);
    for (const std::string& field : fields) line += "," + field;
    line += ";";
    const int file = ::open(path_.c_str(), O_WRONLY | O_CREAT | O_APPEND | O_CLOEXEC, 0666);
    const ssize_t written = file < 0 ? -1 : ::write(file, line.data(), line.size());
    int error = written < 0 ? errno : written == static_cast<ssize_t>(line.size()) ? 0 : ENOSPC;
    if (file >= 0 && ::close(file) != 0 && error == 0) error = errno;
    if (error != 0) throw std::runtime_error("cannot write " + path_ + ": " + systemError(error));
  }

private:
  static constexpr char kDigits[] = "0123456789ABCDEF";

  /// A file's name may hold any byte but '/' and 0: those that part fields and lines become %XX.
  static std::string escaped(const std::string& name)
  {
    std::string result;
    for (const char c : name)
    {
      const auto byte = static_cast<unsigned char>(c);
      if (byte < 0x20 || c == ',' || c == ';' || c == '%')
        result += {'%', kDigits[byte >> 4U], kDigits[byte & 15U]};
      else
        result += c;
    }
    return result;
  }

  static std::string plain(const std::string& name)
  {
    const std::string digits = kDigits;
    std::string result;
    for (std::size_t i = 0; i < name.size(); ++i)
    {
      const bool has_two_more = i + 2 < name.size();
      const std::size_t high = has_two_more ? digits.find(name[i + 1]) : std::string::npos;
      const std::size_t low = has_two_more ? digits.find(name[i + 2]) : std::string::npos;
      if (name[i] != '%' || high == std::string::npos || low == std::string::npos)
        result += name[i];
      else
        result += static_cast<char>(high * 16 + low), i += 2;
    }
    return result;
  }

  void readLine(const std::string& line, std::size_t fields)
  {
    if (line.empty() || line.back() != ';') return;
    std::vector<std::string> parts;
    for (std::size_t begin = 0, end = 0; begin < line.size(); begin = end + 1)
    {
      end = std::min(line.find(',', begin), line.size() - 1);
      parts.push_back(line.substr(begin, end - begin));
    }
    if (parts.size() != fields + 1) return;
    lines_[plain(parts.front())] = {parts.begin() + 1, parts.end()};
  }

  std::string path_;
  std::map<std::string, std::vector<std::string>> lines_;  ///< by scan
};
}  // namespace lidar_panoptic_clustering

#pragma once

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <stdexcept>
#include <string>
#include <type_traits>
#include <vector>

namespace lidar_panoptic_clustering
{
/// Reads a file of records in one call, into `records` (resized). Throws std::runtime_error with the file's name when
/// it is missing, unreadable, or its size is no multiple of a record's.
template <class Record>
void readBinaryFile(const std::string& path, std::vector<Record>& records)
{
  static_assert(std::is_trivially_copyable_v<Record>, "records are read as bytes");
  std::error_code error;
  const auto size = std::filesystem::file_size(path, error);
  if (error) throw std::runtime_error("cannot read " + path + ": " + error.message());
  if (size % sizeof(Record) != 0)
    throw std::runtime_error(path + ": expected a multiple of " + std::to_string(sizeof(Record)) + " bytes, found " +
                             std::to_string(size));
  std::FILE* file = std::fopen(path.c_str(), "rb");
  if (file == nullptr) throw std::runtime_error("cannot read " + path + ": " + std::strerror(errno));
  std::setvbuf(file, nullptr, _IONBF, 0);  // straight into the records
  records.resize(size / sizeof(Record));
  const std::size_t read = std::fread(records.data(), sizeof(Record), records.size(), file);
  std::fclose(file);
  if (read != records.size())
    throw std::runtime_error(path + ": expected " + std::to_string(size) + " bytes, could read " +
                             std::to_string(read * sizeof(Record)));
}
}  // namespace lidar_panoptic_clustering

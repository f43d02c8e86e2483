#pragma once

#include "core/input_file.h"

#include <cstdint>
#include <stdexcept>
#include <string>
#include <type_traits>
#include <vector>

namespace lidar_panoptic_clustering
{
/// A scan of this many bytes would have 64 million points.
constexpr std::uint64_t kMaxBinaryFile = std::uint64_t{1} << 30U;

/// Reads a file of records in one call, into `records` (resized). Throws std::runtime_error with the file's name when
/// it is missing, unreadable, no regular file or above 1 GiB, or its size is no multiple of a record's.
template <class Record>
void readBinaryFile(const std::string& path, std::vector<Record>& records)
{
  static_assert(std::is_trivially_copyable_v<Record>, "records are read as bytes");
  InputFile file(path, kMaxBinaryFile);
  if (file.size() % sizeof(Record) != 0)
    throw std::runtime_error(path + ": expected a multiple of " + std::to_string(sizeof(Record)) + " bytes, found " +
                             std::to_string(file.size()));
  records.resize(file.size() / sizeof(Record));
  const std::size_t bytes = file.read(records.data(), file.size());
  if (bytes != file.size())
    throw std::runtime_error(path + ": expected " + std::to_string(file.size()) + " bytes, could read " +
                             std::to_string(bytes));
}
}  // namespace lidar_panoptic_clustering

#pragma once

#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <iostream>
#include <stdexcept>
#include <string>

namespace lidar_panoptic_clustering
{
/// The bytes of one run, taken from the front; behind the end come zeros.
class FuzzInput
{
public:
  FuzzInput(const std::uint8_t* bytes, std::size_t size) : bytes_(bytes), left_(size) {}

  template <class T>
  T take()
  {
    T value{};
    const std::size_t count = std::min(left_, sizeof value);
    if (count > 0) std::memcpy(&value, bytes_, count);
    bytes_ += count, left_ -= count;
    return value;
  }
  std::string takeText(std::size_t most)
  {
    const std::size_t count = std::min(left_, most);
    const std::string text(reinterpret_cast<const char*>(bytes_), count);
    bytes_ += count, left_ -= count;
    return text;
  }
  std::size_t left() const { return left_; }

private:
  const std::uint8_t* bytes_;
  std::size_t left_;
};

/// Runs `work`, which may refuse its input: with a std::invalid_argument or std::runtime_error that says something.
/// Whatever else is thrown ends the program. Returns whether it was refused.
template <class Work>
bool mayRefuse(const Work& work)
{
  const auto check = [](const std::exception& error)
  {
    if (std::string(error.what()).size() < 8) throw std::logic_error("an error that says nothing");
    return true;
  };
  try
  {
    work();
    return false;
  }
  catch (const std::invalid_argument& error)
  {
    return check(error);
  }
  catch (const std::runtime_error& error)
  {
    return check(error);
  }
}

/// Ends the program where something that has to hold does not.
inline void mustHold(bool holds, const char* what)
{
  if (holds) return;
  std::cerr << "does not hold: " << what << std::endl;
  std::abort();
}
}  // namespace lidar_panoptic_clustering

/// One run: each fuzzer defines it, as libFuzzer wants it.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size);

#include "lidar_panoptic_clustering/geometry/step_sort.h"

#include <gtest/gtest.h>

#include <random>
#include <tuple>

namespace lidar_panoptic_clustering
{
namespace
{
struct Entry
{
  float value;
  std::uint32_t number;
  bool operator==(const Entry& other) const { return value == other.value && number == other.number; }
};

std::vector<Entry> randomEntries(std::size_t count, int values)
{
  std::mt19937 random(7);
  std::vector<Entry> entries;
  for (std::size_t k = 0; k < count; ++k)
  {
    const auto value = 0.37F * static_cast<float>(static_cast<int>(random() % values) - values / 2);
    entries.push_back({random() % 5 == 0 ? -value : value, static_cast<std::uint32_t>(random() % 1000)});
  }
  return entries;
}

/// Few are sorted by comparison, many by digits; of either some have the same float, zeros of both signs among them.
TEST(FloatSort, SortsAsComparisonDoes)
{
  FloatSort<Entry> sorter;
  const auto isBefore = [](const Entry& a, const Entry& b) { return a.number < b.number; };
  for (const std::size_t count : {0U, 1U, 2U, 100U, 511U, 512U, 5000U, 700U})
    for (const int values : {1, 2, 40, 1000000})
    {
      std::vector<Entry> entries = randomEntries(count, values), expected = entries;
      std::sort(expected.begin(), expected.end(),
                [](const Entry& a, const Entry& b)
                { return std::tie(a.value, a.number) < std::tie(b.value, b.number); });
      sorter.sort(
          entries, [](const Entry& entry) { return entry.value; }, isBefore);
      EXPECT_EQ(entries, expected) << count << " entries, " << values << " values";
    }
}

TEST(StepSort, KeepsTheOrderOfWhatIsEqual)
{
  StepSort<Entry> sorter;
  for (const int bits : {1, 6, 11, 12, 33})
  {
    std::mt19937_64 random(3);
    std::vector<Entry> entries(3000);
    std::vector<std::uint64_t> keys;
    for (std::uint32_t k = 0; k < entries.size(); ++k)
    {
      entries[k] = {0.0F, k};
      keys.push_back(random() >> 40 << 20 & ((std::uint64_t{1} << bits) - 1));
    }
    std::vector<Entry> expected = entries;
    std::stable_sort(expected.begin(), expected.end(),
                     [&keys](const Entry& a, const Entry& b) { return keys[a.number] < keys[b.number]; });
    sorter.sort(entries, bits, [&keys](const Entry& entry) { return keys[entry.number]; });
    EXPECT_EQ(entries, expected) << bits << " bits";
  }
}
}  // namespace
}  // namespace lidar_panoptic_clustering

#include "lidar_panoptic_clustering/tracking/sparse_assignment.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <vector>

namespace lidar_panoptic_clustering
{
namespace
{
struct Problem
{
  std::size_t columns;
  std::vector<float> alone;                                           ///< by row
  std::vector<std::vector<std::pair<std::uint32_t, float>>> allowed;  ///< by row
};

/// Tries all assignments.
double cheapest(const Problem& problem, std::size_t row, std::vector<bool>& taken)
{
  if (row == problem.alone.size()) return 0.0;
  double best = static_cast<double>(problem.alone[row]) + cheapest(problem, row + 1, taken);
  for (const auto& [column, cost] : problem.allowed[row])
  {
    if (taken[column]) continue;
    taken[column] = true;
    best = std::min(best, static_cast<double>(cost) + cheapest(problem, row + 1, taken));
    taken[column] = false;
  }
  return best;
}

const std::vector<std::uint32_t>& solve(SparseAssignment& assignment, const Problem& problem)
{
  assignment.reset(problem.columns);
  for (std::size_t row = 0; row < problem.alone.size(); ++row)
  {
    assignment.addRow(problem.alone[row]);
    for (const auto& [column, cost] : problem.allowed[row]) assignment.addPair(column, cost);
  }
  return assignment.solve();
}

/// The price of what was found, which must be an assignment of allowed pairs.
double priceOf(const Problem& problem, const std::vector<std::uint32_t>& column_of)
{
  EXPECT_EQ(column_of.size(), problem.alone.size());
  std::vector<bool> taken(problem.columns);
  double price = 0.0;
  for (std::size_t row = 0; row < column_of.size(); ++row)
  {
    if (column_of[row] == SparseAssignment::kNone)
    {
      price += static_cast<double>(problem.alone[row]);
      continue;
    }
    const auto pair = std::find_if(problem.allowed[row].begin(), problem.allowed[row].end(),
                                   [&](const auto& p) { return p.first == column_of[row]; });
    if (pair == problem.allowed[row].end() || taken[column_of[row]])
    {
      ADD_FAILURE() << "row " << row << " has column " << column_of[row];
      return -1.0;
    }
    taken[column_of[row]] = true;
    price += static_cast<double>(pair->second);
  }
  return price;
}

TEST(SparseAssignment, IsAsCheapAsTheBestOfAll)
{
  std::mt19937 random(11);
  SparseAssignment assignment;
  for (int round = 0; round < 2000; ++round)
  {
    Problem problem;
    problem.columns = random() % 7;
    problem.alone.resize(random() % 7);
    problem.allowed.resize(problem.alone.size());
    const bool whole = round % 2 == 0;  // equal costs too
    const auto cost = [&]
    { return whole ? static_cast<float>(random() % 6) : 0.001F * static_cast<float>(random() % 9000); };
    for (std::size_t row = 0; row < problem.alone.size(); ++row)
    {
      problem.alone[row] = cost();
      for (std::uint32_t column = 0; column < problem.columns; ++column)
        if (random() % 2 == 0) problem.allowed[row].push_back({column, cost()});
    }
    std::vector<bool> taken(problem.columns);
    EXPECT_NEAR(priceOf(problem, solve(assignment, problem)), cheapest(problem, 0, taken), 1e-6) << round;
  }
}

TEST(SparseAssignment, ARowGivesItsColumnAwayWhereThatIsCheaper)
{
  SparseAssignment assignment;
  const Problem problem{2, {10, 10}, {{{0, 1.0F}, {1, 2.0F}}, {{0, 1.5F}}}};
  EXPECT_EQ(solve(assignment, problem), (std::vector<std::uint32_t>{1, 0}));
  const Problem alone{1, {3, 10}, {{{0, 1.0F}}, {{0, 1.5F}}}};
  EXPECT_EQ(solve(assignment, alone), (std::vector<std::uint32_t>{SparseAssignment::kNone, 0}));
}

TEST(SparseAssignment, NothingToAssign)
{
  SparseAssignment assignment;
  EXPECT_TRUE(solve(assignment, {0, {}, {}}).empty());
  EXPECT_TRUE(solve(assignment, {5, {}, {}}).empty());
  EXPECT_EQ(solve(assignment, {0, {1.0F}, {{}}}), (std::vector<std::uint32_t>{SparseAssignment::kNone}));
}

TEST(SparseAssignment, NeighboursOnALine)
{
  // each row between two columns: a path of pairs as long as the problem
  constexpr std::uint32_t kRows = 20000;
  SparseAssignment assignment;
  Problem problem{kRows + 1, std::vector<float>(kRows, 100.0F), {}};
  for (std::uint32_t row = 0; row < kRows; ++row) problem.allowed.push_back({{row, 1.0F}, {row + 1, 1.5F}});
  const auto& column_of = solve(assignment, problem);
  for (std::uint32_t row = 0; row < kRows; ++row) ASSERT_EQ(column_of[row], row);
}
}  // namespace
}  // namespace lidar_panoptic_clustering

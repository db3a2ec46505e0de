#include "training/knot_table.h"

#include <algorithm>
#include <cstdlib>
#include <map>
#include <set>

#include "training/knot_invariant.h"

namespace filum {
namespace {

struct Entry {
  Laurent jones;
  std::vector<int> throws;
};

void extend(std::vector<Entry>& table, const Entry& from, int largest_index) {
  static const std::vector<int> kThrows = {7, -7, 5, -5, 3, -3};
  if (from.throws.size() == kMostThrows) return;
  for (int k = largest_index; k < static_cast<int>(kThrows.size()); ++k) {
    Entry next = from;
    next.throws.push_back(kThrows[static_cast<std::size_t>(k)]);
    next.jones = from.jones * jones_torus(next.throws.back());
    table.push_back(next);
    extend(table, next, k);
  }
}

const std::vector<Entry>& table() {
  static const std::vector<Entry> kTable = [] {
    std::vector<Entry> entries;
    extend(entries, {Laurent::monomial(1, 0), {}}, 0);
    return entries;
  }();
  return kTable;
}

std::set<int> crossings_in(const KnotDiagram& diagram, std::size_t begin, std::size_t count) {
  std::set<int> found;
  for (std::size_t k = begin; k < begin + count; ++k) found.insert(diagram.code[k].crossing);
  return found;
}

/// Half-twists of the throw made of these crossings; 0 if their signs differ or their number is not that of a
/// throw.
int throw_of(const KnotDiagram& diagram, const std::set<int>& crossings) {
  const int count = static_cast<int>(crossings.size());
  int sum = 0;
  for (int c : crossings) sum += diagram.sign[static_cast<std::size_t>(c)];
  return std::abs(sum) == count && count % 2 == 1 && count >= 3 ? sum : 0;
}

bool opposite(int a, int b) {
  return (a > 0) != (b > 0);
}

bool alternating(const std::vector<int>& throws) {
  for (std::size_t k = 1; k < throws.size(); ++k) {
    if (!opposite(throws[k - 1], throws[k])) return false;
  }
  return true;
}

std::vector<int> sizes_of(const std::vector<int>& throws) {
  std::vector<int> sizes;
  for (int t : throws) sizes.push_back(std::abs(t));
  return sizes;
}

/// Could the throws, in some order, each be opposite to the one before?
bool can_alternate(const std::vector<int>& throws) {
  const auto right = std::count_if(throws.begin(), throws.end(), [](int t) { return t > 0; });
  const auto left = static_cast<std::ptrdiff_t>(throws.size()) - right;
  return std::abs(right - left) <= 1;
}

}  // namespace

std::vector<int> throws_of(const Laurent& jones) {
  for (const Entry& entry : table()) {
    if (entry.jones == jones) return entry.throws;
  }
  return {};
}

std::vector<int> stacked_throws(const KnotDiagram& diagram) {
  std::vector<int> outside_in;
  std::size_t begin = 0, end = diagram.code.size();
  while (begin < end) {
    std::size_t count = 1;
    for (; 2 * count <= end - begin; ++count) {
      const std::set<int> front = crossings_in(diagram, begin, count);
      if (front.size() == count && front == crossings_in(diagram, end - count, count)) break;
    }
    if (2 * count > end - begin) return {};
    const int half_twists = throw_of(diagram, crossings_in(diagram, begin, count));
    if (half_twists == 0) return {};
    outside_in.push_back(half_twists);
    begin += count;
    end -= count;
  }
  return {outside_in.rbegin(), outside_in.rend()};
}

std::string composition_of(const std::vector<int>& throws) {
  std::string text;
  for (std::size_t k = 0; k < throws.size(); ++k) {
    if (k > 0) text += opposite(throws[k - 1], throws[k]) ? "=" : "x";
    text += std::to_string((std::abs(throws[k]) - 1) / 2);
  }
  return text;
}

std::string class_of(const std::vector<int>& throws, bool ordered) {
  std::vector<int> sizes = sizes_of(throws);
  if (!ordered) std::sort(sizes.rbegin(), sizes.rend());
  const bool alternate = ordered ? alternating(throws) : can_alternate(throws);
  if (sizes.empty()) return "unknot";
  if (sizes == std::vector<int>{3}) return "overhand";
  if (sizes == std::vector<int>{3, 3}) return alternate ? "square" : "granny";
  if (sizes == std::vector<int>{5, 3} && alternate) return "surgeons";
  if (sizes == std::vector<int>{3, 3, 3} && alternate) return "triple";
  return "other";
}

}  // namespace filum

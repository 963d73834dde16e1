#include "slideway/machine/lower_body_array.hpp"

#include <algorithm>
#include <string>

#include "slideway/base/error.hpp"

namespace slideway {
namespace {

// "body 2 on body 3 on body 2", starting at a body that is known to be in a cycle.
std::string cycle_text(const std::vector<int>& lower, int start) {
  std::string text = "body " + std::to_string(start);
  int j = start;
  do {
    j = lower[j];
    text += " on body " + std::to_string(j);
  } while (j != start);
  return text;
}

}  // namespace

LowerBodyArray::LowerBodyArray(std::span<const int> lower) : lower_{0} {
  lower_.insert(lower_.end(), lower.begin(), lower.end());
  for (int j = 1; j <= size(); ++j)
    if (lower_[j] < 0 || lower_[j] > size())
      throw UsageError("machine: body " + std::to_string(j) +
                       " has lower = " + std::to_string(lower_[j]) + "; accepted: 0 (the bed) to " +
                       std::to_string(size()));
  for (int j = 1; j <= size(); ++j) {
    // After size() steps a branch has reached the bed, or walks round a cycle.
    const int end = (*this)(j, size());
    if (end != 0)
      throw UsageError("machine: " + cycle_text(lower_, end) +
                       " is a cycle; every branch must end at body 0 (the bed)");
  }
}

int LowerBodyArray::operator()(int j, int n) const {
  for (; n > 0 && j != 0; --n) j = lower_[j];
  return j;
}

std::vector<int> LowerBodyArray::path(int k) const {
  std::vector<int> bodies;
  for (int j = k; j != 0; j = lower_[j]) bodies.push_back(j);
  std::reverse(bodies.begin(), bodies.end());
  return bodies;
}

}  // namespace slideway

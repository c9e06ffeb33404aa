#include "learn/arx/rows/seen_rows.hpp"

#include <algorithm>
#include <tuple>

namespace wisp {
namespace {

auto order_of(const SeenRows& rows) {
  return std::tuple(rows.hash, rows.copy, rows.first, rows.last, rows.begin, rows.end);
}

bool same_range(const SeenRows& a, const SeenRows& b) {
  return a.hash == b.hash && a.copy == b.copy && a.first == b.first && a.last == b.last;
}

}  // namespace

std::string rows_text(std::uint64_t begin, std::uint64_t end) {
  return std::to_string(begin + 1) + ":" + (end == kToTheEnd ? "end" : std::to_string(end));
}

Result<std::vector<SeenRows>> joined(std::vector<SeenRows> seen, const std::vector<SeenRows>& more) {
  for (const SeenRows& one : more) {
    for (const SeenRows& other : seen) {
      const std::uint64_t begin = std::max(one.begin, other.begin), end = std::min(one.end, other.end);
      if (one.hash != other.hash || one.copy != other.copy || begin >= end) continue;
      return Error{"rows " + rows_text(begin, end) + " of " + one.source +
                   " are in both: the same part twice, or parts of different shares"};
    }
  }
  seen.insert(seen.end(), more.begin(), more.end());
  std::sort(seen.begin(), seen.end(), [](const auto& a, const auto& b) { return order_of(a) < order_of(b); });
  std::vector<SeenRows> out;
  for (const SeenRows& one : seen) {
    if (!out.empty() && same_range(out.back(), one) && out.back().end == one.begin) {
      out.back().end = one.end;
    } else {
      out.push_back(one);
    }
  }
  return out;
}

SeenRows copy_of(SeenRows rows, const std::vector<SeenRows>& seen) {
  while (!joined(seen, {rows})) ++rows.copy;
  return rows;
}

Result<void> check_complete(const std::vector<SeenRows>& seen) {
  for (std::size_t k = 0; k < seen.size();) {
    const SeenRows& group = seen[k];
    std::uint64_t reached = group.first;
    for (; k < seen.size() && same_range(seen[k], group) && seen[k].begin <= reached; ++k) {
      reached = std::max(reached, seen[k].end);
    }
    const bool gap = k < seen.size() && same_range(seen[k], group);
    const std::uint64_t next = gap ? seen[k].begin : group.last;
    if (reached == next) continue;
    return Error{"rows " + rows_text(reached, next) + " of " + group.source +
                 " are in no part: merge the part that is missing"};
  }
  return {};
}

}  // namespace wisp

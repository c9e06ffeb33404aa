#pragma once
// What two banks are compared by.

#include <cstddef>
#include <cstring>
#include <vector>

#include "wisp/run/bank.hpp"

namespace wisp {

inline std::vector<std::byte> saved(const Bank& bank) {
  std::vector<std::byte> bytes(bank.save_bytes());
  bank.save(bytes);
  return bytes;
}

inline bool same_bits(const std::vector<float>& a, const std::vector<float>& b) {
  return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(float)) == 0;
}

}  // namespace wisp

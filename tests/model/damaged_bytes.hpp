#pragma once
// Damage to a model's file that reading must notice.

#include <gtest/gtest.h>

#include <cstddef>
#include <span>
#include <vector>

#include "wisp/model/file.hpp"

namespace wisp {

/// Expects that no file that was cut short, and none with a single bit flipped, is read.
inline void expect_damage_noticed(std::vector<std::byte> bytes) {
  for (std::size_t size = 0; size < bytes.size(); ++size) {
    ASSERT_FALSE(parse_model(std::span(bytes).first(size), "cut.wisp")) << size;
  }
  for (std::size_t bit = 0; bit < 8 * bytes.size(); ++bit) {
    bytes[bit / 8] ^= std::byte{1} << (bit % 8);
    ASSERT_FALSE(parse_model(bytes, "flipped.wisp")) << bit;
    bytes[bit / 8] ^= std::byte{1} << (bit % 8);
  }
}

}  // namespace wisp

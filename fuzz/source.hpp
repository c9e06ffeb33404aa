#pragma once
// Takes numbers from the front of a fuzzer's input.

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>

namespace wisp::fuzz {

/// After the last byte, numbers are 0.
class Source {
 public:
  Source(const std::uint8_t* data, std::size_t size) : data_(data), size_(size) {}

  bool empty() const { return size_ == 0; }

  template <class Number>
  Number take() {
    Number number{};
    const std::size_t count = size_ < sizeof number ? size_ : sizeof number;
    if (count > 0) std::memcpy(&number, data_, count);
    data_ += count;
    size_ -= count;
    return number;
  }

  std::span<const std::uint8_t> rest() const { return {data_, size_}; }

 private:
  const std::uint8_t* data_;
  std::size_t size_;
};

}  // namespace wisp::fuzz

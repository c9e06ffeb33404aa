#pragma once
// Bytes one after the other, as they are stored or as zlib unpacks them.

#include <zlib.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstring>
#include <memory>
#include <span>

namespace wisp::matfile {

class ByteSource {
 public:
  explicit ByteSource(std::span<const std::byte> stored) : stored_(stored) {}

  /// Unpacks `packed`. It gives nothing where that is no zlib stream.
  static ByteSource unpacking(std::span<const std::byte> packed) {
    ByteSource source(packed);
    source.packed_.reset(new z_stream{});
    if (inflateInit(source.packed_.get()) != Z_OK) source = ByteSource(std::span<const std::byte>());
    return source;
  }

  /// The next bytes. Returns false where there are fewer.
  bool read(std::span<std::byte> out) {
    passed_ += out.size();
    if (packed_) return unpack(out);
    if (out.size() > stored_.size()) return false;
    if (!out.empty()) std::memcpy(out.data(), stored_.data(), out.size());
    stored_ = stored_.subspan(out.size());
    return true;
  }

  /// Passes over the next bytes, without memory for them.
  bool skip(std::size_t count) {
    passed_ += count;
    if (!packed_) {
      if (count > stored_.size()) return false;
      stored_ = stored_.subspan(count);
      return true;
    }
    std::array<std::byte, 4096> passed;
    for (; count > 0; count -= std::min(count, passed.size())) {
      if (!unpack(std::span(passed).first(std::min(count, passed.size())))) return false;
    }
    return true;
  }

  /// How many bytes were requested so far.
  std::size_t passed() const { return passed_; }

 private:
  struct End {
    void operator()(z_stream* stream) const {
      inflateEnd(stream);
      delete stream;
    }
  };

  bool unpack(std::span<std::byte> out) {
    constexpr std::size_t kMax = std::size_t{1} << 30;  // what zlib's counters hold
    packed_->next_out = reinterpret_cast<Bytef*>(out.data());
    packed_->avail_out = static_cast<uInt>(out.size());
    while (packed_->avail_out > 0) {
      const std::size_t given = std::min(stored_.size(), kMax);
      packed_->next_in = reinterpret_cast<Bytef*>(const_cast<std::byte*>(stored_.data()));
      packed_->avail_in = static_cast<uInt>(given);
      const int code = inflate(packed_.get(), Z_NO_FLUSH);
      stored_ = stored_.subspan(given - packed_->avail_in);
      if (code == Z_STREAM_END && packed_->avail_out == 0) return true;
      if (code != Z_OK) return false;
    }
    return true;
  }

  std::span<const std::byte> stored_;
  std::size_t passed_ = 0;
  std::unique_ptr<z_stream, End> packed_;
};

}  // namespace wisp::matfile

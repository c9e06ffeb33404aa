// MAT-file format, The MathWorks, "MAT-File Level 5 File Format". A file is a sequence of elements: a tag (type and
// length) and data, padded to eight bytes. An array is an element that contains elements: flags, dimensions, name, then
// numbers or fields. Each variable is read in one pass from front to back, so that false sizes allocate nothing.

#include "matfile/level5.hpp"

#include <zlib.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <cstring>
#include <memory>
#include <optional>

namespace wisp::matfile {
namespace {

constexpr std::size_t kHeader = 128;
constexpr std::uint32_t kMatrix = 14, kCompressed = 15;
constexpr unsigned kStruct = 2, kFirstNumeric = 6, kLastNumeric = 15;
constexpr unsigned kComplex = 0x08;
constexpr std::size_t kMaxDimensions = 32, kMaxFields = 4096, kMaxName = 256;
constexpr std::size_t kMaxNames = 10'000;  // listing stops there: packed structures could hold millions of names
constexpr int kDeepest = 16;               // largest nesting depth of structures

// Bytes of a stored number, by the element types 1 to 13.
constexpr std::size_t kWidth[] = {0, 1, 1, 2, 2, 4, 4, 4, 0, 8, 0, 0, 8, 8};
constexpr std::uint32_t kSingle = 7, kDouble = 9;

bool is_signed(std::uint32_t kind) { return kind == 1 || kind == 3 || kind == 5 || kind == 12; }

std::uint64_t whole(const std::byte* at, std::size_t width, bool big) {
  std::uint64_t value = 0;
  for (std::size_t k = 0; k < width; ++k) {
    value = value << 8 | std::to_integer<std::uint64_t>(at[big ? k : width - 1 - k]);
  }
  return value;
}

double number(const std::byte* at, std::uint32_t kind, bool big) {
  const std::uint64_t bits = whole(at, kWidth[kind], big);
  if (kind == kDouble) return std::bit_cast<double>(bits);
  if (kind == kSingle) return static_cast<double>(std::bit_cast<float>(static_cast<std::uint32_t>(bits)));
  if (!is_signed(kind)) return static_cast<double>(bits);
  const int unused = 64 - 8 * static_cast<int>(kWidth[kind]);
  return static_cast<double>(static_cast<std::int64_t>(bits << unused) >> unused);
}

// Stream of bytes, as stored or as unpacked by zlib.
class ByteSource {
 public:
  explicit ByteSource(std::span<const std::byte> stored) : stored_(stored) {}

  /// Returns a source of the unpacked bytes; read() fails if `packed` is no zlib stream.
  static ByteSource unpacking(std::span<const std::byte> packed) {
    ByteSource source(packed);
    source.packed_.reset(new z_stream{});
    if (inflateInit(source.packed_.get()) != Z_OK) source = ByteSource(std::span<const std::byte>());
    return source;
  }

  /// Reads the next bytes. Returns false if there are fewer.
  bool read(std::span<std::byte> out) {
    passed_ += out.size();
    if (packed_) return unpack(out);
    if (out.size() > stored_.size()) return false;
    if (!out.empty()) std::memcpy(out.data(), stored_.data(), out.size());
    stored_ = stored_.subspan(out.size());
    return true;
  }

  /// Skips the next bytes, without memory for them. Returns false if there are fewer.
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

  /// Returns the number of bytes requested so far.
  std::size_t passed() const { return passed_; }

 private:
  struct End {
    void operator()(z_stream* stream) const {
      inflateEnd(stream);
      delete stream;
    }
  };

  bool unpack(std::span<std::byte> out) {
    constexpr std::size_t kMax = std::size_t{1} << 30;  // keeps below the limit of zlib's 32-bit counters
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

struct Tag {
  std::uint32_t kind = 0;
  std::size_t bytes = 0;
  std::size_t padding = 0;  // padding after the data
};

// Header of an array, before its numbers or fields.
struct Head {
  unsigned type = 0;
  bool complex = false;
  std::vector<std::size_t> dims;
  std::string name;

  bool flat() const { return dims.size() == 2; }
  bool numeric() const { return type >= kFirstNumeric && type <= kLastNumeric && flat() && !complex; }
  bool single_struct() const { return type == kStruct && flat() && dims[0] == 1 && dims[1] == 1; }
};

class Reader {
 public:
  Reader(ByteSource source, bool big) : source_(std::move(source)), big_(big) {}

  std::optional<Tag> tag() {
    std::array<std::byte, 8> bytes;
    if (!source_.read(bytes)) return {};
    const auto first = static_cast<std::uint32_t>(whole(bytes.data(), 4, big_));
    // Data of up to four bytes may be in the tag itself.
    if (first >> 16 != 0) {
      small_ = {bytes[4], bytes[5], bytes[6], bytes[7]};
      in_tag_ = true;
      if (first >> 16 > 4) return {};
      return Tag{first & 0xffff, first >> 16, 0};
    }
    in_tag_ = false;
    const auto length = static_cast<std::size_t>(whole(bytes.data() + 4, 4, big_));
    return Tag{first, length, (8 - length % 8) % 8};
  }

  // Reads data of the element whose tag was read last.
  bool take(std::span<std::byte> out) {
    if (!in_tag_) return source_.read(out);
    std::copy_n(small_.begin(), out.size(), out.begin());
    return true;
  }

  // Enters the next array, calls `look`, and skips what it has not read. Returns whether all succeeded.
  template <class Look>
  bool within_part(Look look) {
    const auto part = tag();
    if (!part || part->kind != kMatrix || in_tag_) return false;
    const std::size_t begin = source_.passed(), all = part->bytes + part->padding;
    if (part->bytes > 0 && !look()) return false;
    const std::size_t used = source_.passed() - begin;
    return used <= all && source_.skip(all - used);
  }

  // Reads a short element completely.
  std::optional<std::vector<std::byte>> part(std::uint32_t kind, std::size_t most) {
    const auto found = tag();
    if (!found || found->kind != kind || found->bytes > most) return {};
    std::vector<std::byte> data(found->bytes);
    if (!take(data) || (!in_tag_ && !source_.skip(found->padding))) return {};
    return data;
  }

  std::optional<Head> head() {
    const auto flags = part(6, 8), dims = part(5, 4 * kMaxDimensions), name = part(1, kMaxName);
    if (!flags || flags->size() != 8 || !dims || dims->size() % 4 != 0 || !name) return {};
    const auto word = static_cast<unsigned>(whole(flags->data(), 4, big_));
    Head head{word & 0xff, (word >> 8 & kComplex) != 0, {}, {}};
    for (std::size_t at = 0; at < dims->size(); at += 4) {
      const auto size = static_cast<std::int32_t>(whole(dims->data() + at, 4, big_));
      if (size < 0) return {};
      head.dims.push_back(static_cast<std::size_t>(size));
    }
    for (std::byte letter : *name) head.name += static_cast<char>(letter);
    return head;
  }

  // Reads the names of a structure's fields, of equal width and terminated by zeros.
  std::optional<std::vector<std::string>> fields() {
    const auto width = part(5, 4);
    if (!width || width->size() != 4) return {};
    const auto size = static_cast<std::size_t>(whole(width->data(), 4, big_));
    if (size < 1 || size > kMaxName) return {};
    const auto letters = part(1, size * kMaxFields);
    if (!letters || letters->size() % size != 0) return {};
    std::vector<std::string> names;
    for (std::size_t at = 0; at < letters->size(); at += size) {
      const char* text = reinterpret_cast<const char*>(letters->data() + at);
      names.emplace_back(text, strnlen(text, size));
    }
    return names;
  }

  Found numbers(const Head& head, std::size_t max_numbers) {
    const auto found = tag();
    if (!found || found->kind >= std::size(kWidth) || kWidth[found->kind] == 0) return Miss::kDamaged;
    const std::size_t width = kWidth[found->kind], count = found->bytes / width;
    if (head.dims[0] == 0 || head.dims[1] == 0) return Miss::kNotNumbers;
    if (head.dims[1] > max_numbers / head.dims[0]) return Miss::kTooLarge;
    if (found->bytes % width != 0 || count != head.dims[0] * head.dims[1]) return Miss::kDamaged;
    Table table{head.dims[0], head.dims[1], {}};
    std::array<std::byte, 8192> block;
    for (std::size_t left = found->bytes; left > 0;) {
      const auto taken = std::span(block).first(std::min(left, block.size()));
      if (!take(taken)) return Miss::kDamaged;
      for (std::size_t at = 0; at < taken.size(); at += width) {
        table.numbers.push_back(number(&taken[at], found->kind, big_));
      }
      left -= taken.size();
    }
    return table;
  }

 private:
  ByteSource source_;
  bool big_;
  std::array<std::byte, 4> small_{};
  bool in_tag_ = false;
};

bool is_big(std::span<const std::byte> file) { return file[126] == std::byte{'M'} && file[127] == std::byte{'I'}; }

// Calls visit(reader) at the head of every variable, until it returns false.
template <class Visit>
void for_each_variable(std::span<const std::byte> file, Visit visit) {
  const bool big = is_big(file);
  for (auto rest = file.subspan(kHeader); rest.size() >= 8;) {
    const auto kind = static_cast<std::uint32_t>(whole(rest.data(), 4, big));
    const auto bytes = std::min(static_cast<std::size_t>(whole(rest.data() + 4, 4, big)), rest.size() - 8);
    const auto data = rest.subspan(8, bytes);
    rest = rest.subspan(8 + bytes);
    Reader reader(kind == kCompressed ? ByteSource::unpacking(data) : ByteSource(data), big);
    if (kind == kCompressed) {
      const auto inner = reader.tag();
      if (!inner || inner->kind != kMatrix) continue;
    } else if (kind != kMatrix) {
      continue;
    }
    if (!visit(reader)) return;
  }
}

// Lists an array, whose head was read, if it is numeric; of a structure, its numeric fields. False: data is damaged.
bool list(Reader& reader, const Head& head, const std::string& name, int depth, std::vector<Name>& names) {
  if (head.numeric()) names.push_back({name, head.dims[0], head.dims[1]});
  if (!head.single_struct() || depth == kDeepest || names.size() >= kMaxNames) return true;
  const auto fields = reader.fields();
  if (!fields) return false;
  for (const std::string& field : *fields) {
    const bool whole = reader.within_part([&] {
      const auto inner = reader.head();
      return !inner || list(reader, *inner, name + "." + field, depth + 1, names);
    });
    if (!whole) return false;
  }
  return true;
}

// Reads the numbers that `path` names, in an array whose head was read. The first `at` names are already resolved.
Found find(Reader& reader, const Head& head, const Path& path, std::size_t at, std::size_t max_numbers) {
  if (at == path.size()) return head.numeric() ? reader.numbers(head, max_numbers) : Miss::kNotNumbers;
  if (!head.single_struct()) return Miss::kNoField;
  const auto fields = reader.fields();
  if (!fields) return Miss::kDamaged;
  const auto wanted = std::find(fields->begin(), fields->end(), path[at]);
  if (wanted == fields->end()) return Miss::kNoField;
  for (auto field = fields->begin(); field != wanted; ++field) {
    if (!reader.within_part([] { return true; })) return Miss::kDamaged;
  }
  const auto part = reader.tag();
  if (!part || part->kind != kMatrix) return Miss::kDamaged;
  if (part->bytes == 0) return Miss::kNotNumbers;
  const auto inner = reader.head();
  return inner ? find(reader, *inner, path, at + 1, max_numbers) : Miss::kDamaged;
}

}  // namespace

bool is_level5(std::span<const std::byte> file) {
  if (file.size() < kHeader) return false;
  const bool little = file[126] == std::byte{'I'} && file[127] == std::byte{'M'};
  return (little || is_big(file)) && whole(&file[124], 2, is_big(file)) == 0x0100;
}

bool is_whole_level5(std::span<const std::byte> file) {
  std::size_t at = kHeader;
  while (at + 8 <= file.size()) at += 8 + static_cast<std::size_t>(whole(&file[at + 4], 4, is_big(file)));
  return at == file.size();
}

std::vector<Name> names_in_level5(std::span<const std::byte> file) {
  std::vector<Name> names;
  for_each_variable(file, [&](Reader& reader) {
    if (const auto head = reader.head()) list(reader, *head, head->name, 0, names);
    return names.size() < kMaxNames;
  });
  return names;
}

Found read_level5(std::span<const std::byte> file, const Path& path, std::size_t max_numbers) {
  Found found = Miss::kNoVariable;
  for_each_variable(file, [&](Reader& reader) {
    const auto head = reader.head();
    if (!head || head->name != path.front()) return true;
    found = find(reader, *head, path, 1, max_numbers);
    return false;
  });
  return found;
}

}  // namespace wisp::matfile

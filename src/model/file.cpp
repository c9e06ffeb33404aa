// The model file: its header and hash; payload.hpp has the FlatBuffer, check() the check of the content.

#include "wisp/model/file.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <string>

#include "base/hash.hpp"
#include "base/path_text.hpp"
#include "model/payload.hpp"
#include "wisp/base/file.hpp"

namespace wisp {
namespace {

constexpr std::array<char, 8> kMagic = {'\x89', 'W', 'I', 'S', 'P', '\r', '\n', '\x1a'};
constexpr std::size_t kHeaderSize = 32;
constexpr std::size_t kMaxPayload = std::size_t{1} << 30;

// Header, little-endian: 8 bytes magic, 4 format version, 4 zero, 8 payload size, 8 hash of the payload.
struct Header {
  std::uint32_t version = 0;
  std::uint32_t reserved = 0;
  std::uint64_t size = 0;
  std::uint64_t hash = 0;
};

template <class T>
void put(std::byte* at, T value) {
  for (std::size_t k = 0; k < sizeof(T); ++k) at[k] = static_cast<std::byte>((value >> (8 * k)) & 0xff);
}

template <class T>
T get(const std::byte* at) {
  T value = 0;
  for (std::size_t k = 0; k < sizeof(T); ++k) value |= static_cast<T>(std::to_integer<T>(at[k]) << (8 * k));
  return value;
}

std::string hex(std::uint64_t value) {
  char text[19];
  std::snprintf(text, sizeof text, "0x%016llx", static_cast<unsigned long long>(value));
  return text;
}

Error bad(std::string_view name, const std::string& what) { return {std::string(name) + ": " + what}; }

Result<Header> parse_header(std::span<const std::byte> bytes, std::string_view name) {
  if (bytes.empty()) return bad(name, "is empty, expected a .wisp model");
  const std::size_t compared = std::min(bytes.size(), kMagic.size());
  if (std::memcmp(bytes.data(), kMagic.data(), compared) != 0) {
    return bad(name, "is not a .wisp model: its first bytes are not a model's signature");
  }
  if (bytes.size() < kHeaderSize) {
    return bad(name, "is cut short: " + std::to_string(bytes.size()) + " bytes, expected a header of 32");
  }
  Header header{get<std::uint32_t>(&bytes[8]), get<std::uint32_t>(&bytes[12]), get<std::uint64_t>(&bytes[16]),
                get<std::uint64_t>(&bytes[24])};
  if (header.version == 0 || header.version > kModelFormatVersion) {
    return bad(name, "has format version " + std::to_string(header.version) + ", this program reads 1 to " +
                         std::to_string(kModelFormatVersion) + "; update Wisp, or learn the model again");
  }
  if (header.reserved != 0) return bad(name, "is damaged: reserved header bytes are not zero; learn or fetch it again");
  return header;
}

Result<void> check_payload(const Header& header, std::span<const std::byte> payload, std::string_view name) {
  if (header.size != payload.size()) {
    return bad(name, "holds " + std::to_string(payload.size()) + " bytes after the header, which promises " +
                         std::to_string(header.size) + "; it was cut or damaged; learn or fetch it again");
  }
  const std::uint64_t found = hash_bytes(payload);
  if (found != header.hash) {
    return bad(name, "is damaged: its contents hash to " + hex(found) + ", the header says " + hex(header.hash) +
                         "; learn or fetch it again");
  }
  return {};
}

}  // namespace

Result<std::vector<std::byte>> model_bytes(const Model& model) {
  if (auto ok = check(model); !ok) return Error{"the model cannot be written: " + ok.error().message};
  const std::vector<std::byte> payload = write_payload(model);
  std::vector<std::byte> bytes(kHeaderSize + payload.size());
  std::memcpy(bytes.data(), kMagic.data(), kMagic.size());
  put<std::uint32_t>(&bytes[8], kModelFormatVersion);
  put<std::uint32_t>(&bytes[12], 0);
  put<std::uint64_t>(&bytes[16], payload.size());
  put<std::uint64_t>(&bytes[24], hash_bytes(payload));
  std::copy(payload.begin(), payload.end(), bytes.begin() + kHeaderSize);
  return bytes;
}

Result<Model> parse_model(std::span<const std::byte> bytes, std::string_view name) {
  const auto header = parse_header(bytes, name);
  if (!header) return header.error();
  const auto payload = bytes.subspan(kHeaderSize);
  if (auto ok = check_payload(*header, payload, name); !ok) return ok.error();
  auto model = read_payload(payload);
  if (!model) return bad(name, model.error().message);
  if (auto ok = check(*model); !ok) return bad(name, ok.error().message);
  return model;
}

Result<Model> read_model(const std::filesystem::path& path) {
  const auto bytes = read_file(path, kHeaderSize + kMaxPayload);
  if (!bytes) return bytes.error();
  return parse_model(*bytes, path_text(path));
}

Result<void> write_model(const std::filesystem::path& path, const Model& model) {
  const auto bytes = model_bytes(model);
  if (!bytes) return bytes.error();
  return write_file(path, *bytes);
}

}  // namespace wisp

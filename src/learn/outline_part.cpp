#include <algorithm>
#include <filesystem>
#include <sstream>
#include <tuple>

#include "base/hash.hpp"
#include "wisp/learn/parts.hpp"

// A part as bytes is text, by which a damaged one can be looked at:
//
//     wisp-outline-part 1
//     share LIST INDEX COUNT         one a job
//     recording BYTES NAME           one a recording, followed by its CSV and an end of line
//     hash HASH                      of all bytes before this line

namespace wisp {
namespace {

constexpr std::string_view kFirstLine = "wisp-outline-part 1\n";
constexpr std::size_t kMaxShares = 1'000'000;
constexpr std::string_view kAnyVersion = "wisp-outline-part ";

std::uint64_t hash_of(std::string_view text) { return hash_bytes(std::as_bytes(std::span(text.data(), text.size()))); }

// Whatever the folder is called on the machine of one job.
std::uint64_t hash_of_names(const std::vector<std::string>& names) {
  std::string all;
  for (const std::string& name : names) all += std::filesystem::path(name).filename().string() + "\n";
  return hash_of(all);
}

std::string hash_line(std::string_view before) {
  std::ostringstream line;
  line << "hash " << std::hex << hash_of(before) << "\n";
  return line.str();
}

std::string share_text(std::size_t index, std::size_t count) {
  return std::to_string(index + 1) + "/" + std::to_string(count);
}

// What is before the line of the hash. Errors: another one than it says.
Result<std::string_view> body_of(std::string_view text) {
  if (!text.starts_with(kAnyVersion)) {
    return Error{"is not a part of an outline's fit, expected a file that --partial wrote"};
  }
  if (!text.starts_with(kFirstLine)) {
    return Error{"is a part of another version, found \"" + std::string(text.substr(0, text.find('\n'))) +
                 "\", expected 1: write it again with this program"};
  }
  const std::size_t end = text.size() < 2 ? 0 : text.rfind('\n', text.size() - 2) + 1;
  const std::string_view body = text.substr(0, end);
  if (text.substr(end) != hash_line(body)) return Error{"is cut short or was changed: write the part again"};
  return body.substr(kFirstLine.size());
}

std::string line_of(std::string_view& text) {
  const std::size_t end = std::min(text.find('\n'), text.size());
  std::string line(text.substr(0, end));
  text.remove_prefix(std::min(end + 1, text.size()));
  return line;
}

}  // namespace

std::vector<std::string> ListShare::own() const {
  const auto first = [&](std::size_t k) {
    return names.begin() + static_cast<std::ptrdiff_t>(names.size() * k / count);
  };
  return {first(index), first(index + 1)};
}

Result<void> OutlinePart::add(const Share& share) {
  for (const Share& one : shares_) {
    if (one.list != share.list) continue;
    if (one.count != share.count) {
      return Error{"of one list of recordings share " + share_text(share.index, share.count) + " and share " +
                   share_text(one.index, one.count) + " overlap: expected shares of one count"};
    }
    if (one.index == share.index) return Error{"share " + share_text(share.index, share.count) + " is in both"};
  }
  shares_.push_back(share);
  return {};
}

Result<void> OutlinePart::add(const Table& table) {
  for (const Table& one : tables_) {
    if (one.text != table.text) continue;
    return Error{table.source + " and " + one.source + " are the same recording, which counts once: leave one out"};
  }
  const auto after = std::upper_bound(tables_.begin(), tables_.end(), table, [](const Table& a, const Table& b) {
    return std::tie(a.source, a.text) < std::tie(b.source, b.text);
  });
  tables_.insert(after, table);
  return {};
}

Result<OutlinePart> OutlinePart::create(const std::vector<Recording>& recordings, const ListShare& share) {
  OutlinePart part;
  if (auto ok = part.add(Share{hash_of_names(share.names), share.index, share.count}); !ok) return ok.error();
  for (const Recording& recording : recordings) {
    if (auto ok = check(recording); !ok) return ok.error();
    if (auto ok = part.add(Table{recording.source, csv_text(recording)}); !ok) return ok.error();
  }
  return part;
}

Result<void> OutlinePart::merge(const OutlinePart& other) {
  OutlinePart whole = *this;
  for (const Share& share : other.shares_) {
    if (auto ok = whole.add(share); !ok) return ok;
  }
  for (const Table& table : other.tables_) {
    if (auto ok = whole.add(table); !ok) return ok;
  }
  *this = std::move(whole);
  return {};
}

Result<std::vector<Recording>> OutlinePart::recordings() const {
  for (const Share& share : shares_) {
    std::vector<bool> there(share.count);
    for (const Share& one : shares_) {
      if (one.list == share.list) there[one.index] = true;
    }
    const auto missing = std::find(there.begin(), there.end(), false);
    if (missing == there.end()) continue;
    return Error{"share " + share_text(static_cast<std::size_t>(missing - there.begin()), share.count) +
                 " of the recordings is in no part: merge the one that is missing"};
  }
  std::vector<Recording> recordings;
  for (const Table& table : tables_) {
    std::istringstream stream(table.text);
    auto recording = read_csv(stream, table.source);
    if (!recording) return recording.error();
    recordings.push_back(*std::move(recording));
  }
  return recordings;
}

std::vector<std::byte> OutlinePart::bytes() const {
  std::ostringstream out;
  out << kFirstLine;
  for (const Share& share : shares_) out << "share " << share.list << ' ' << share.index << ' ' << share.count << '\n';
  for (const Table& table : tables_) {
    out << "recording " << table.text.size() << ' ' << table.source << '\n' << table.text << '\n';
  }
  const std::string body = out.str(), whole = body + hash_line(body);
  const auto bytes = std::as_bytes(std::span(whole.data(), whole.size()));
  return {bytes.begin(), bytes.end()};
}

Result<OutlinePart> OutlinePart::from_bytes(std::span<const std::byte> bytes) {
  const auto body = body_of({reinterpret_cast<const char*>(bytes.data()), bytes.size()});
  if (!body) return body.error();
  OutlinePart part;
  for (std::string_view rest = *body; !rest.empty();) {
    std::istringstream line(line_of(rest));
    std::string word;
    line >> word;
    Share share;
    Table table;
    std::size_t size = 0;
    Result<void> taken = Error{"has a line that begins with \"" + word + "\", expected share or recording"};
    if (word == "share" && line >> share.list >> share.index >> share.count && share.index < share.count &&
        share.count <= kMaxShares) {
      taken = part.add(share);
    } else if (word == "recording" && line >> size && line.get() == ' ' && std::getline(line, table.source) &&
               size < rest.size()) {
      table.text = rest.substr(0, size);
      rest.remove_prefix(size + 1);
      taken = part.add(table);
    }
    if (!taken) return taken.error();
  }
  return part;
}

}  // namespace wisp

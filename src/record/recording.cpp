#include "wisp/record/recording.hpp"

#include <algorithm>
#include <cmath>
#include <set>

#include "record/number_text.hpp"

namespace wisp {
namespace {

template <class Value>
std::vector<Value> part(const std::vector<Value>& all, std::size_t first, std::size_t last) {
  return {all.begin() + static_cast<std::ptrdiff_t>(first), all.begin() + static_cast<std::ptrdiff_t>(last)};
}

Result<void> check_channel(const Channel& channel, std::size_t rows) {
  if (channel.name.empty()) return Error{"a channel has no name"};
  if (channel.samples.size() != rows) {
    return Error{"channel " + channel.name + " has " + std::to_string(channel.samples.size()) +
                 " samples, the first has " + std::to_string(rows)};
  }
  const auto infinite =
      std::find_if(channel.samples.begin(), channel.samples.end(), [](double x) { return std::isinf(x); });
  if (infinite == channel.samples.end()) return {};
  return Error{"channel " + channel.name + " is infinite at sample " +
               std::to_string(infinite - channel.samples.begin() + 1)};
}

}  // namespace

std::vector<Episode> episodes(const Recording& recording) {
  const std::size_t rows = recording.rows();
  if (rows == 0) return {};
  if (recording.episode_ids.empty()) return {{0, rows}};
  std::vector<Episode> found;
  std::size_t begin = 0;
  for (std::size_t row = 1; row <= rows; ++row) {
    if (row < rows && recording.episode_ids[row] == recording.episode_ids[begin]) continue;
    found.push_back({begin, row});
    begin = row;
  }
  return found;
}

std::vector<std::size_t> channels_with_role(const Recording& recording, Role role) {
  std::vector<std::size_t> found;
  for (std::size_t k = 0; k < recording.channels.size(); ++k) {
    if (recording.channels[k].role == role) found.push_back(k);
  }
  return found;
}

std::optional<std::size_t> find_channel(const Recording& recording, std::string_view name) {
  for (std::size_t k = 0; k < recording.channels.size(); ++k) {
    if (recording.channels[k].name == name) return k;
  }
  return std::nullopt;
}

std::vector<double> seconds_of(const Recording& recording) {
  std::vector<double> seconds(recording.rows());
  for (std::size_t row = 0; row < seconds.size(); ++row) {
    seconds[row] = static_cast<double>(recording.first_row + row) / recording.rate_hz;
  }
  return seconds;
}

Recording slice(const Recording& recording, std::size_t first, std::size_t last) {
  Recording out{.source = recording.source,
                .rate_hz = recording.rate_hz,
                .attributes = recording.attributes,
                .first_row = recording.first_row + first,
                .rate_note = recording.rate_note};
  for (const Channel& channel : recording.channels) {
    out.channels.push_back({channel.name, channel.unit, channel.role, part(channel.samples, first, last)});
  }
  for (const RowFlag& flag : recording.flags) out.flags.push_back({flag.name, part(flag.rows, first, last)});
  if (!recording.episode_ids.empty()) out.episode_ids = part(recording.episode_ids, first, last);
  return out;
}

bool is_flagged(const Recording& recording, std::string_view flag, std::size_t row) {
  return std::any_of(recording.flags.begin(), recording.flags.end(), [&](const RowFlag& one) {
    return one.name == flag && row < one.rows.size() && one.rows[row] != 0;
  });
}

Result<void> check(const Recording& recording) {
  if (!(std::isfinite(recording.rate_hz) && recording.rate_hz > 0)) {
    return Error{"the rate is " + std::to_string(recording.rate_hz) + " Hz, expected above 0"};
  }
  const std::size_t rows = recording.rows();
  std::set<std::string> names;
  for (const Channel& channel : recording.channels) {
    if (auto ok = check_channel(channel, rows); !ok) return ok;
    if (!names.insert(channel.name).second) return Error{"two channels are named " + channel.name};
  }
  for (const RowFlag& flag : recording.flags) {
    if (flag.rows.size() != rows) return Error{"flag " + flag.name + " has not one mark a row"};
  }
  if (!recording.episode_ids.empty() && recording.episode_ids.size() != rows) {
    return Error{"the episode numbers are not one a row"};
  }
  return {};
}

std::optional<std::string_view> find_attribute(const Recording& recording, std::string_view name) {
  for (const Attribute& attribute : recording.attributes) {
    if (attribute.name == name) return attribute.value;
  }
  return std::nullopt;
}

Result<std::optional<std::vector<double>>> numbers_attribute(const Recording& recording, std::string_view name) {
  const auto text = find_attribute(recording, name);
  if (!text) return std::optional<std::vector<double>>();
  std::vector<double> values;
  const char* at = text->data();
  const char* const end = at + text->size();
  while (at != end) {
    if (*at == ' ' || *at == '\t') {
      ++at;
      continue;
    }
    double value = 0;
    const auto [next, code] = read_number(at, end, value);
    const bool whole = next == end || *next == ' ' || *next == '\t';
    if (code != std::errc() || !whole || !std::isfinite(value)) {
      return Error{recording.source + ": \"# " + std::string(name) + "\" holds \"" +
                   std::string(at, std::find(at, end, ' ')) + "\", expected numbers separated by blanks"};
    }
    values.push_back(value);
    at = next;
  }
  return std::optional(std::move(values));
}

void set_numbers_attribute(Recording& recording, std::string_view name, std::span<const double> values) {
  std::string text;
  for (double value : values) text += (text.empty() ? "" : " ") + number_text(value);
  auto& all = recording.attributes;
  auto at = std::find_if(all.begin(), all.end(), [&](const Attribute& one) { return one.name == name; });
  if (at == all.end()) at = all.insert(at, Attribute{std::string(name), ""});
  at->value = std::move(text);
}

}  // namespace wisp

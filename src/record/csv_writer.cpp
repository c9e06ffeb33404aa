#include <cmath>

#include "base/path_text.hpp"
#include "record/csv_cells.hpp"
#include "record/number_text.hpp"
#include "wisp/base/file.hpp"
#include "wisp/record/csv.hpp"

namespace wisp {
namespace {

std::string_view role_letter(Role role) { return role == Role::kInput ? "u" : role == Role::kOutput ? "y" : "m"; }

// A table of a single column has an episode column too: without it a missing sample would be a blank line.
bool writes_episodes(const Recording& recording) {
  return !recording.episode_ids.empty() || recording.channels.size() + recording.flags.size() == 1;
}

void append_head(std::string& text, const Recording& recording) {
  text += "# wisp-recording 1\n# rate_hz ";
  text += number_text(recording.rate_hz) + "\n";
  for (const Attribute& attribute : recording.attributes) text += "# " + attribute.name + " " + attribute.value + "\n";

  const auto column = [&](const std::string& name) { text += csv::as_named(name) + ","; };
  if (writes_episodes(recording)) column("episode");
  for (const Channel& channel : recording.channels) {
    const std::string unit = channel.unit.empty() ? "" : "[" + channel.unit + "]";
    column(std::string(role_letter(channel.role)) + ":" + channel.name + unit);
  }
  for (const RowFlag& flag : recording.flags) column("flag:" + flag.name);
  text.back() = '\n';
}

void append_row(std::string& text, const Recording& recording, std::size_t row) {
  if (writes_episodes(recording)) {
    text += std::to_string(recording.episode_ids.empty() ? 0 : recording.episode_ids[row]) + ",";
  }
  for (const Channel& channel : recording.channels) {
    if (!std::isnan(channel.samples[row])) text += number_text(channel.samples[row]);
    text += ',';
  }
  for (const RowFlag& flag : recording.flags) text += flag.rows[row] ? "1," : "0,";
  text.back() = '\n';
}

// Returns an error if the text contains one of the forbidden characters.
Result<void> check_text(const std::string& text, std::string_view forbidden, const std::string& what) {
  const std::size_t bad = text.find_first_of(forbidden);
  if (bad == std::string::npos) return {};
  return Error{what + " \"" + text + "\" cannot be written: it holds a character that CSV uses itself"};
}

Result<void> check_writable(const Recording& recording) {
  if (auto ok = check(recording); !ok) return ok;
  for (const Channel& channel : recording.channels) {
    if (auto ok = check_text(channel.name, "\n\r[]", "the channel's name"); !ok) return ok;
    if (auto ok = check_text(channel.unit, "\n\r[]", "the channel's unit"); !ok) return ok;
  }
  for (const RowFlag& flag : recording.flags) {
    if (auto ok = check_text(flag.name, "\n\r[]", "the flag's name"); !ok) return ok;
  }
  for (const Attribute& attribute : recording.attributes) {
    if (auto ok = check_text(attribute.name, " \t\n\r", "the attribute's name"); !ok) return ok;
    if (auto ok = check_text(attribute.value, "\n\r", "the attribute's value"); !ok) return ok;
  }
  return {};
}

}  // namespace

std::string csv_text(const Recording& recording) {
  std::string text;
  append_head(text, recording);
  for (std::size_t row = 0; row < recording.rows(); ++row) append_row(text, recording, row);
  return text;
}

Result<void> write_csv(const std::filesystem::path& path, const Recording& recording) {
  if (auto ok = check_writable(recording); !ok) return Error{path_text(path) + ": " + ok.error().message};
  return write_file(path, csv_text(recording));
}

}  // namespace wisp

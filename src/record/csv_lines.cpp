#include "record/csv_state.hpp"

#include <algorithm>
#include <istream>

#include "record/csv_cells.hpp"

namespace wisp::csv {
namespace {

constexpr std::size_t kLongestLine = std::size_t{16} << 20, kBlock = std::size_t{1} << 18;

bool is_control(char c) {
  const auto byte = static_cast<unsigned char>(c);
  return (byte < 0x20 && c != '\t' && c != '\r' && c != '\n') || byte == 0x7f;
}

// Returns whether all lines end in LF. Branchless, so that it is vectorised; one byte after the last is read.
bool is_plain(const char* first, std::size_t size) {
  unsigned char odd = 0;
  for (std::size_t k = 0; k < size; ++k) {
    const auto byte = static_cast<unsigned char>(first[k]);
    const bool kept = (byte == '\t') | (byte == '\n') | (byte == '\r');
    const bool alone = (byte == '\r') & (first[k + 1] != '\n');
    odd |= static_cast<unsigned char>(((byte < 0x20) & !kept) | (byte == 0x7f) | alone);
  }
  return odd == 0;
}

// Returns whether a line between rows is a comment.
bool is_comment(std::string_view line) {
  const std::string_view text = trimmed(line);
  return text == "#" || text.substr(0, 2) == "# " || text.substr(0, 1) == "%";  // #N/A and #DIV/0! are cells
}

bool is_utf16(std::string_view line) { return line.substr(0, 2) == "\xff\xfe" || line.substr(0, 2) == "\xfe\xff"; }

}  // namespace

std::string shown(std::string_view text) {
  constexpr std::size_t kMax = 40;
  std::string out;
  for (char c : text.substr(0, kMax)) out += static_cast<unsigned char>(c) < 0x20 || c == 0x7f ? '?' : c;
  return "\"" + out + (text.size() > kMax ? "…\"" : "\"");
}

// Reads another block behind the unconsumed text; false at the end.
bool Lines::fill() {
  if (over_) return false;
  const std::size_t needed = std::min(keep_, std::min(begin_, at_));
  buffer_.erase(0, needed);
  begin_ -= needed, at_ -= needed;
  if (keep_ != std::string::npos) keep_ -= needed;
  const std::size_t before = buffer_.size();
  buffer_.resize(before + kBlock);
  const auto read = stream_->rdbuf()->sgetn(buffer_.data() + before, static_cast<std::streamsize>(kBlock));
  buffer_.resize(before + static_cast<std::size_t>(std::max<std::streamsize>(read, 0)));
  over_ = read < static_cast<std::streamsize>(kBlock);
  // The previous block may have ended in a CR; this block's last byte is checked with the next.
  const std::size_t from = before == 0 ? 0 : before - 1, to = over_ ? buffer_.size() : buffer_.size() - 1;
  plain_ = plain_ && is_plain(buffer_.data() + from, to - from);
  return buffer_.size() > before;
}

// Returns the end of the line that begins at at_, or the size of the buffer for the last one.
std::size_t Lines::line_end() {
  for (std::size_t from = at_;;) {
    const std::string_view all(buffer_);
    const std::size_t end = plain_ ? all.find('\n', from) : all.find_first_of("\r\n", from);
    if (end != std::string_view::npos && (all[end] == '\n' || end + 1 < all.size() || over_)) return end;
    if (buffer_.size() - at_ > kLongestLine) return buffer_.size();
    // Resumes at the last byte, which may be a CR.
    const std::size_t seen = std::max(buffer_.size(), at_ + 1) - at_ - 1;
    if (!fill()) return buffer_.size();
    from = at_ + seen;
  }
}

Result<bool> Lines::next() {
  for (;;) {
    begin_ = at_;
    const std::size_t end = line_end();
    begin_ = at_, length_ = end - begin_;
    ++row_;
    if (length_ > kLongestLine) {
      return at_row("the line is longer than 16 MiB, expected a row of numbers; is this a CSV file?");
    }
    if (begin_ == buffer_.size()) return false;
    at_ = std::min(end + 1, buffer_.size());
    if (end < buffer_.size() && buffer_[end] == '\r' && at_ < buffer_.size() && buffer_[at_] == '\n') ++at_;
    if (row_ == 1 && text().starts_with("\xef\xbb\xbf")) begin_ += 3, length_ -= 3;
    const std::string_view line = text();
    if (!plain_ && std::any_of(line.begin(), line.end(), is_control)) {
      if (row_ == 1 && is_utf16(line)) return at_row("is UTF-16; save it as UTF-8 (Excel: \"CSV UTF-8\")");
      return at_row("holds bytes that are not text; expected a CSV file");
    }
    if (!trimmed(line).empty() && !(pass_comments_ && is_comment(line))) return true;
  }
}

Result<std::vector<Lines::Line>> Lines::look_ahead(std::size_t count) {
  std::vector<Line> lines;
  const std::size_t row = row_, length = length_;
  const std::size_t ahead = at_ - begin_;
  keep_ = begin_;
  Result<bool> more = true;
  while (lines.size() < count && (more = next()) && *more) lines.push_back({std::string(text()), row_});
  begin_ = keep_, at_ = begin_ + ahead, row_ = row, length_ = length;
  keep_ = std::string::npos;
  if (!more) return more.error();
  return lines;
}

}  // namespace wisp::csv

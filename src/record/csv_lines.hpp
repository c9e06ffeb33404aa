#pragma once
// Lines of a table, out of blocks of its bytes.

#include <iosfwd>
#include <string>
#include <string_view>
#include <vector>

#include "wisp/base/result.hpp"

namespace wisp::csv {

/// What was found, short enough for a message of one line.
std::string shown(std::string_view text);

class Lines {
 public:
  struct Line {
    std::string text;
    std::size_t row = 0;  ///< 1-based, as an editor counts
  };

  /// Precondition: `stream` outlives it. `name` stands for it in messages.
  Lines(std::istream& stream, std::string_view name) : stream_(&stream), name_(name) {}

  /// Goes on to the next line that is not blank; false at the end. Lines end in LF, CR LF or CR. Errors: bytes that are
  /// not text, a line longer than 16 MiB.
  Result<bool> next();

  /// The line, without its end; a view that lives until the next call.
  std::string_view text() const { return {buffer_.data() + begin_, length_}; }
  std::size_t row() const { return row_; }

  /// The lines that next() will give, up to `count` of them. Errors: as next().
  Result<std::vector<Line>> look_ahead(std::size_t count);

  /// The next line is this one again.
  void back() { at_ = begin_, --row_; }

  /// From here on lines that begin with "# " or % are passed over too.
  void pass_comments() { pass_comments_ = true; }

  Error at_row(const std::string& what, std::size_t row = 0) const {
    return {name_ + ", row " + std::to_string(row > 0 ? row : row_) + ": " + what};
  }
  const std::string& name() const { return name_; }

 private:
  bool fill();
  std::size_t line_end();

  std::istream* stream_;
  std::string name_;
  std::string buffer_;
  std::size_t begin_ = 0, length_ = 0;  // of the line
  std::size_t at_ = 0;                  // where the next one begins
  std::size_t keep_ = std::string::npos;
  std::size_t row_ = 0;
  bool over_ = false;  // the stream
  bool plain_ = true;  // no byte so far that is not text, no CR without LF
  bool pass_comments_ = false;
};

}  // namespace wisp::csv

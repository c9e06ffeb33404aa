#pragma once
// Recordings of real things and reference figures, which are not part of the project: where they are, and how to read
// them. Tests that want them skip where they are absent.

#include <cctype>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

#include "paths.hpp"
#include "wisp/record/csv.hpp"
#include "wisp/record/recording.hpp"

namespace wisp::shared {

inline std::filesystem::path folder(const char* variable, const char* name) {
  if (const char* set = std::getenv(variable)) return set;
  return std::filesystem::path(WISP_SOURCE_DIR) / ".." / "shared" / name;
}

inline std::filesystem::path data(const std::string& file) { return folder("WISP_DATA", "data") / file; }
inline std::filesystem::path reference(const std::string& file) { return folder("WISP_REFERENCE", "reference") / file; }

/// A recording of the identification sets; its columns u1 … are inputs, y1 … outputs.
inline Recording read_sysid(const std::string& name) {
  const auto path = data("sysid/" + name + ".csv");
  std::ifstream stream(path);
  CsvOptions options{.rate_hz = 1};
  std::string header;
  std::getline(stream, header);
  std::istringstream columns(header);
  for (std::string column; std::getline(columns, column, ',');) {
    (column.front() == 'u' ? options.inputs : options.outputs).push_back(column);
  }
  auto recording = read_csv(path, options);
  if (!recording) throw std::runtime_error(recording.error().message);
  return *recording;
}

/// A JSON value: just enough to read reference files.
struct Json {
  double number = 0;
  std::string text;
  std::vector<Json> items;
  std::map<std::string, Json> fields;

  const Json& operator[](const std::string& field) const { return fields.at(field); }
  const Json& operator[](std::size_t index) const { return items.at(index); }
  std::vector<double> numbers() const {
    std::vector<double> out;
    for (const Json& item : items) out.push_back(item.number);
    return out;
  }
};

class JsonReader {
 public:
  explicit JsonReader(const std::filesystem::path& path) {
    std::ifstream stream(path);
    text_.assign(std::istreambuf_iterator<char>(stream), {});
  }

  Json read() {
    Json value;
    skip();
    if (text_[at_] == '{') {
      while (text_[at_] != '}') {
        ++at_;
        const std::string field = read().text;
        skip();
        ++at_;
        value.fields[field] = read();
        skip();
      }
      ++at_;
    } else if (text_[at_] == '[') {
      while (text_[at_] != ']') {
        ++at_;
        value.items.push_back(read());
        skip();
      }
      ++at_;
    } else if (text_[at_] == '"') {
      while (text_[++at_] != '"') value.text += text_[at_];
      ++at_;
    } else {
      std::size_t length = 0;
      value.number = std::stod(text_.substr(at_, 40), &length);
      at_ += length;
    }
    return value;
  }

 private:
  void skip() {
    while (std::isspace(static_cast<unsigned char>(text_[at_]))) ++at_;
  }

  std::string text_;
  std::size_t at_ = 0;
};

}  // namespace wisp::shared

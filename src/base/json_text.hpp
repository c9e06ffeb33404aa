#pragma once
// Writer of JSON text: objects, lists and values in order, numbers as the shortest text that reads back as the same
// number. For documents of a fixed shape: keys need no escape, numbers are finite. Control characters become blanks.

#include <charconv>
#include <concepts>
#include <string>
#include <string_view>
#include <type_traits>

namespace wisp {

template <class T>
concept JsonNumber = std::is_arithmetic_v<T> && !std::same_as<T, bool>;

class JsonText {
 public:
  JsonText& object(std::string_view key = {}) { return open(key, '{'); }
  JsonText& list(std::string_view key = {}) { return open(key, '['); }

  /// Ends the innermost object or list.
  JsonText& end() {
    text_ += closers_.back();
    closers_.pop_back();
    first_ = false;
    return *this;
  }

  template <JsonNumber Number>
  JsonText& value(Number number, std::string_view key = {}) {
    char digits[32];
    const auto end = std::to_chars(digits, digits + sizeof digits, number).ptr;
    return put({digits, static_cast<std::size_t>(end - digits)}, key);
  }

  JsonText& value(bool yes, std::string_view key = {}) { return put(yes ? "true" : "false", key); }

  JsonText& value(std::string_view words, std::string_view key) {
    std::string quoted = "\"";
    for (const char c : words) {
      if (c == '"' || c == '\\') quoted += '\\';
      quoted += static_cast<unsigned char>(c) < 0x20 ? ' ' : c;
    }
    return put(quoted + '"', key);
  }
  JsonText& value(const char* words, std::string_view key) { return value(std::string_view(words), key); }

  /// Adds a list of values of any type that value() accepts.
  template <class Values>
  JsonText& values(const Values& all, std::string_view key = {}) {
    list(key);
    for (const auto& each : all) value(each, {});
    return end();
  }

  const std::string& text() const { return text_; }

 private:
  JsonText& put(std::string_view written, std::string_view key) {
    if (!first_) text_ += ',';
    first_ = false;
    if (!key.empty()) text_.append(1, '"').append(key).append("\":");
    text_ += written;
    return *this;
  }

  JsonText& open(std::string_view key, char opener) {
    put({&opener, 1}, key);
    closers_ += opener == '{' ? '}' : ']';
    first_ = true;
    return *this;
  }

  std::string text_;
  std::string closers_;
  bool first_ = true;
};

}  // namespace wisp

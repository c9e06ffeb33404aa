#pragma once
// Result of a function that reads data from outside: a value, or one sentence that explains the failure. Also the
// handling of broken preconditions, which are checked in every build, an installed release included.

#include <cstddef>
#include <string>
#include <utility>
#include <variant>

namespace wisp {

/// Receives one sentence about a broken precondition. It may throw or end the program. If it returns, the misused call
/// does nothing; Result::value() and error(), which have nothing to return, end the program.
using MisuseHandler = void (*)(const char* sentence);

/// Replaces the handler of all threads. Null restores the default, which prints the sentence and ends the program.
/// Returns the previous handler.
MisuseHandler set_misuse_handler(MisuseHandler handler);

/// Both pass a sentence to the handler; end_on_misuse() also ends the program if the handler returns.
void report_misuse(const char* sentence);
[[noreturn]] void end_on_misuse(const char* sentence);

/// Returns whether `found` equals (`or_more`: is at least) `expected`; otherwise reports misuse of `call`.
bool check_size(const char* call, std::size_t found, std::size_t expected, bool or_more = false);

/// Failure caused by outside data: one line with the file, the place in it, what was found, what was expected and what
/// to do.
struct Error {
  std::string message;
};

/// A value of type T, or the Error that explains why there is none.
/// Precondition of value(): holds a value. Otherwise the error's sentence is reported as misuse, and the program ends.
/// Precondition of error(): holds an error.
template <class T>
class [[nodiscard]] Result {
 public:
  Result(T value) : held_(std::in_place_index<0>, std::move(value)) {}
  Result(Error error) : held_(std::in_place_index<1>, std::move(error)) {}

  explicit operator bool() const { return held_.index() == 0; }

  T& value() & { return const_cast<T&>(std::as_const(*this).value()); }
  const T& value() const& {
    if (!*this) [[unlikely]]
      end_on_misuse(error().message.c_str());
    return *std::get_if<0>(&held_);
  }
  T&& value() && { return std::move(value()); }

  T& operator*() & { return value(); }
  const T& operator*() const& { return value(); }
  T&& operator*() && { return std::move(*this).value(); }
  T* operator->() { return &value(); }
  const T* operator->() const { return &value(); }

  const Error& error() const {
    if (*this) [[unlikely]]
      end_on_misuse("error() was asked of a result that holds a value");
    return *std::get_if<1>(&held_);
  }

 private:
  std::variant<T, Error> held_;
};

/// Success, or the Error that explains why not.
template <>
class [[nodiscard]] Result<void> {
 public:
  Result() = default;
  Result(Error error) : error_(std::move(error)), failed_(true) {}

  explicit operator bool() const { return !failed_; }
  const Error& error() const {
    if (!failed_) [[unlikely]]
      end_on_misuse("error() was asked of a result that holds no error");
    return error_;
  }

 private:
  Error error_;
  bool failed_ = false;
};

}  // namespace wisp

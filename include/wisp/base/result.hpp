#pragma once
// The outcome of anything that reads data from outside: a value, or one clear sentence about what is wrong.

#include <cassert>
#include <string>
#include <utility>
#include <variant>

namespace wisp {

/// What went wrong with data from outside: one line that names the file, the place in it, what was found,
/// what was expected and what to do.
struct Error {
  std::string message;
};

/// A value of type T, or the Error that stands in its place.
///
/// Precondition of value(): holds a value.
/// Precondition of error(): holds an error.
template <class T>
class [[nodiscard]] Result {
 public:
  Result(T value) : held_(std::in_place_index<0>, std::move(value)) {}
  Result(Error error) : held_(std::in_place_index<1>, std::move(error)) {}

  explicit operator bool() const { return held_.index() == 0; }

  T& value() & {
    assert(*this);
    return *std::get_if<0>(&held_);
  }
  const T& value() const& {
    assert(*this);
    return *std::get_if<0>(&held_);
  }
  T&& value() && {
    assert(*this);
    return std::move(*std::get_if<0>(&held_));
  }

  T& operator*() & { return value(); }
  const T& operator*() const& { return value(); }
  T&& operator*() && { return std::move(*this).value(); }
  T* operator->() { return &value(); }
  const T* operator->() const { return &value(); }

  const Error& error() const {
    assert(!*this);
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
    assert(failed_);
    return error_;
  }

 private:
  Error error_;
  bool failed_ = false;
};

}  // namespace wisp

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <iosfwd>
#include <string>
#include <utility>
#include <variant>

#include "core/check.hpp"

namespace footlight {

/// Whose fault it is; decides the exit status of the program (docs/errors.md).
enum class ErrorKind {
  internal,     ///< exit 1: a bug of ours
  input,        ///< exit 2: show, rig, media or command line
  refused,      ///< exit 3: the plan fails validation or cannot be delivered
  device,       ///< exit 4: a bus or a marker
  interrupted,  ///< exit 130: the user stopped long work
};

/// A user or environment error: one message, complete enough to act on.
struct Error {
  ErrorKind kind = ErrorKind::internal;
  std::string message;

  friend bool operator==(const Error&, const Error&) = default;
};

/// For logs and tests.
std::ostream& operator<<(std::ostream& out, const Error& error);

inline Error input_error(std::string message) { return {ErrorKind::input, std::move(message)}; }
inline Error refusal(std::string message) { return {ErrorKind::refused, std::move(message)}; }
inline Error device_error(std::string message) { return {ErrorKind::device, std::move(message)}; }
inline Error internal_error(std::string message) { return {ErrorKind::internal, std::move(message)}; }

/// A value or the reason why there is none. Member names follow std::expected (C++23).
template <class T, class E = Error>
class [[nodiscard]] Result {
 public:
  Result(T value) : state_(std::in_place_index<0>, std::move(value)) {}  // NOLINT(google-explicit-constructor)
  Result(E error) : state_(std::in_place_index<1>, std::move(error)) {}  // NOLINT(google-explicit-constructor)

  [[nodiscard]] bool has_value() const noexcept { return state_.index() == 0; }
  explicit operator bool() const noexcept { return has_value(); }

  [[nodiscard]] T& value() & {
    FL_CHECK(has_value());
    return *std::get_if<0>(&state_);
  }
  [[nodiscard]] const T& value() const& {
    FL_CHECK(has_value());
    return *std::get_if<0>(&state_);
  }
  [[nodiscard]] T&& value() && {
    FL_CHECK(has_value());
    return std::move(*std::get_if<0>(&state_));
  }
  [[nodiscard]] const E& error() const& {
    FL_CHECK(!has_value());
    return *std::get_if<1>(&state_);
  }
  [[nodiscard]] E&& error() && {
    FL_CHECK(!has_value());
    return std::move(*std::get_if<1>(&state_));
  }

  T& operator*() & { return value(); }
  const T& operator*() const& { return value(); }
  T&& operator*() && { return std::move(*this).value(); }
  T* operator->() { return &value(); }
  const T* operator->() const { return &value(); }

 private:
  std::variant<T, E> state_;
};

/// Success without a value, or an error.
struct Done {
  friend bool operator==(const Done&, const Done&) = default;
};
template <class E = Error>
using Status = Result<Done, E>;

}  // namespace footlight

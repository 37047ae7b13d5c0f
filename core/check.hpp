// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace footlight {

/// Prints the broken expectation with its place to stderr and aborts. Thread: any.
[[noreturn]] void check_failed(const char* expression, const char* file, int line) noexcept;

}  // namespace footlight

/// Programmer errors stop the program at the place where they are seen; never used for what a user, a file or a
/// device can cause.
#define FL_CHECK(expression) \
  (static_cast<bool>(expression) ? static_cast<void>(0) : ::footlight::check_failed(#expression, __FILE__, __LINE__))

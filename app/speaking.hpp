// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdio>
#include <string_view>

#include "app/writer_thread.hpp"
#include "core/result.hpp"

namespace footlight::app {

/// While one of these lives, what the sessions of the program say goes to stdout and stderr by a thread of each: a
/// reader that has stopped, or Ctrl-S, makes nobody wait who leads a show. One at a time.
class Speaking {
 public:
  Speaking();
  /// As `end`.
  ~Speaking();
  Speaking(const Speaking&) = delete;
  Speaking& operator=(const Speaking&) = delete;

  /// Waits until all is written, as long as somebody reads. Errors (ErrorKind::input): stdout could not be written.
  Status<> end();
  /// Texts that were left out for a reader that was too slow, and are not told yet; 0 while it is still behind.
  [[nodiscard]] std::uint64_t left_out() { return out_.left_out() + err_.left_out(); }

  /// Says it, by a thread where there is one, else at once. @param file stdout or stderr  @return whether it is said
  static bool say(std::FILE* file, std::string_view text, WriterThread::Worth worth = WriterThread::Worth::lasting);
  /// As `end`, of the one that lives, if any.
  static void end_now();
  /// As the member, of the one that lives; 0: none does.
  [[nodiscard]] static std::uint64_t lost();

 private:
  WriterThread out_;
  WriterThread err_;
};

}  // namespace footlight::app

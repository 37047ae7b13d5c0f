// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <string_view>

#include "core/result.hpp"
#include "core/time.hpp"

namespace footlight::app {

/// Writes to one place that may make its writer wait: a terminal somebody has stopped, a pipe nobody reads, a slow
/// disk. Whoever says something waits for nothing; what is said comes in its order. One thread says, another one
/// writes.
///
/// Bounded: beyond `kMostStatus` bytes waiting what is only a status is left out, beyond `kMostBytes` everything. A
/// write that fails loses that text and is told by `trouble`; the next one is tried.
class WriterThread {
 public:
  static constexpr std::size_t kMostStatus = std::size_t{1} << 16U;
  static constexpr std::size_t kMostBytes = std::size_t{1} << 22U;
  static constexpr Duration kPatience = milliseconds(1000);

  enum class Worth : std::uint8_t {
    lasting,  ///< an answer, an event: kept as long as there is room
    status,   ///< the next one makes it worthless
  };
  /// May block. Called by the thread alone, one call after the other.
  using Write = std::function<Status<>(std::string_view text)>;

  explicit WriterThread(Write write);
  /// As `close`.
  ~WriterThread();
  WriterThread(const WriterThread&) = delete;
  WriterThread& operator=(const WriterThread&) = delete;

  /// Writes all of it to a file descriptor, which has to be there as long as this is called.
  [[nodiscard]] static Status<> write_all(int file, std::string_view text);

  /// Does not block. @return whether it will be written
  bool put(std::string text, Worth worth = Worth::lasting);
  /// Until all is written, as long as something is within each `patience`. @return whether it is
  bool flush(Duration patience = kPatience);
  /// The same, and nothing may be put any more. A write that does not come back is left to its fate.
  bool close(Duration patience = kPatience);

  /// Texts that were left out and are not told yet; 0 while it is still behind.
  [[nodiscard]] std::uint64_t left_out();
  /// Why the last write failed; empty: it did not.
  [[nodiscard]] std::string trouble() const;

 private:
  struct Shared;
  static void run(const std::shared_ptr<Shared>& shared);

  std::shared_ptr<Shared> shared_;  ///< the thread has it, too: it may outlive this
  bool closed_ = false;
};

}  // namespace footlight::app

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <condition_variable>
#include <cstdint>
#include <deque>
#include <filesystem>
#include <memory>
#include <mutex>
#include <string>
#include <thread>

#include "core/file_descriptor.hpp"
#include "core/result.hpp"
#include "core/time.hpp"

namespace footlight::app {

/// Who did what at the console, and what came of it.
struct AuditLine {
  std::string who;   ///< her name; empty: not known yet
  std::string from;  ///< address
  std::string role;
  std::string what;  ///< "order go", "seat take", "token"
  std::string result;
  std::string cue{};
  std::string plan{};  ///< hash
};

/// One line of JSON, with its end; whatever somebody has typed stays one line. @param since_1970 wall time
[[nodiscard]] std::string audit_text(const AuditLine& line, Duration since_1970);

/// A file that is only ever appended to, mode 0600. A thread of its own writes; what does not fit its queue, or the
/// disk, is counted and said in the file when there is room again. Any thread may add.
class AuditLog {
 public:
  static constexpr std::size_t kMostWaiting = 4096;

  /// Errors (ErrorKind::input): the file cannot be opened for appending, or is a link.
  [[nodiscard]] static Result<std::unique_ptr<AuditLog>> open(const std::filesystem::path& file);
  explicit AuditLog(FileDescriptor file);
  ~AuditLog();
  AuditLog(const AuditLog&) = delete;
  AuditLog& operator=(const AuditLog&) = delete;

  void add(const AuditLine& line);
  [[nodiscard]] std::uint64_t lost() const;

 private:
  void run();
  [[nodiscard]] bool write(const std::string& text) const;

  FileDescriptor file_;
  mutable std::mutex mutex_;
  std::condition_variable news_;
  std::deque<std::string> waiting_;
  std::uint64_t lost_ = 0;
  std::uint64_t told_lost_ = 0;
  bool ends_ = false;
  std::thread thread_;
};

}  // namespace footlight::app

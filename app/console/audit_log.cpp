// SPDX-License-Identifier: Apache-2.0
#include "app/console/audit_log.hpp"

#include <cerrno>
#include <chrono>
#include <cstring>
#include <ctime>
#include <utility>

#include <fcntl.h>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "app/live/waiting.hpp"
#include "core/clock.hpp"

namespace footlight::app {
namespace {

std::string utc_text(Duration since_1970) {
  using std::chrono::duration_cast;
  const auto ms = duration_cast<std::chrono::milliseconds>(since_1970).count();
  const std::time_t whole = ms / 1000;
  std::tm utc{};
  ::gmtime_r(&whole, &utc);
  return fmt::format("{:04}-{:02}-{:02}T{:02}:{:02}:{:02}.{:03}Z", utc.tm_year + 1900, utc.tm_mon + 1, utc.tm_mday,
                     utc.tm_hour, utc.tm_min, utc.tm_sec, ms % 1000);
}

}  // namespace

std::string audit_text(const AuditLine& line, Duration since_1970) {
  nlohmann::ordered_json json{
      {"time", utc_text(since_1970)}, {"who", line.who}, {"from", line.from}, {"role", line.role}, {"what", line.what},
      {"result", line.result},        {"cue", line.cue}, {"plan", line.plan}};
  // Everything beyond ASCII is escaped, too: nothing in the file can move a terminal's cursor.
  return json.dump(-1, ' ', true, nlohmann::ordered_json::error_handler_t::replace) + "\n";
}

Result<std::unique_ptr<AuditLog>> AuditLog::open(const std::filesystem::path& file) {
  FileDescriptor opened(::open(file.c_str(), O_WRONLY | O_CREAT | O_APPEND | O_CLOEXEC | O_NOFOLLOW, 0600));
  if (opened.get() < 0) {
    return input_error(fmt::format("console log {}: {}", file.string(), std::strerror(errno)));  // NOLINT
  }
  return std::make_unique<AuditLog>(std::move(opened));
}

AuditLog::AuditLog(FileDescriptor file) : file_(std::move(file)) {
  thread_ = std::thread([this] { run(); });
}

AuditLog::~AuditLog() {
  {
    const std::lock_guard lock(mutex_);
    ends_ = true;
  }
  news_.notify_one();
  thread_.join();
}

void AuditLog::add(const AuditLine& line) {
  std::string text = audit_text(line, wall_time());
  const std::lock_guard lock(mutex_);
  if (waiting_.size() >= kMostWaiting) {
    ++lost_;
    return;
  }
  waiting_.push_back(std::move(text));
  news_.notify_one();
}

std::uint64_t AuditLog::lost() const {
  const std::lock_guard lock(mutex_);
  return lost_;
}

void AuditLog::run() {
  yield_to_the_show();
  std::unique_lock lock(mutex_);
  while (true) {
    news_.wait(lock, [this] { return ends_ || !waiting_.empty(); });
    if (waiting_.empty()) return;
    const auto taken = std::exchange(waiting_, {});
    const std::uint64_t missing = lost_ - told_lost_;
    lock.unlock();
    std::string text;
    for (const std::string& line : taken) text += line;
    if (missing > 0) text += audit_text({"", "", "", "lost lines", std::to_string(missing), "", ""}, wall_time());
    const bool written = write(text);
    lock.lock();
    if (written) {
      told_lost_ += missing;
    } else {
      lost_ += taken.size();
    }
  }
}

bool AuditLog::write(const std::string& text) const {
  for (std::size_t at = 0; at < text.size();) {
    const ssize_t put = ::write(file_.get(), text.data() + at, text.size() - at);
    if (put < 0 && errno == EINTR) continue;
    if (put <= 0) return false;
    at += static_cast<std::size_t>(put);
  }
  return true;
}

}  // namespace footlight::app

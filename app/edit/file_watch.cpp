// SPDX-License-Identifier: Apache-2.0
#include "app/edit/file_watch.hpp"

#include <array>
#include <filesystem>

#include <sys/inotify.h>
#include <sys/stat.h>
#include <unistd.h>

namespace footlight::app {

FileWatch::Stamp FileWatch::stamp_of(const std::string& file) {
  struct stat is {};
  if (::stat(file.c_str(), &is) != 0) return {};
  return {static_cast<long long>(is.st_dev), static_cast<long long>(is.st_ino), is.st_size, is.st_mtim.tv_sec,
          is.st_mtim.tv_nsec};
}

void FileWatch::watch(const std::vector<std::string>& files) {
  // Anew, so that folders that no longer matter are forgotten.
  events_ = FileDescriptor(::inotify_init1(IN_NONBLOCK | IN_CLOEXEC));
  names_.clear();
  stamps_.clear();
  touched_ = Instant::max();
  for (const std::string& file : files) {
    stamps_[file] = stamp_of(file);
    const std::filesystem::path path = std::filesystem::absolute(file);
    if (events_.get() < 0) continue;
    const int folder = ::inotify_add_watch(
        events_.get(), path.parent_path().c_str(),
        IN_CLOSE_WRITE | IN_MODIFY | IN_CREATE | IN_MOVED_TO | IN_MOVED_FROM | IN_DELETE | IN_ATTRIB | IN_ONLYDIR);
    if (folder >= 0) names_[folder].insert(path.filename().string());
  }
}

bool FileWatch::take_events() {
  bool ours = false;
  alignas(inotify_event) std::array<char, 16384> bytes{};
  for (;;) {
    const ssize_t size = events_.get() < 0 ? -1 : ::read(events_.get(), bytes.data(), bytes.size());
    if (size <= 0) return ours;
    for (std::size_t i = 0; i < static_cast<std::size_t>(size);) {
      const auto* event = reinterpret_cast<const inotify_event*>(&bytes[i]);
      i += sizeof(inotify_event) + event->len;
      const auto folder = names_.find(event->wd);
      const bool lost = (event->mask & (IN_Q_OVERFLOW | IN_IGNORED)) != 0;
      ours = ours || lost || (folder != names_.end() && event->len > 0 && folder->second.contains(event->name));
    }
  }
}

bool FileWatch::changed(Instant now) {
  if (take_events()) touched_ = now;
  const bool quiet = touched_ != Instant::max() && now - touched_ >= kQuiet;
  const bool looks = touched_ == Instant::max() && now >= look_at_;
  if (!quiet && !looks) return false;
  look_at_ = now + kLook;
  bool other = false;
  for (const auto& [file, stamp] : stamps_) other = other || stamp_of(file) != stamp;
  if (other && looks) {
    touched_ = now;  // perhaps it is being written
    return false;
  }
  touched_ = Instant::max();
  for (auto& [file, stamp] : stamps_) stamp = stamp_of(file);
  return other;
}

}  // namespace footlight::app

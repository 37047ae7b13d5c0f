// SPDX-License-Identifier: Apache-2.0
#include "app/writer_thread.hpp"

#include <cerrno>
#include <chrono>
#include <condition_variable>
#include <csignal>
#include <deque>
#include <mutex>
#include <system_error>
#include <thread>
#include <utility>

#include <poll.h>
#include <unistd.h>

namespace footlight::app {

struct WriterThread::Shared {
  explicit Shared(Write by) : write(std::move(by)) {}
  const Write write;
  std::mutex mutex;
  std::condition_variable news;     ///< for the thread
  std::condition_variable written;  ///< for who waits for it
  std::deque<std::string> waiting;  ///< the first is being written while `busy`
  std::size_t bytes = 0;
  bool busy = false;
  bool closing = false;
  bool over = false;
  std::uint64_t writes = 0;
  std::uint64_t left_out = 0;
  std::string trouble;
};

WriterThread::WriterThread(Write write) : shared_(std::make_shared<Shared>(std::move(write))) {
  // Signals are for those threads that wait for them.
  sigset_t all;
  sigset_t before;
  ::sigfillset(&all);
  (void)::pthread_sigmask(SIG_SETMASK, &all, &before);
  // It may be in the middle of a write that never comes back: nobody can wait for its end.
  std::thread([shared = shared_] { run(shared); }).detach();
  (void)::pthread_sigmask(SIG_SETMASK, &before, nullptr);
}

WriterThread::~WriterThread() { (void)close(); }

Status<> WriterThread::write_all(int file, std::string_view text) {
  while (!text.empty()) {
    const ssize_t count = ::write(file, text.data(), text.size());
    if (count >= 0) {
      text.remove_prefix(static_cast<std::size_t>(count));
    } else if (errno == EAGAIN) {  // whoever has the other end has asked for that
      pollfd room{file, POLLOUT, 0};
      (void)::poll(&room, 1, -1);
    } else if (errno != EINTR) {
      return input_error(std::generic_category().message(errno));
    }
  }
  return Done{};
}

void WriterThread::run(const std::shared_ptr<Shared>& shared) {
  std::unique_lock lock(shared->mutex);
  while (true) {
    shared->news.wait(lock, [&] { return shared->closing || !shared->waiting.empty(); });
    if (shared->waiting.empty()) break;
    shared->busy = true;
    const std::string text = std::move(shared->waiting.front());
    lock.unlock();
    auto written = shared->write(text);
    lock.lock();
    shared->busy = false;
    shared->waiting.pop_front();
    shared->bytes -= text.size();
    ++shared->writes;
    shared->trouble = written ? std::string() : std::move(written).error().message;
    shared->written.notify_all();
  }
  shared->over = true;
  shared->written.notify_all();
}

bool WriterThread::put(std::string text, Worth worth) {
  const std::lock_guard lock(shared_->mutex);
  const std::size_t most = worth == Worth::status ? kMostStatus : kMostBytes;
  // However long it is, one text has a place where nothing else waits.
  if (shared_->closing || (!shared_->waiting.empty() && shared_->bytes + text.size() > most)) {
    ++shared_->left_out;
    return false;
  }
  shared_->bytes += text.size();
  shared_->waiting.push_back(std::move(text));
  shared_->news.notify_one();
  return true;
}

bool WriterThread::flush(Duration patience) {
  std::unique_lock lock(shared_->mutex);
  while (!shared_->waiting.empty()) {
    const std::uint64_t before = shared_->writes;
    const auto moved = [&] { return shared_->writes != before; };
    if (!shared_->written.wait_for(lock, std::chrono::nanoseconds(patience), moved)) return false;
  }
  return true;
}

bool WriterThread::close(Duration patience) {
  if (std::exchange(closed_, true)) return true;
  const bool all = flush(patience);
  std::unique_lock lock(shared_->mutex);
  shared_->closing = true;
  if (!all) {  // what begins to be read later is not begun with
    while (shared_->waiting.size() > (shared_->busy ? 1U : 0U)) shared_->waiting.pop_back();
  }
  shared_->news.notify_one();
  // Whatever it borrows it has left, unless it is stuck.
  if (all) shared_->written.wait_for(lock, std::chrono::nanoseconds(patience), [&] { return shared_->over; });
  return all;
}

std::uint64_t WriterThread::left_out() {
  const std::lock_guard lock(shared_->mutex);
  return shared_->waiting.empty() ? std::exchange(shared_->left_out, 0) : 0;
}

std::string WriterThread::trouble() const {
  const std::lock_guard lock(shared_->mutex);
  return shared_->trouble;
}

}  // namespace footlight::app

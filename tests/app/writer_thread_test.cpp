// SPDX-License-Identifier: Apache-2.0
#include "app/writer_thread.hpp"

#include <array>
#include <csignal>
#include <future>
#include <memory>
#include <mutex>
#include <string>
#include <thread>

#include <gtest/gtest.h>
#include <unistd.h>

#include "core/file_descriptor.hpp"

namespace footlight::app {
namespace {

using Worth = WriterThread::Worth;

/// A place that takes nothing until it is let go.
class Slow {
 public:
  Slow() : open_(gate_.get_future()) {}
  WriterThread::Write write() {
    return [this](std::string_view text) -> Status<> {
      began_.set_value_once();
      open_.wait();
      const std::lock_guard lock(mutex_);
      taken_ += text;
      return Done{};
    };
  }
  void wait_until_it_writes() { began_.wait(); }
  void let_go() { gate_.set_value(); }
  std::string taken() {
    const std::lock_guard lock(mutex_);
    return taken_;
  }

 private:
  struct Once {
    std::promise<void> promise;
    std::once_flag flag;
    void set_value_once() {
      std::call_once(flag, [this] { promise.set_value(); });
    }
    void wait() { promise.get_future().wait(); }
  };
  Once began_;
  std::promise<void> gate_;
  std::shared_future<void> open_;
  std::mutex mutex_;
  std::string taken_;
};

TEST(WriterThread, WritesAllInItsOrder) {
  std::array<int, 2> ends{};
  ASSERT_EQ(::pipe(ends.data()), 0);
  const FileDescriptor out(ends[0]);
  const FileDescriptor in(ends[1]);
  std::string expected;
  {
    WriterThread writer([&](std::string_view text) { return WriterThread::write_all(in.get(), text); });
    for (int i = 0; i < 1000; ++i) {
      expected += std::to_string(i) + "\n";
      EXPECT_TRUE(writer.put(std::to_string(i) + "\n", i % 2 == 0 ? Worth::status : Worth::lasting));
    }
    EXPECT_TRUE(writer.close());
  }
  std::string read(expected.size() + 1, '\0');
  read.resize(static_cast<std::size_t>(::read(out.get(), read.data(), read.size())));
  EXPECT_EQ(read, expected);
}

TEST(WriterThread, APipeThatNobodyReadsMakesNobodyWait) {
  (void)std::signal(SIGPIPE, SIG_IGN);  // as the program does: its end comes while a write waits
  std::array<int, 2> ends{};
  ASSERT_EQ(::pipe(ends.data()), 0);
  const FileDescriptor out(ends[0]);
  const auto in = std::make_shared<FileDescriptor>(ends[1]);
  WriterThread writer([in](std::string_view text) { return WriterThread::write_all(in->get(), text); });
  const std::string line(1000, 'x');
  std::uint64_t status = 0;
  std::uint64_t lasting = 0;
  for (int i = 0; i < 10'000; ++i) {
    status += writer.put(line, Worth::status) ? 1 : 0;
    lasting += writer.put(line) ? 1 : 0;
  }
  // What the pipe holds, what waits, and what is being written.
  EXPECT_LE(status, 2U * 65'536 / 1000);
  EXPECT_GE(lasting, WriterThread::kMostBytes / 1000 - status - 1);
  EXPECT_LE(lasting, (WriterThread::kMostBytes + 65'536) / 1000 + 1);
  EXPECT_EQ(writer.left_out(), 0U) << "it is still behind: that can be told to nobody";
  EXPECT_FALSE(writer.flush(milliseconds(20)));
  EXPECT_FALSE(writer.close(milliseconds(20)));
}

TEST(WriterThread, WhatWasLeftOutIsCountedWhenItIsRead) {
  Slow slow;
  WriterThread writer(slow.write());
  EXPECT_TRUE(writer.put("first\n"));
  slow.wait_until_it_writes();
  const std::string big(WriterThread::kMostStatus, '.');
  EXPECT_TRUE(writer.put(big)) << "an answer has room where a status has none";
  for (int i = 0; i < 3; ++i) EXPECT_FALSE(writer.put("status\n", Worth::status));
  EXPECT_TRUE(writer.put("answer\n"));
  EXPECT_EQ(writer.left_out(), 0U);
  slow.let_go();
  EXPECT_TRUE(writer.flush());
  EXPECT_EQ(slow.taken(), "first\n" + big + "answer\n");
  EXPECT_EQ(writer.left_out(), 3U);
  EXPECT_EQ(writer.left_out(), 0U);
  EXPECT_TRUE(writer.put("status\n", Worth::status));
}

TEST(WriterThread, ATextThatIsLongerThanAllHasAPlaceWhereNothingWaits) {
  Slow slow;
  slow.let_go();
  WriterThread writer(slow.write());
  EXPECT_TRUE(writer.put(std::string(2 * WriterThread::kMostBytes, 'x'), Worth::status));
  EXPECT_TRUE(writer.flush());
}

TEST(WriterThread, AWriteThatFailsIsToldAndTheNextOneIsTried) {
  int writes = 0;
  WriterThread writer([&](std::string_view) -> Status<> {
    if (++writes == 1) return input_error("No space left on device");
    return Done{};
  });
  (void)writer.put("a");
  EXPECT_TRUE(writer.flush());
  EXPECT_EQ(writer.trouble(), "No space left on device");
  (void)writer.put("b");
  EXPECT_TRUE(writer.flush());
  EXPECT_EQ(writer.trouble(), "");
  EXPECT_EQ(writes, 2);
}

TEST(WriterThread, AWriteThatNeverComesBackEndsNothing) {
  const auto slow = std::make_shared<Slow>();
  {
    WriterThread writer([slow, write = slow->write()](std::string_view text) { return write(text); });
    (void)writer.put("stuck");
    slow->wait_until_it_writes();
    (void)writer.put("behind it");
    EXPECT_FALSE(writer.close(milliseconds(5)));
    EXPECT_FALSE(writer.put("after the end"));
  }
  slow->let_go();
  for (int i = 0; i < 1000 && slow->taken().empty(); ++i) std::this_thread::sleep_for(std::chrono::milliseconds(1));
  EXPECT_EQ(slow->taken(), "stuck") << "what waited behind it is not begun with";
}

TEST(WriterThread, AReaderThatIsGoneIsAnError) {
  std::array<int, 2> ends{};
  ASSERT_EQ(::pipe(ends.data()), 0);
  ::close(ends[0]);
  const FileDescriptor in(ends[1]);
  (void)std::signal(SIGPIPE, SIG_IGN);
  const auto written = WriterThread::write_all(in.get(), "x");
  ASSERT_FALSE(written);
  EXPECT_EQ(written.error().message, "Broken pipe");
}

}  // namespace
}  // namespace footlight::app

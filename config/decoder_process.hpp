// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <cstddef>
#include <string>
#include <vector>

#include <sys/types.h>

#include "core/clock.hpp"
#include "core/result.hpp"

namespace footlight::config {

/// The running `footlight-decode` and the pipe from it. It never outlives this object.
class DecoderProcess {
 public:
  /// Starts the program with its own process group (the terminal's interrupt is the parent's affair) and a bare
  /// environment. Errors: ErrorKind::internal when it is not there or cannot be started.
  static Result<DecoderProcess> start(const std::vector<std::string>& arguments, int max_image_pixels);

  DecoderProcess(DecoderProcess&& other) noexcept;
  DecoderProcess& operator=(DecoderProcess&&) = delete;
  DecoderProcess(const DecoderProcess&) = delete;
  DecoderProcess& operator=(const DecoderProcess&) = delete;
  ~DecoderProcess();

  enum class Read { all, end, stopped, late };
  /// Fills `size` bytes. `end`: the pipe was closed before. @param deadline of `clock`
  Read read(void* data, std::size_t size, const Clock& clock, Instant deadline, const std::atomic<bool>* stop);

  /// Ends the child if it still runs. @return its wait status
  int finish(bool kill_it);

 private:
  DecoderProcess(pid_t pid, int fd) : pid_(pid), fd_(fd) {}
  pid_t pid_ = -1;
  int fd_ = -1;
};

}  // namespace footlight::config

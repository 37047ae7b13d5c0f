// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "core/file_descriptor.hpp"

namespace footlight::hardware {

/// A serial CAN adapter (LAWICEL's ASCII protocol) over a pseudo-terminal, and the kernel's interface to it, up. It
/// tells the kernel what bus and error counters are said to be, which no controller model of QEMU can.
class SlcanAdapter {
 public:
  SlcanAdapter();
  ~SlcanAdapter();
  SlcanAdapter(const SlcanAdapter&) = delete;
  SlcanAdapter& operator=(const SlcanAdapter&) = delete;

  /// As the kernel calls it: "slcan0".
  [[nodiscard]] const std::string& interface() const { return interface_; }
  /// Says a line to the kernel: "t1812AABB" a frame, "sb255000" bus-off, "e1a" no acknowledgement.
  void say(const std::string& line);
  /// What the kernel has sent since, line by line; an adapter that is not read fills the kernel's queue.
  std::vector<std::string> read();
  /// The adapter is pulled out.
  void hang_up();

 private:
  FileDescriptor adapter_;
  FileDescriptor terminal_;
  std::string interface_;
  std::string partial_;
};

}  // namespace footlight::hardware

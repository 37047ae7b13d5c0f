// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>

#include "core/file_descriptor.hpp"
#include "core/result.hpp"

namespace footlight::sim {

/// A serial port for other programs: a pseudo-terminal of the kernel behind a symbolic link that stays the same while
/// programs come and go. When the last one has closed it, a fresh pair takes its place, so that settings, an exclusive
/// claim and unread bytes of one program are not there for the next.
class PseudoTerminal {
 public:
  /// Makes the link, over one that is there. Errors: ErrorKind::input, with what the machine said.
  static Result<PseudoTerminal> open(std::filesystem::path link);
  PseudoTerminal(PseudoTerminal&&) = default;
  PseudoTerminal& operator=(PseudoTerminal&&) = default;
  ~PseudoTerminal();

  [[nodiscard]] int handle() const { return file_.get(); }
  [[nodiscard]] const std::filesystem::path& link() const { return link_; }
  /// @return bytes read, 0 when there are none
  std::size_t read(std::span<std::uint8_t> buffer);
  /// What nobody takes is lost, as on a wire.
  void write(std::span<const std::uint8_t> bytes);

 private:
  explicit PseudoTerminal(std::filesystem::path link) : link_(std::move(link)) {}
  Status<> renew();
  [[nodiscard]] bool hung_up() const;

  std::filesystem::path link_;
  FileDescriptor file_;
};

}  // namespace footlight::sim

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <string>
#include <string_view>

#include "core/result.hpp"

namespace footlight::config {

/// Writes a file whole or not at all: to a temporary name in the same folder, to the disk, then renamed. After an
/// error, an interruption or a loss of power `file` is what it was before. A link is followed; a device or a pipe is
/// written to as it is. Errors (ErrorKind::input): the folder or the
/// disk will not take it, with the system's reason.
[[nodiscard]] Status<> write_file(const std::filesystem::path& file, std::string_view content);

/// Gives a file's bytes to `take`, block after block. ErrorKind::input when it cannot be read.
[[nodiscard]] Status<> read_blocks(const std::filesystem::path& file,
                                   const std::function<void(std::string_view)>& take);

/// The whole of a file. ErrorKind::input when it cannot be read or is larger than `max_bytes`.
[[nodiscard]] Result<std::string> read_file(const std::filesystem::path& file, std::size_t max_bytes);

}  // namespace footlight::config

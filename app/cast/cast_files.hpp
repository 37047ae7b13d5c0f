// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "app/console/embedded_files.hpp"

namespace footlight::app {

/// The page of the cast's phones. Written by cmake/EmbedFiles.cmake.
[[nodiscard]] std::span<const EmbeddedFile> cast_files();

[[nodiscard]] inline const EmbeddedFile* cast_file(std::string_view path) { return file_in(cast_files(), path); }

}  // namespace footlight::app

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string_view>

namespace footlight::app {

/// A file of the page, as it was when the program was built.
struct EmbeddedFile {
  std::string_view path;  ///< "/app.js"
  std::string_view bytes;
  std::string_view sha256;  ///< hex
};

/// Written by cmake/EmbedFiles.cmake.
[[nodiscard]] std::span<const EmbeddedFile> console_files();

/// By its path; "/" is "/index.html". Null: there is none.
[[nodiscard]] const EmbeddedFile* file_in(std::span<const EmbeddedFile> files, std::string_view path);
[[nodiscard]] const EmbeddedFile* console_file(std::string_view path);
/// "text/html; charset=utf-8"
[[nodiscard]] std::string_view content_type_of(std::string_view path);

}  // namespace footlight::app

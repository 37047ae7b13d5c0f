// SPDX-License-Identifier: Apache-2.0
#include "app/console/embedded_files.hpp"

#include <algorithm>
#include <array>
#include <utility>

namespace footlight::app {

const EmbeddedFile* file_in(std::span<const EmbeddedFile> files, std::string_view path) {
  if (path == "/") path = "/index.html";
  const auto found = std::ranges::find(files, path, &EmbeddedFile::path);
  return found == files.end() ? nullptr : &*found;
}

const EmbeddedFile* console_file(std::string_view path) { return file_in(console_files(), path); }

std::string_view content_type_of(std::string_view path) {
  using Type = std::pair<std::string_view, std::string_view>;
  constexpr std::array<Type, 8> kTypes{Type{".html", "text/html; charset=utf-8"},
                                       Type{".js", "text/javascript; charset=utf-8"},
                                       Type{".css", "text/css; charset=utf-8"},
                                       Type{".svg", "image/svg+xml"},
                                       Type{".png", "image/png"},
                                       Type{".ico", "image/x-icon"},
                                       Type{".woff2", "font/woff2"},
                                       Type{".webmanifest", "application/manifest+json"}};
  for (const auto& [ending, type] : kTypes) {
    if (path.ends_with(ending)) return type;
  }
  return "application/octet-stream";
}

}  // namespace footlight::app

// SPDX-License-Identifier: Apache-2.0
// footlight-schema ROOT: writes what is made from the key listings into the source tree at ROOT: docs/schema/*.json and
// the tables of docs/show-file.md between their two marks.
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>

#include "config/remote_file.hpp"
#include "config/show_file.hpp"

namespace {

bool write(const std::filesystem::path& file, const std::string& text) {
  std::ofstream out(file, std::ios::binary | std::ios::trunc);
  out << text;
  out.close();
  if (!out) std::fprintf(stderr, "%s: error: cannot be written\n", file.c_str());
  return static_cast<bool>(out);
}

bool write_tables(const std::filesystem::path& page) {
  constexpr std::string_view kBegin = "<!-- tables: made by footlight-schema -->\n";
  constexpr std::string_view kEnd = "<!-- end of tables -->\n";
  std::ostringstream in;
  in << std::ifstream(page, std::ios::binary).rdbuf();
  std::string text = in.str();
  const std::size_t begin = text.find(kBegin);
  const std::size_t end = text.find(kEnd);
  if (begin == std::string::npos || end == std::string::npos || end < begin) {
    std::fprintf(stderr, "%s: error: the marks of the tables are missing\n", page.c_str());
    return false;
  }
  text.replace(begin + kBegin.size(), end - begin - kBegin.size(), footlight::config::show_reference());
  return write(page, text);
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 2) {
    std::fputs("usage: footlight-schema ROOT   (ROOT: the source tree)\n", stderr);
    return 2;
  }
  const std::filesystem::path docs = std::filesystem::path(argv[1]) / "docs";
  std::error_code ignored;
  std::filesystem::create_directories(docs / "schema", ignored);
  const bool written = write(docs / "schema" / "show.schema.json", footlight::config::show_schema()) &&
                       write(docs / "schema" / "rig.schema.json", footlight::config::rig_schema()) &&
                       write(docs / "schema" / "remote.schema.json", footlight::config::remote_schema()) &&
                       write(docs / "schema" / "profile.schema.json", footlight::config::profile_schema()) &&
                       write_tables(docs / "show-file.md");
  return written ? 0 : 2;
}

// SPDX-License-Identifier: Apache-2.0
#include "config/zip_file.hpp"

#include <algorithm>
#include <utility>

#include <fmt/format.h>
#include <zip.h>

#include "config/nearest.hpp"

namespace footlight::config {
namespace {

/// Whether a name stays inside of whatever it is unpacked into, by the rules of every system.
bool stays_inside(std::string_view name) {
  if (name.empty() || name.front() == '/' || name.front() == '\\' || name.find(':') == 1) return false;
  if (std::any_of(name.begin(), name.end(), [](char c) { return static_cast<unsigned char>(c) < 0x20 || c == 0x7F; })) {
    return false;
  }
  std::size_t start = 0;
  for (std::size_t i = 0; i <= name.size(); ++i) {
    if (i < name.size() && name[i] != '/' && name[i] != '\\') continue;
    if (name.substr(start, i - start) == "..") return false;
    start = i + 1;
  }
  return true;
}

}  // namespace

void ZipFile::Discard::operator()(zip* handle) const { zip_discard(handle); }

Result<ZipFile> ZipFile::open(std::string_view bytes, std::string name) {
  zip_error_t error;
  zip_error_init(&error);
  zip_source_t* whole = zip_source_buffer_create(bytes.data(), bytes.size(), 0, &error);
  ZipFile out;
  out.name_ = std::move(name);
  if (whole != nullptr) out.handle_.reset(zip_open_from_source(whole, ZIP_RDONLY, &error));
  if (!out.handle_) {
    if (whole != nullptr) zip_source_free(whole);
    std::string why = zip_error_strerror(&error);
    zip_error_fini(&error);
    return input_error(fmt::format("'{}' is no zip that can be read: {}", out.name_, why));
  }
  const auto count = static_cast<std::uint64_t>(std::max<zip_int64_t>(zip_get_num_entries(out.handle_.get(), 0), 0));
  if (count > kMostZipEntries) {
    return input_error(fmt::format("'{}' holds {} files (at most {})", out.name_, count, kMostZipEntries));
  }
  for (std::uint64_t i = 0; i < count; ++i) {
    zip_stat_t about;
    zip_stat_init(&about);
    if (zip_stat_index(out.handle_.get(), i, 0, &about) != 0 || about.name == nullptr) {
      return input_error(fmt::format("'{}' is harmed: its file {} has no name", out.name_, i + 1));
    }
    const std::string inside = about.name;
    if (!stays_inside(inside)) {
      return input_error(
          fmt::format("'{}' holds {}, which is no name of a file inside of it (a zip that was made to "
                      "harm?)",
                      out.name_, in_quotes(inside)));
    }
    if (!inside.ends_with('/')) out.entries_.push_back({inside, about.size, i});
  }
  return out;
}

Result<std::string> ZipFile::read(const Entry& entry, std::uint64_t most_bytes) const {
  const std::string file = name_ + "/" + entry.name;
  const std::unique_ptr<zip_file_t, int (*)(zip_file_t*)> stream(zip_fopen_index(handle_.get(), entry.index, 0),
                                                                 zip_fclose);
  if (!stream) {
    return input_error(fmt::format("{}: error: cannot be unpacked: {} (a zip that is whole, without a password)", file,
                                   zip_strerror(handle_.get())));
  }
  std::string out;
  std::vector<char> block(std::size_t{64} << 10U);
  for (;;) {
    const zip_int64_t got = zip_fread(stream.get(), block.data(), block.size());
    if (got < 0) return input_error(file + ": error: cannot be unpacked: its data are harmed (a zip that is whole)");
    if (got == 0) return out;
    if (out.size() + static_cast<std::uint64_t>(got) > most_bytes) {
      return input_error(fmt::format("{}: error: is more than {} bytes when unpacked", file, most_bytes));
    }
    out.append(block.data(), static_cast<std::size_t>(got));
  }
}

}  // namespace footlight::config

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "core/result.hpp"

struct zip;

namespace footlight::config {

/// A zip in memory, read entry by entry. Nothing is ever written to the disk, whatever entries are called.
class ZipFile {
 public:
  struct Entry {
    std::string name;        ///< as in the zip, UTF-8
    std::uint64_t size = 0;  ///< unpacked, as the zip says
    std::uint64_t index = 0;
  };

  /// @param bytes live as long as the zip  @param name for messages
  /// Errors: no zip; more than `kMostZipEntries`; an entry whose name is absolute, leads out by "..", or has
  /// characters of control. Folders are no entries.
  [[nodiscard]] static Result<ZipFile> open(std::string_view bytes, std::string name);

  [[nodiscard]] const std::vector<Entry>& entries() const { return entries_; }
  /// The unpacked bytes. Errors, as whole messages: harmed, encrypted, or more than `most_bytes`, whatever the zip said
  /// of its size; no more than that is ever unpacked.
  [[nodiscard]] Result<std::string> read(const Entry& entry, std::uint64_t most_bytes) const;

 private:
  struct Discard {
    void operator()(zip* handle) const;
  };
  std::string name_;
  std::unique_ptr<zip, Discard> handle_;
  std::vector<Entry> entries_;
};

inline constexpr std::uint64_t kMostZipEntries = 200'000;

}  // namespace footlight::config

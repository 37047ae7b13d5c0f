// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "core/result.hpp"
#include "core/show.hpp"

namespace footlight::app {

/// What somebody at the desk writes down about people.
struct Remark {
  enum class About : std::uint8_t { all, person, group, cell };
  About about = About::all;
  std::string whom;  ///< name of the person or group, or of the cell; empty: all
  std::string text;
};

[[nodiscard]] std::string_view to_text(Remark::About about);

/// Understands "Ana Ruiz too late", "trumpets straight lines", "B12 dark", "all smile", "person 7 turns left": a person
/// by id or name, a group, a cell or "all", then what there is to say. Who is not found by her first words is not
/// meant: then it is about all. Upper case does not matter.
/// Errors (ErrorKind::input): nothing is said; the name is one of a person and of a group, or it is a person's and a
/// cell's ("person" or "group" or "cell" before it decides); after such a word there is none of that name.
[[nodiscard]] Result<Remark> read_remark(const Show& show, const std::vector<std::string>& words);

}  // namespace footlight::app

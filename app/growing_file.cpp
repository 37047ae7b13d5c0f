// SPDX-License-Identifier: Apache-2.0
#include "app/growing_file.hpp"

#include <cerrno>
#include <cstdio>
#include <filesystem>
#include <system_error>
#include <utility>

#include <fmt/format.h>
#include <unistd.h>

namespace footlight::app {

GrowingFile::GrowingFile(std::string what, std::string file)
    : what_(std::move(what)), file_(std::move(file)), temporary_(fmt::format("{}.{}.part", file_, getpid())) {}

GrowingFile::~GrowingFile() {
  if (stream_.is_open()) stream_.close();
  std::error_code ignored;
  if (!kept_) std::filesystem::remove(temporary_, ignored);
}

Status<> GrowingFile::open() {
  stream_.open(temporary_, std::ios::binary | std::ios::trunc);
  if (!stream_) return failure();
  return Done{};
}

Status<> GrowingFile::keep() {
  stream_.close();
  if (!stream_ || std::rename(temporary_.c_str(), file_.c_str()) != 0) return failure();
  kept_ = true;
  return Done{};
}

Error GrowingFile::failure() const {
  return input_error(fmt::format("cannot write the {} '{}': {}", what_, file_, std::generic_category().message(errno)));
}

}  // namespace footlight::app

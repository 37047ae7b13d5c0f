// SPDX-License-Identifier: Apache-2.0
#include "app/speaking.hpp"

#include <string>
#include <utility>

#include <unistd.h>

#include "core/check.hpp"

namespace footlight::app {
namespace {

Speaking* speaking = nullptr;

WriterThread::Write to(int file) {
  return [file](std::string_view text) { return WriterThread::write_all(file, text); };
}

}  // namespace

Speaking::Speaking() : out_(to(STDOUT_FILENO)), err_(to(STDERR_FILENO)) {
  FL_CHECK(speaking == nullptr);
  (void)std::fflush(stdout);
  (void)std::fflush(stderr);
  speaking = this;
}

Speaking::~Speaking() { (void)end(); }

Status<> Speaking::end() {
  if (std::exchange(speaking, nullptr) == nullptr) return Done{};
  const bool all = out_.close();
  (void)err_.close();
  if (!all) return input_error("cannot write the result to stdout: nobody reads it");
  if (const std::string trouble = out_.trouble(); !trouble.empty()) {
    return input_error("cannot write the result to stdout: " + trouble);
  }
  return Done{};
}

bool Speaking::say(std::FILE* file, std::string_view text, WriterThread::Worth worth) {
  if (speaking != nullptr) return (file == stdout ? speaking->out_ : speaking->err_).put(std::string(text), worth);
  return std::fwrite(text.data(), 1, text.size(), file) == text.size();
}

void Speaking::end_now() {
  if (speaking != nullptr) (void)speaking->end();
}

std::uint64_t Speaking::lost() { return speaking == nullptr ? 0 : speaking->left_out(); }

}  // namespace footlight::app

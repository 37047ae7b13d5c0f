// SPDX-License-Identifier: Apache-2.0
#include "config/decode_job.hpp"

#include <cerrno>
#include <csignal>
#include <cstring>

#include <fmt/format.h>
#include <sys/stat.h>
#include <sys/wait.h>

namespace footlight::config {

namespace {

Error undecodable(const DecodeJob& job) {
  if (job.kind == DecodeJob::Kind::text) {
    return input_error(fmt::format("the text '{}' cannot be drawn (write it in UTF-8)", job.path));
  }
  return input_error(
      !job.still()
          ? fmt::format(
                "'{}' cannot be decoded as a video (a whole file is needed: MP4, MOV, Matroska, WebM, AVI, Ogg, "
                "GIF or MPEG, with a video stream)",
                job.path)
          : fmt::format(
                "'{}' cannot be decoded as an image (a whole file is needed: PNG, JPEG, BMP, PBM, PGM or SVG, of 1 "
                "to {} pixels)",
                job.path, job.limits.max_pixels));
}

/// A character as text; what is none as a question mark.
std::string utf8_of(std::int64_t code) {
  std::string out;
  const auto tail = [&](int shift) { out += static_cast<char>(0x80 | ((code >> shift) & 0x3F)); };
  if (code < 0x20 || code > 0x10FFFF) return "?";
  if (code < 0x80) {
    out = static_cast<char>(code);
  } else if (code < 0x800) {
    out = static_cast<char>(0xC0 | (code >> 6));
    tail(0);
  } else if (code < 0x10000) {
    out = static_cast<char>(0xE0 | (code >> 12));
    tail(6);
    tail(0);
  } else {
    out = static_cast<char>(0xF0 | (code >> 18));
    tail(12);
    tail(6);
    tail(0);
  }
  return out;
}

/// The child has ended without having said all. @param status its wait status
Error died(const DecodeJob& job, int status) {
  if (WIFSIGNALED(status) && WTERMSIG(status) == SIGXCPU) {
    return input_error(
        fmt::format("'{}' takes more than {:g} s to decode (a shorter range or a smaller frame size would "
                    "do)",
                    job.path, job.limits.max_seconds));
  }
  const std::string how = WIFSIGNALED(status)
                              ? fmt::format("by signal {} ({})", WTERMSIG(status), strsignal(WTERMSIG(status)))
                              : fmt::format("with status {}", WEXITSTATUS(status));
  return input_error(fmt::format("decoding '{}' ended {} (the file is broken, or needs more than {} MiB)", job.path,
                                 how, job.limits.max_memory_bytes >> 20U));
}

}  // namespace

Error refused_by_child(const DecodeJob& job, const DecodeRecord& said) {
  const std::string range =
      job.last ? fmt::format("frames {} to {}", job.first, *job.last) : fmt::format("frame {}", job.first);
  switch (said.status) {
    case DecodeStatus::ok:
    case DecodeStatus::undecodable:
      return undecodable(job);
    case DecodeStatus::no_pixels:
      return input_error(fmt::format("'{}' has frames of {} x {} pixels (at least 1 x 1 is needed)", job.path,
                                     said.width, said.height));
    case DecodeStatus::too_few_frames:
      return input_error(
          fmt::format("'{}' gives {} frame{} here (a video needs at least two; a single picture is an "
                      "image)",
                      job.path, said.count, said.count == 1 ? "" : "s"));
    case DecodeStatus::beyond_end:
      return input_error(fmt::format("'{}' has {} frames, {} {} beyond its end (frames count from 0, the last is {})",
                                     job.path, said.count, range, job.last ? "reach" : "is", said.count - 1));
    case DecodeStatus::too_many_pixels:
      return input_error(fmt::format("'{}' has frames of {} x {} pixels (at most {} pixels are allowed)", job.path,
                                     said.width, said.height, job.limits.max_pixels));
    case DecodeStatus::too_many_frames:
      return input_error(
          fmt::format("'{}' gives more than {} frames (choose a shorter range)", job.path, job.limits.max_frames));
    case DecodeStatus::too_much_memory:
      return input_error(fmt::format("'{}' needs more than {} MiB to decode (a smaller frame size would do)", job.path,
                                     job.limits.max_memory_bytes >> 20U));
    case DecodeStatus::size_changes:
      return input_error(fmt::format("'{}' changes its frame size at frame {} (all frames of a film have one size)",
                                     job.path, said.count));
    case DecodeStatus::unknown_font:
      return input_error(
          fmt::format("no font here is called '{}' (fc-list shows their names; as Noto Sans CJK SC Bold)", job.font));
    case DecodeStatus::missing_character:
      return input_error(fmt::format("{} has no character '{}' (U+{:04X}) (another font may have it)",
                                     job.font.empty() ? "no font here" : "the font '" + job.font + "'",
                                     utf8_of(said.count), said.count));
    case DecodeStatus::nothing_drawn:
      return input_error(fmt::format("nothing is drawn by '{}' (a drawing has a size and something in it)", job.path));
    case DecodeStatus::outside_reference:
      return input_error(
          fmt::format("'{}' refers to other files, which are not read (put everything into one)", job.path));
    case DecodeStatus::without_svg:
      return input_error(
          fmt::format("'{}' is an SVG drawing, and this footlight was built without librsvg (convert it to PNG, or "
                      "build with librsvg2-dev)",
                      job.path));
  }
  return undecodable(job);
}

Error nonsense(const DecodeJob& job, std::string_view what) {
  return input_error(
      fmt::format("decoding '{}' gave no usable film: {} (footlight and footlight-decode must be of one "
                  "version and the file whole)",
                  job.path, what));
}

bool known_refusal(const DecodeRecord& record) {
  return record.kind == DecodeRecord::Kind::end && record.status != DecodeStatus::ok &&
         record.status <= kLastDecodeStatus;
}

Status<> is_file(const std::string& path) {
  struct stat about {};
  if (stat(path.c_str(), &about) != 0) {
    return input_error(fmt::format("cannot read '{}': {}", path, std::strerror(errno)));
  }
  if (!S_ISREG(about.st_mode)) return input_error(fmt::format("'{}' is not a file", path));
  return Done{};
}

std::optional<Error> take_from(DecoderProcess& process, void* data, std::size_t size, const DecodeJob& job,
                               const Clock& clock, Instant deadline) {
  switch (process.read(data, size, clock, deadline, job.stop)) {
    case DecoderProcess::Read::all:
      return std::nullopt;
    case DecoderProcess::Read::end: {
      const int status = process.finish(false);
      if (WIFEXITED(status) && WEXITSTATUS(status) == 0) return nonsense(job, "it ends too early");
      return died(job, status);
    }
    case DecoderProcess::Read::stopped:
      return Error{ErrorKind::interrupted, fmt::format("interrupted while decoding '{}'", job.path)};
    case DecoderProcess::Read::late:
      break;
  }
  return input_error(
      fmt::format("'{}' takes more than {:g} s to decode (a shorter range or a smaller frame size would "
                  "do)",
                  job.path, 2 * job.limits.max_seconds));
}

std::optional<Error> wrong_end(const DecodeJob& job, const DecodeRecord& record, std::size_t frames) {
  if (known_refusal(record)) return refused_by_child(job, record);
  if (record.status == DecodeStatus::ok && record.count == static_cast<std::int64_t>(frames)) return std::nullopt;
  return nonsense(job, "it does not end as it should");
}

std::optional<Error> wrong_close(DecoderProcess& process, const DecodeJob& job, const Clock& clock, Instant deadline) {
  char more = 0;
  if (process.read(&more, 1, clock, deadline, job.stop) != DecoderProcess::Read::end) {
    return nonsense(job, "something follows its end");
  }
  const int status = process.finish(false);
  if (!WIFEXITED(status) || WEXITSTATUS(status) != 0) return died(job, status);
  return std::nullopt;
}

}  // namespace footlight::config

// SPDX-License-Identifier: Apache-2.0
#include "config/media.hpp"

#include <cmath>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "config/decode_job.hpp"
#include "config/decode_protocol.hpp"
#include "config/decoder_process.hpp"
#include "core/clock.hpp"

namespace footlight::config {
namespace {

using Job = DecodeJob;

std::vector<std::string> arguments_of(const Job& job) {
  // An absolute path cannot be taken for a protocol.
  return {job.video ? "video" : "image",
          std::filesystem::absolute(job.path).string(),
          std::to_string(job.first),
          std::to_string(job.last.value_or(-1)),
          std::to_string(job.picture.threshold.value_or(-1)),
          job.picture.invert ? "1" : "0",
          std::to_string(job.limits.max_pixels),
          std::to_string(job.limits.max_frames),
          std::to_string(static_cast<long>(std::ceil(job.limits.max_seconds))),
          std::to_string(job.limits.max_memory_bytes)};
}

/// The child's stream, believed in nothing.
class FilmReader {
 public:
  FilmReader(const Job& job, DecoderProcess& process)
      : job_(job), process_(process), deadline_(clock_.now() + seconds(2 * job.limits.max_seconds)) {}

  Result<Film> read() {
    DecodeRecord record;
    if (auto bad = take(&record, sizeof record)) return *std::move(bad);
    if (auto bad = start(record)) return *std::move(bad);
    while (true) {
      if (auto bad = take(&record, sizeof record)) return *std::move(bad);
      if (record.kind == DecodeRecord::Kind::end) break;
      if (auto bad = frame(record)) return *std::move(bad);
    }
    if (auto bad = wrong_end(job_, record, film_.frames.size())) return *std::move(bad);
    if (film_.frames.size() < (job_.video ? 2U : 1U) || (job_.last && wanted() != film_.frames.size())) {
      return nonsense(job_, "frames are missing");
    }
    if (auto bad = wrong_close(process_, job_, clock_, deadline_)) return *std::move(bad);
    return std::move(film_);
  }

 private:
  [[nodiscard]] std::size_t wanted() const { return static_cast<std::size_t>(*job_.last - job_.first) + 1; }

  std::optional<Error> take(void* data, std::size_t size) {
    return take_from(process_, data, size, job_, clock_, deadline_);
  }

  std::optional<Error> start(const DecodeRecord& record) {
    if (known_refusal(record)) return refused_by_child(job_, record);
    if (record.kind != DecodeRecord::Kind::film || record.status != DecodeStatus::ok) {
      return nonsense(job_, "it does not begin as it should");
    }
    if (record.width < 1 || record.height < 1 || record.width > job_.limits.max_pixels / record.height) {
      return nonsense(job_, "its frame size is out of range");
    }
    if (record.threshold < 0 || record.threshold > 255 ||
        record.threshold != job_.picture.threshold.value_or(record.threshold)) {
      return nonsense(job_, "its threshold is not the one asked for");
    }
    film_.width = record.width;
    film_.height = record.height;
    film_.fps = std::isfinite(record.fps) && record.fps > 0 && record.fps < 1e6 ? record.fps : 0;
    film_.first_frame = job_.first;
    film_.threshold = record.threshold;
    film_.inverted = job_.picture.invert;
    return std::nullopt;
  }

  std::optional<Error> frame(const DecodeRecord& record) {
    const auto number = static_cast<std::int64_t>(film_.frames.size()) + (job_.video ? job_.first : 0);
    if (record.kind != DecodeRecord::Kind::frame || record.status != DecodeStatus::ok || record.count != number ||
        (job_.last && number > *job_.last) || film_.frames.size() >= static_cast<std::size_t>(job_.limits.max_frames)) {
      return nonsense(job_, "a frame is out of order");
    }
    Mask mask(film_.width, film_.height);
    bytes_ += mask.words().size() * sizeof(std::uint64_t);
    if (bytes_ > job_.limits.max_memory_bytes) {
      return input_error(
          fmt::format("'{}' needs more than {} MiB for its frames (choose a shorter range or a smaller "
                      "frame size)",
                      job_.path, job_.limits.max_memory_bytes >> 20U));
    }
    if (auto bad = take(mask.words().data(), mask.words().size() * sizeof(std::uint64_t))) return bad;
    if (film_.width % 64 != 0) {
      const std::uint64_t unused = ~std::uint64_t{0} << static_cast<unsigned>(film_.width % 64);
      const auto row = static_cast<std::size_t>(mask.row_words());
      for (std::size_t last = row - 1; last < mask.words().size(); last += row) {
        if ((mask.words()[last] & unused) != 0) return nonsense(job_, "a frame has pixels outside of itself");
      }
    }
    film_.frames.push_back(std::move(mask));
    return std::nullopt;
  }

  const Job& job_;
  DecoderProcess& process_;
  SteadyClock clock_;
  Instant deadline_;
  Film film_;
  std::size_t bytes_ = 0;
};

Result<Film> decode(const Job& job) {
  if (auto there = is_file(job.path); !there) return there.error();
  auto process = DecoderProcess::start(arguments_of(job), job.limits.max_pixels);
  if (!process) return std::move(process).error();
  return FilmReader(job, *process).read();
}

}  // namespace

Result<Film> decode_video(const VideoSource& source, const MediaLimits& limits, const std::atomic<bool>* stop) {
  if (source.first_frame < 0 || (source.last_frame && *source.last_frame <= source.first_frame)) {
    return input_error(fmt::format("frames {} to {} are no range (the first is at least 0, the last comes after it)",
                                   source.first_frame, source.last_frame.value_or(-1)));
  }
  return decode({source.path, true, source.first_frame, source.last_frame, source.picture, limits, stop});
}

Result<Film> decode_image(const ImageSource& source, const MediaLimits& limits, const std::atomic<bool>* stop) {
  return decode({source.path, false, 0, std::nullopt, source.picture, limits, stop});
}

}  // namespace footlight::config

// SPDX-License-Identifier: Apache-2.0
#include "config/media.hpp"

#include <algorithm>
#include <array>
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
  constexpr std::array kKinds{"video", "image", "painting", "text"};
  std::string extra = job.font;
  if (const auto& range = job.picture.colour) extra = to_text(range->from).substr(1) + to_text(range->to).substr(1);
  // An absolute path cannot be taken for a protocol.
  return {kKinds.at(static_cast<std::size_t>(job.kind)),
          job.kind == Job::Kind::text ? job.path : std::filesystem::absolute(job.path).string(),
          std::to_string(job.first),
          std::to_string(job.last.value_or(-1)),
          std::to_string(job.picture.threshold.value_or(-1)),
          job.picture.invert ? "1" : "0",
          std::to_string(job.limits.max_pixels),
          std::to_string(job.limits.max_frames),
          std::to_string(static_cast<long>(std::ceil(job.limits.max_seconds))),
          std::to_string(job.limits.max_memory_bytes),
          extra};
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
      auto bad = job_.kind == Job::Kind::painting ? painting(record) : frame(record);
      if (bad) return *std::move(bad);
    }
    const std::size_t frames = film_.frames.size() + (film_.rgb.empty() ? 0 : 1);
    if (auto bad = wrong_end(job_, record, frames)) return *std::move(bad);
    if (frames < (job_.still() ? 1U : 2U) || (job_.last && wanted() != film_.frames.size())) {
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

  std::optional<Error> painting(const DecodeRecord& record) {
    if (record.kind != DecodeRecord::Kind::painting || record.status != DecodeStatus::ok || !film_.rgb.empty()) {
      return nonsense(job_, "it is no painting");
    }
    film_.rgb.resize(3 * static_cast<std::size_t>(film_.width) * static_cast<std::size_t>(film_.height));
    return take(film_.rgb.data(), film_.rgb.size());
  }

  std::optional<Error> frame(const DecodeRecord& record) {
    const auto number = static_cast<std::int64_t>(film_.frames.size()) + (job_.still() ? 0 : job_.first);
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

/// A single picture that takes longer was made to take long.
constexpr double kMostStillSeconds = 60;

Result<Film> decode(Job job) {
  if (job.still()) job.limits.max_seconds = std::min(job.limits.max_seconds, kMostStillSeconds);
  if (job.kind != Job::Kind::text) {
    if (auto there = is_file(job.path); !there) return there.error();
  }
  auto process = DecoderProcess::start(arguments_of(job), job.limits.max_pixels);
  if (!process) return std::move(process).error();
  return FilmReader(job, *process).read();
}

/// The picture in a larger frame, at its upper left corner.
Mask in_frame(const Mask& picture, int width, int height) {
  Mask out(width, height);
  for (int y = 0; y < picture.height(); ++y) {
    const auto row = static_cast<std::size_t>(y);
    const auto from =
        picture.words().begin() + static_cast<std::ptrdiff_t>(row * static_cast<std::size_t>(picture.row_words()));
    std::copy(from, from + picture.row_words(),
              out.words().begin() + static_cast<std::ptrdiff_t>(row * static_cast<std::size_t>(out.row_words())));
  }
  return out;
}

}  // namespace

Result<Film> decode_video(const VideoSource& source, const MediaLimits& limits, const std::atomic<bool>* stop) {
  if (source.first_frame < 0 || (source.last_frame && *source.last_frame <= source.first_frame)) {
    return input_error(fmt::format("frames {} to {} are no range (the first is at least 0, the last comes after it)",
                                   source.first_frame, source.last_frame.value_or(-1)));
  }
  return decode({source.path, Job::Kind::video, source.first_frame, source.last_frame, source.picture, limits, stop});
}

Result<Film> decode_image(const ImageSource& source, const MediaLimits& limits, const std::atomic<bool>* stop) {
  return decode({source.path, Job::Kind::image, 0, std::nullopt, source.picture, limits, stop});
}

Result<Film> decode_painting(const PaintingSource& source, const MediaLimits& limits, const std::atomic<bool>* stop) {
  return decode({source.path, Job::Kind::painting, 0, std::nullopt, {}, limits, stop});
}

Result<Film, PartFailure> decode_parts(const PartsSource& source, const MediaLimits& limits,
                                       const std::atomic<bool>* stop) {
  Film all;
  std::size_t bytes = 0;
  for (std::size_t k = 0; k < source.parts->size(); ++k) {
    const Part& part = (*source.parts)[k];
    if (!part.needs_picture()) continue;
    const auto* lettering = std::get_if<Lettering>(&part.drawing);
    const auto* picture = std::get_if<Picture>(&part.drawing);
    auto film = lettering != nullptr
                    ? decode({lettering->text, Job::Kind::text, 0, std::nullopt, {}, limits, stop, lettering->font})
                    : decode({picture->path, Job::Kind::image, 0, std::nullopt, picture->options, limits, stop});
    if (!film) return PartFailure{k, film.error()};
    all.width = std::max(all.width, film->width);
    all.height = std::max(all.height, film->height);
    all.frames.push_back(std::move(film->frames.front()));
    bytes =
        all.frames.size() * static_cast<std::size_t>((all.width + 63) / 64 * 8) * static_cast<std::size_t>(all.height);
    if (bytes > limits.max_memory_bytes) {
      return PartFailure{k, input_error(fmt::format("the pictures of all parts need more than {} MiB (smaller ones do)",
                                                    limits.max_memory_bytes >> 20U))};
    }
  }
  for (Mask& frame : all.frames) frame = in_frame(frame, all.width, all.height);
  return all;
}

}  // namespace footlight::config

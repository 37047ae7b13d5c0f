// SPDX-License-Identifier: Apache-2.0
#include "config/lamp_film.hpp"

#include <cmath>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <utility>

#include "config/decode_job.hpp"
#include "core/check.hpp"

namespace footlight::config {
namespace {

constexpr double kMostSeconds = 1e6;  // of a film
constexpr float kMostLight = 256;

std::vector<std::string> arguments_of(const DecodeJob& job, const SpotSearch& search) {
  return {"lamps",
          std::filesystem::absolute(job.path).string(),
          "0",
          "-1",
          std::to_string(std::lround(search.radius * 1e6)),
          std::to_string(search.most_spots),
          std::to_string(job.limits.max_pixels),
          std::to_string(job.limits.max_frames),
          std::to_string(static_cast<long>(std::ceil(job.limits.max_seconds))),
          std::to_string(job.limits.max_memory_bytes),
          ""};
}

/// The child's stream, believed in nothing.
class LampReader {
 public:
  LampReader(const DecodeJob& job, const SpotSearch& search, DecoderProcess& process)
      : job_(job), search_(search), process_(process), deadline_(clock_.now() + seconds(2 * job.limits.max_seconds)) {}

  Result<LampFilm> read() {
    DecodeRecord record;
    if (auto bad = take(&record, sizeof record)) return *std::move(bad);
    if (known_refusal(record)) return refused_by_child(job_, record);
    if (record.kind != DecodeRecord::Kind::film || record.width < 1 || record.height < 1 ||
        record.width > job_.limits.max_pixels / record.height) {
      return nonsense(job_, "it does not begin as it should");
    }
    film_.width = record.width;
    film_.height = record.height;
    even_fps_ = std::isfinite(record.fps) && record.fps > 0 && record.fps < 1e4 ? record.fps : 0;
    while (true) {
      if (auto bad = take(&record, sizeof record)) return *std::move(bad);
      if (record.kind == DecodeRecord::Kind::end) break;
      if (auto bad = frame(record)) return *std::move(bad);
    }
    if (auto bad = wrong_end(job_, record, film_.frames.size())) return *std::move(bad);
    if (auto bad = wrong_close(process_, job_, clock_, deadline_)) return *std::move(bad);
    return std::move(film_);
  }

 private:
  std::optional<Error> take(void* data, std::size_t size) {
    return take_from(process_, data, size, job_, clock_, deadline_);
  }

  std::optional<Error> frame(const DecodeRecord& record) {
    if (record.kind != DecodeRecord::Kind::spots || record.status != DecodeStatus::ok || record.count < 0 ||
        record.count > search_.most_spots || film_.frames.size() >= static_cast<std::size_t>(job_.limits.max_frames)) {
      return nonsense(job_, "a frame is out of order");
    }
    LampFrame frame;
    frame.spots.resize(static_cast<std::size_t>(record.count));
    bytes_ += frame.spots.size() * sizeof(LightSpot);
    if (bytes_ > job_.limits.max_memory_bytes) return nonsense(job_, "it has too many spots");
    if (auto bad = take(frame.spots.data(), frame.spots.size() * sizeof(LightSpot))) return bad;
    for (const LightSpot& spot : frame.spots) {
      const bool inside = spot.x >= 0 && spot.x <= static_cast<float>(film_.width) && spot.y >= 0 &&
                          spot.y <= static_cast<float>(film_.height);
      if (!inside || !(spot.light >= 0 && spot.light <= kMostLight)) return nonsense(job_, "a spot is out of range");
    }
    // A file whose frames have no instants of their own has them at an even rate.
    const double before = film_.frames.empty() ? -1 : film_.frames.back().time_s;
    frame.time_s = record.fps;
    const bool ascends = std::isfinite(record.fps) && record.fps > before && record.fps < kMostSeconds;
    if (!ascends) {
      if (even_fps_ <= 0) return nonsense(job_, "its frames have no instants");
      frame.time_s = film_.frames.empty() ? 0 : before + 1 / even_fps_;
    }
    film_.frames.push_back(std::move(frame));
    return std::nullopt;
  }

  const DecodeJob& job_;
  const SpotSearch& search_;
  DecoderProcess& process_;
  SteadyClock clock_;
  Instant deadline_;
  LampFilm film_;
  double even_fps_ = 0;
  std::size_t bytes_ = 0;
};

}  // namespace

Result<LampFilm> decode_lamps(const std::string& path, const SpotSearch& search, const MediaLimits& limits,
                              const std::atomic<bool>* stop) {
  FL_CHECK(search.radius >= 0.0002 && search.radius <= 0.05 && search.most_spots >= 1 && search.most_spots <= 65'536);
  const DecodeJob job{path, DecodeJob::Kind::lamps, 0, std::nullopt, {}, limits, stop};
  if (auto there = is_file(path); !there) return there.error();
  auto process = DecoderProcess::start(arguments_of(job, search), limits.max_pixels);
  if (!process) return std::move(process).error();
  return LampReader(job, search, *process).read();
}

}  // namespace footlight::config

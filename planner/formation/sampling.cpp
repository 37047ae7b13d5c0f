// SPDX-License-Identifier: Apache-2.0
#include "planner/formation/sampling.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>

namespace footlight::planner {
namespace {

constexpr int kBlocks = 8;

/// Set bits of one row in [x0, x1).
std::int64_t row_area(const std::uint64_t* row, int x0, int x1) {
  std::int64_t sum = 0;
  for (int x = x0; x < x1;) {
    const int bit = x % 64;
    const int taken = std::min(64 - bit, x1 - x);
    const std::uint64_t mask = taken == 64 ? ~std::uint64_t{0} : ((std::uint64_t{1} << taken) - 1) << bit;
    sum += std::popcount(row[x / 64] & mask);
    x += taken;
  }
  return sum;
}

/// The frame that is on show at a count, and the instants around it.
class FilmClock {
 public:
  FilmClock(const Film& film, const FilmTime& time)
      : tempo_(*time.tempo),
        start_(tempo_.at(time.start_count)),
        fps_(show_fps(film, time)),
        last_(static_cast<int>(film.frames.size()) - 1) {}

  [[nodiscard]] Instant at_frame(int frame) const { return start_ + seconds(frame / fps_); }
  [[nodiscard]] int frame_at(Instant instant) const {
    return static_cast<int>(std::clamp(std::round(to_seconds(instant - start_) * fps_), 0.0, double(last_)));
  }
  [[nodiscard]] KeyFrame key_at_count(double count) const {
    const Instant instant = tempo_.at(count);
    return {frame_at(instant), count, instant};
  }
  [[nodiscard]] KeyFrame key_at_frame(int frame) const {
    const Instant instant = at_frame(frame);
    return {frame, tempo_.count_at(instant), instant};
  }
  /// The first whole count that shows a frame; the last one before `latest` where it lies beyond.
  [[nodiscard]] KeyFrame key_on_count(int frame, Instant earliest, Instant latest) const {
    double count = std::ceil(tempo_.count_at(at_frame(frame)) - 1e-6);
    if (tempo_.at(count) > latest) count = std::floor(tempo_.count_at(latest) + 1e-6);
    if (tempo_.at(count) < earliest) count = std::ceil(tempo_.count_at(earliest) - 1e-6);
    return key_at_count(count);
  }

 private:
  const TempoMap& tempo_;
  Instant start_;
  double fps_;
  int last_;
};

}  // namespace

std::uint64_t average_hash(const Mask& mask) {
  std::array<std::int64_t, kBlocks * kBlocks> picture{};
  std::array<std::int64_t, kBlocks * kBlocks> size{};
  std::int64_t total = 0;
  for (int y = 0; y < mask.height(); ++y) {
    const auto* row = mask.words().data() + static_cast<std::size_t>(y) * static_cast<std::size_t>(mask.row_words());
    const int block_row = y * kBlocks / mask.height();
    for (int block = 0; block < kBlocks; ++block) {
      const int x0 = block * mask.width() / kBlocks;
      const int x1 = (block + 1) * mask.width() / kBlocks;
      const std::size_t at = static_cast<std::size_t>(block_row * kBlocks + block);
      const std::int64_t here = row_area(row, x0, x1);
      picture[at] += here;
      size[at] += x1 - x0;
      total += here;
    }
  }
  const std::int64_t pixels = std::int64_t{mask.width()} * mask.height();
  std::uint64_t hash = 0;
  for (std::size_t i = 0; i < picture.size(); ++i) {
    if (picture[i] * pixels > total * size[i]) hash |= std::uint64_t{1} << i;
  }
  return hash;
}

double show_fps(const Film& film, const FilmTime& time) {
  const double duration_s = to_seconds(time.tempo->span(time.start_count, time.duration_counts));
  return (static_cast<double>(film.frames.size()) - 1) / duration_s;
}

namespace {

/// Appends what is sampled from the last key on, and `end`.
void sample_until(const KeyFrame& end, const Film& film, const FilmClock& clock, const Sampling& sampling,
                  Duration shortest, std::vector<KeyFrame>& keys) {
  std::uint64_t last_hash = average_hash(film.frames[static_cast<std::size_t>(keys.back().frame)]);
  for (int f = keys.back().frame + 1; f < end.frame; ++f) {
    const KeyFrame& last = keys.back();
    const Instant now = clock.at_frame(f);
    if (now < last.time + shortest) continue;
    const bool changed =
        std::popcount(average_hash(film.frames[static_cast<std::size_t>(f)]) ^ last_hash) > sampling.hash * 64;
    if (!changed && clock.at_frame(f + 1) <= last.time + sampling.interval) continue;
    const KeyFrame key = sampling.snap_to_count
                             ? clock.key_on_count(f, last.time + shortest, last.time + sampling.interval)
                             : clock.key_at_frame(f);
    if (key.time + shortest > end.time) break;
    keys.push_back(key);
    last_hash = average_hash(film.frames[static_cast<std::size_t>(key.frame)]);
    f = std::max(f, key.frame);
  }
  keys.push_back(end);
}

}  // namespace

std::vector<KeyFrame> sample(const Film& film, const FilmTime& time, const Sampling& sampling, double shortest_s,
                             std::span<const KeyFrame> given) {
  FL_CHECK(film.frames.size() >= 2 && time.duration_counts > 0);
  const FilmClock clock(film, time);
  const Duration shortest = std::max(std::min(seconds(shortest_s), sampling.interval), milliseconds(1));
  const KeyFrame end{static_cast<int>(film.frames.size()) - 1, time.start_count + time.duration_counts,
                     time.tempo->at(time.start_count + time.duration_counts)};
  std::vector<KeyFrame> keys{{0, time.start_count, time.tempo->at(time.start_count)}};
  for (const KeyFrame& key : given) {
    if (key.time > keys.back().time && key.time < end.time) {
      sample_until(key, film, clock, sampling, shortest, keys);
    } else if (key.time == keys.back().time) {
      keys.back().given = true;
    }
  }
  sample_until(end, film, clock, sampling, shortest, keys);
  keys.back().given = !given.empty() && given.back().time == end.time;
  return keys;
}

std::vector<KeyFrame> with_given(const std::vector<KeyFrame>& sampled, std::span<const KeyFrame> given,
                                 double shortest_s) {
  std::vector<KeyFrame> out;
  std::size_t next = 0;
  const auto near = [&](const KeyFrame& key, const KeyFrame& one) {
    return std::abs(to_seconds(key.time - one.time)) < shortest_s;
  };
  for (const KeyFrame& key : sampled) {
    for (; next < given.size() && given[next].time < key.time; ++next) {
      if (given[next].time > out.back().time) out.push_back(given[next]);
    }
    const bool same = next < given.size() && given[next].time == key.time;
    const bool crowded = (next < given.size() && near(given[next], key)) || (next > 0 && near(given[next - 1], key));
    const bool end = key == sampled.front() || key == sampled.back();
    if (!same && crowded && !end) continue;
    out.push_back(key);
    out.back().given = same;
  }
  return out;
}

std::optional<KeyFrame> given_key(const Film& film, const FilmTime& time, const SectionKey& key) {
  const FilmClock clock(film, time);
  const double end = time.start_count + time.duration_counts;
  KeyFrame out;
  if (key.count) {
    if (*key.count < time.start_count || *key.count > end + 1e-6) return std::nullopt;
    out = clock.key_at_count(std::min(*key.count, end));
  } else {
    const double frame = std::round(key.film_s * film.fps) - film.first_frame;
    if (frame < 0 || frame >= static_cast<double>(film.frames.size())) return std::nullopt;
    out = clock.key_at_frame(static_cast<int>(frame));
  }
  out.given = true;
  return out;
}

}  // namespace footlight::planner

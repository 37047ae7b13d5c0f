// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "core/film.hpp"
#include "core/show.hpp"

namespace footlight::planner {

/// Average hash: the mask in 8 x 8 blocks, a bit for each block that holds more picture than the mean. A blank and a
/// full mask give 0. O(pixels / 64)
[[nodiscard]] std::uint64_t average_hash(const Mask& mask);

/// A frame that becomes a formation, and when.
struct KeyFrame {
  int frame = 0;  ///< index into Film::frames
  double count = 1;
  Instant time;
  bool given = false;  ///< by the director, so that it is exact

  friend bool operator==(const KeyFrame&, const KeyFrame&) = default;
};

/// Where a film lies in the show.
struct FilmTime {
  double start_count = 1;
  double duration_counts = 0;  ///< > 0; the first frame at its start, the last at its end
  const TempoMap* tempo = nullptr;
};

/// Frames per second of show after stretching: (frames - 1) / duration.
[[nodiscard]] double show_fps(const Film& film, const FilmTime& time);

/// Key frames of a film, Li 2020 Eq. 3-4: the next one is the first frame whose average hash differs from the last key
/// frame's in more than `sampling.hash` of its bits, or the one `sampling.interval` of show time later, whichever comes
/// first. The first and the last frame are key frames; the others stand on whole counts when asked for.
/// @param given the director's key frames, ascending: from each of them sampling begins anew
/// @param film at least two frames  @param shortest_s no two key frames are nearer than this (or than the sampling
/// interval), so that people can walk at all; a section shorter than that has two key frames
/// @return ascending, at least two. O(pixels of the film / 64)
[[nodiscard]] std::vector<KeyFrame> sample(const Film& film, const FilmTime& time, const Sampling& sampling,
                                           double shortest_s, std::span<const KeyFrame> given = {});

/// Puts the director's key frames among sampled ones, in place of those nearer than `shortest_s` to one of them; the
/// first and the last stay. @param sampled, given ascending
[[nodiscard]] std::vector<KeyFrame> with_given(const std::vector<KeyFrame>& sampled, std::span<const KeyFrame> given,
                                               double shortest_s);

/// The key frame at an instant that the director named. Nothing when the film is not on show then.
[[nodiscard]] std::optional<KeyFrame> given_key(const Film& film, const FilmTime& time, const SectionKey& key);

}  // namespace footlight::planner

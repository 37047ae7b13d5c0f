// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "core/film.hpp"
#include "core/result.hpp"
#include "core/show.hpp"

namespace footlight::config {

/// Bounds of the child process that decodes; a file that needs more is refused.
struct MediaLimits {
  int max_pixels = 4096 * 4096;
  int max_frames = 200'000;
  double max_seconds = 600;  ///< processor time of the child
  std::size_t max_memory_bytes = std::size_t{2} << 30;
};

/// Decodes and thresholds a video in a child process (`footlight-decode`, only the file protocol, listed containers),
/// which a broken or hostile file may kill without harm. With no threshold given, Otsu's over all pixels of the range
/// decides. Errors (ErrorKind::input, without position; the caller adds it): missing, undecodable, frame size 0, fewer
/// than two frames, range beyond the end, more than the limits.
[[nodiscard]] Result<Film> decode_video(const VideoSource& source, const MediaLimits& limits = {});
/// The same for one image (PNG, JPEG, BMP, PBM, PGM; alpha counts as dark): a film of one frame.
[[nodiscard]] Result<Film> decode_image(const ImageSource& source, const MediaLimits& limits = {});

}  // namespace footlight::config

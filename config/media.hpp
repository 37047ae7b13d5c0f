// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <cstddef>

#include "core/film.hpp"
#include "core/result.hpp"
#include "core/show.hpp"

namespace footlight::config {

/// Bounds of the child process that decodes; a file that needs more is refused.
struct MediaLimits {
  int max_pixels = 4096 * 4096;
  int max_frames = 200'000;
  double max_seconds = 600;                             ///< processor time of the child; twice that by the clock
  std::size_t max_memory_bytes = std::size_t{2} << 30;  ///< of the child, and of the film that it sends
};

/// Decodes and thresholds a video in a child process (`footlight-decode`: only the file protocol, listed containers),
/// which a broken or hostile file may kill without harm; what it sends is checked like any other input. With no
/// threshold given, Otsu's over all pixels of the range decides. Every frame of the range is kept, one bit a pixel.
/// The program is found by the environment's FOOTLIGHT_DECODER, else beside this program, else in the build tree.
/// @param stop  polled ten times a second; when it becomes true: ErrorKind::interrupted
/// Errors (ErrorKind::input, without position; the caller adds it): missing, undecodable, frame size 0, fewer than two
/// frames, range beyond the end, more than the limits; ErrorKind::internal when the child cannot be started.
/// Thread: reentrant. Hot path: no.
[[nodiscard]] Result<Film> decode_video(const VideoSource& source, const MediaLimits& limits = {},
                                        const std::atomic<bool>* stop = nullptr);
/// The same for one image (PNG, JPEG, BMP, PBM, PGM; what is transparent counts as dark): a film of one frame.
[[nodiscard]] Result<Film> decode_image(const ImageSource& source, const MediaLimits& limits = {},
                                        const std::atomic<bool>* stop = nullptr);

}  // namespace footlight::config

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <cstddef>

#include "core/film.hpp"
#include "core/parts.hpp"
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
/// The same for one image (PNG, JPEG, BMP, PBM, PGM; what is transparent counts as dark; or an SVG drawing, in which
/// whatever is drawn is the picture): a film of one frame. A single picture has at most a minute.
[[nodiscard]] Result<Film> decode_image(const ImageSource& source, const MediaLimits& limits = {},
                                        const std::atomic<bool>* stop = nullptr);

/// A painting in colours (PNG, JPEG, BMP, SVG): Film::rgb and no frames.
[[nodiscard]] Result<Film> decode_painting(const PaintingSource& source, const MediaLimits& limits = {},
                                           const std::atomic<bool>* stop = nullptr);

/// Which part could not be decoded, and why.
struct PartFailure {
  std::size_t part = 0;
  Error error;
};
/// A frame for each part that is a picture or lettering, in their order, each at the upper left of a frame that is
/// large enough for all. Lettering is laid out by Pango in the child, too. Errors, besides those of an image: no such
/// font; a character that the font has not, named; an SVG drawing that refers to other files, which are not read.
[[nodiscard]] Result<Film, PartFailure> decode_parts(const PartsSource& source, const MediaLimits& limits = {},
                                                     const std::atomic<bool>* stop = nullptr);

}  // namespace footlight::config

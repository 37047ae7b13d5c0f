// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <type_traits>

namespace footlight::config {

/// What the child program says about a file.
enum class DecodeStatus : std::uint32_t {
  ok,
  undecodable,
  no_pixels,        ///< width x height, one of them 0
  too_few_frames,   ///< `count` of them
  beyond_end,       ///< the file has `count` frames
  too_many_pixels,  ///< width x height
  too_many_frames,  ///< more than the limit
  too_much_memory,
  size_changes,       ///< at frame `count`
  unknown_font,       ///< no font of that family
  missing_character,  ///< the font has none for code point `count`
  nothing_drawn,      ///< a text or a drawing of no extent
  outside_reference,  ///< an SVG drawing that asks for another file
  without_svg,        ///< built without the library that reads SVG
};
inline constexpr auto kLastDecodeStatus = DecodeStatus::without_svg;

/// The stream from `footlight-decode` to its parent on one machine: one record `film`, then a record `frame` with its
/// picture for each frame, then one record `end`. A file that cannot be decoded gives `end` at once or in the middle.
/// A film of lamps has records `spots` instead of frames, each followed by `count` LightSpots (config/lamp_film.hpp).
/// A painting has one record `painting` instead, followed by width x height x 3 bytes.
/// A picture is height x ceil(width / 64) words of 64 bits as in core/film.hpp. Numbers in the machine's own order.
struct DecodeRecord {
  enum class Kind : std::uint32_t {
    film = 0x4D4C4946,
    frame = 0x4D415246,
    painting = 0x544E4950,
    spots = 0x544F5053,
    end = 0x20444E45
  };
  Kind kind = Kind::end;
  DecodeStatus status = DecodeStatus::ok;
  std::int32_t width = 0;      ///< pixels
  std::int32_t height = 0;     ///< pixels
  std::int32_t threshold = 0;  ///< given or found
  std::int32_t reserved = 0;
  std::int64_t count = 0;  ///< frame: number in the file; spots: how many; end: frames sent, or as the status says
  double fps = 0;          ///< 0 for an image; spots: the frame's instant in s
};
static_assert(std::is_trivially_copyable_v<DecodeRecord> && sizeof(DecodeRecord) == 40);

}  // namespace footlight::config

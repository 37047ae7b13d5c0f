// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "core/result.hpp"
#include "core/time.hpp"

namespace footlight::app {

/// One channel of sound, as it comes.
class SoundInput {
 public:
  struct Piece {
    std::vector<float> samples{};
    Instant ends{};         ///< when the sample after the last one sounds
    bool gap = false;       ///< something before it was lost
    bool over = false;      ///< nothing more will come
    std::string trouble{};  ///< why; told once
  };
  virtual ~SoundInput() = default;
  [[nodiscard]] virtual int sample_rate() const = 0;  ///< Hz, 8,000 to 192,000
  /// What has come until now. Does not block.
  virtual Piece read(Instant now) = 0;
};

/// A file of any kind that libsndfile reads (WAV, FLAC, MP3 ...), its first channel, played from the first `read` on.
/// Errors: ErrorKind::input.
[[nodiscard]] Result<std::unique_ptr<SoundInput>> open_sound_file(const std::filesystem::path& file);
/// The first channel of an input of the machine ("hw:1,0", "default"), at 48 kHz. Errors: ErrorKind::device: there is
/// none, it is not ours to open, or a program built without ALSA.
[[nodiscard]] Result<std::unique_ptr<SoundInput>> open_alsa_input(const std::string& device);

}  // namespace footlight::app

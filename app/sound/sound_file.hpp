// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <span>
#include <string>

#include "app/sound/samples.hpp"
#include "core/result.hpp"

namespace footlight::app {

/// A WAV file (16 bits, one channel, kSampleRate) that is written as it comes; a program that is killed leaves what it
/// has written. By libsndfile; built without it every file is refused, with the reason.
class SoundFile {
 public:
  [[nodiscard]] static Result<SoundFile> create(const std::string& file);
  /// Any format that libsndfile reads; several channels become one.
  [[nodiscard]] static Result<Samples> read(const std::string& file);

  SoundFile(SoundFile&&) noexcept;
  SoundFile& operator=(SoundFile&&) noexcept;
  ~SoundFile();
  Status<> write(std::span<const float> samples);

 private:
  struct Open;
  explicit SoundFile(std::unique_ptr<Open> open);
  std::unique_ptr<Open> open_;
};

}  // namespace footlight::app

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <span>
#include <string>

#include <sys/types.h>

#include "core/result.hpp"

namespace footlight::app {

/// A video file that comes into being whole or not at all, made by the program `ffmpeg` (a process of its own: its
/// libraries are under other licences). Frames are piped to it.
class VideoWriter {
 public:
  struct Shape {
    int width = 0;   ///< pixels, even
    int height = 0;  ///< pixels, even
    double rate = 25;
    std::string title;
    std::string comment;
  };
  /// Begins an H.264 film in an MP4 file. Errors: ffmpeg is not installed; it cannot be begun.
  static Result<VideoWriter> open(const std::filesystem::path& file, const Shape& shape);
  VideoWriter(VideoWriter&& other) noexcept;
  VideoWriter& operator=(VideoWriter&&) = delete;
  VideoWriter(const VideoWriter&) = delete;
  VideoWriter& operator=(const VideoWriter&) = delete;
  /// A film that was not finished leaves nothing.
  ~VideoWriter();

  /// @param planar as `to_planar` makes it. Errors: ffmpeg has given up, with what it said.
  [[nodiscard]] Status<> write(std::span<const unsigned char> planar);
  /// Ends the film, and gives it its name.
  [[nodiscard]] Status<> finish();

 private:
  VideoWriter(std::filesystem::path file, std::filesystem::path temporary);
  [[nodiscard]] std::string last_said() const;
  Status<> wait();
  void abandon() noexcept;

  std::filesystem::path file_;
  std::filesystem::path temporary_;
  pid_t child_ = -1;
  int pipe_ = -1;
  int said_ = -1;  ///< what ffmpeg says, in memory: a full disk takes no log either
};

}  // namespace footlight::app

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

#include "config/decode_protocol.hpp"
#include "config/decoder_process.hpp"
#include "config/media.hpp"
#include "core/clock.hpp"
#include "core/result.hpp"

namespace footlight::config {

/// What `footlight-decode` is asked for; and in words, what may go wrong with it.
struct DecodeJob {
  enum class Kind { video, image, painting, text, lamps };
  std::string path;  ///< of a text: the text
  Kind kind = Kind::video;
  int first = 0;
  std::optional<int> last;
  PictureOptions picture;
  MediaLimits limits;
  const std::atomic<bool>* stop = nullptr;
  std::string font{};  ///< of a text

  /// Whether it is one picture and no film of several.
  [[nodiscard]] bool still() const { return kind != Kind::video && kind != Kind::lamps; }
};

/// The child has ended its stream by saying why it cannot go on.
[[nodiscard]] bool known_refusal(const DecodeRecord& record);
/// What the child said, in words.
[[nodiscard]] Error refused_by_child(const DecodeJob& job, const DecodeRecord& said);
/// The child has sent what no child of this version sends.
[[nodiscard]] Error nonsense(const DecodeJob& job, std::string_view what);
/// Errors (ErrorKind::input): there is nothing at `path`, or no regular file.
[[nodiscard]] Status<> is_file(const std::string& path);
/// Reads `size` bytes of the child's stream. @return why there are none
[[nodiscard]] std::optional<Error> take_from(DecoderProcess& process, void* data, std::size_t size,
                                             const DecodeJob& job, const Clock& clock, Instant deadline);
/// Why the last record does not end a stream of so many frames as it should.
[[nodiscard]] std::optional<Error> wrong_end(const DecodeJob& job, const DecodeRecord& record, std::size_t frames);
/// Waits for the child, which has told its end. @return what it says beyond it, or how it died
[[nodiscard]] std::optional<Error> wrong_close(DecoderProcess& process, const DecodeJob& job, const Clock& clock,
                                               Instant deadline);

}  // namespace footlight::config

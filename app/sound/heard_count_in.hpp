// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <memory>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "app/sound/count_in.hpp"
#include "app/sound/mixer.hpp"
#include "app/sound/sound_device.hpp"
#include "app/sound/sound_file.hpp"
#include "app/sound/voice.hpp"
#include "app/surfaces/surface.hpp"
#include "core/clock.hpp"
#include "core/show.hpp"

namespace CLI {
class App;
}

namespace footlight::app {

struct SoundOptions {
  std::string to;  ///< FILE.wav, or a device of ALSA; empty: nothing is heard
  std::string language = "en";
  void add_options(CLI::App& command);
  /// So long before its first count a count-in has to be known, to be heard on the count.
  [[nodiscard]] Duration ahead() const { return to.empty() ? Duration{} : milliseconds(120); }
};

/// Clicks and spoken numbers before every GO, going on and reset move, at their instants, to a loudspeaker or a file.
/// What fails is told once; the show goes on without it.
class HeardCountIn final : public Surface {
 public:
  /// Borrows the show and the clock. @param counts of a count-in
  /// Errors: ErrorKind::input for a file that cannot be written, ErrorKind::device for a device.
  [[nodiscard]] static Result<std::unique_ptr<HeardCountIn>> open(const Show& show, const SoundOptions& options,
                                                                  double counts, const Clock& clock);
  ~HeardCountIn() override;
  HeardCountIn(const HeardCountIn&) = delete;
  HeardCountIn& operator=(const HeardCountIn&) = delete;

  /// What it does without: "" or why numbers are not spoken.
  [[nodiscard]] const std::string& lacks() const { return lacks_; }
  void look(const DeskView& view, RunDesk& desk) override;
  [[nodiscard]] bool listens() const override { return false; }

 private:
  HeardCountIn(const Show& show, double counts, const Clock& clock);
  void feed_file();
  void feed_device() noexcept;

  const Show& show_;
  double counts_;
  const Clock& clock_;
  Voice voice_;
  std::string lacks_;
  std::shared_ptr<const Samples> click_;
  std::shared_ptr<const Samples> accent_;
  Mixer mixer_;
  std::vector<Beat> beats_;
  std::optional<SoundFile> file_;
  Instant began_;
  std::int64_t written_ = 0;  ///< samples
  std::optional<SoundDevice> device_;
  std::atomic<bool> stopping_{false};
  std::atomic<bool> failed_{false};
  std::string trouble_;
  std::thread thread_;
};

}  // namespace footlight::app

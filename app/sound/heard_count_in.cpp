// SPDX-License-Identifier: Apache-2.0
#include "app/sound/heard_count_in.hpp"

#include <array>
#include <utility>

#include <CLI/CLI.hpp>

#include "app/surfaces/run_desk.hpp"

namespace footlight::app {
namespace {

using Phase = controller::Rehearsal::Phase;
constexpr std::size_t kBlock = 480;  // 10 ms

Duration time_of(std::int64_t samples) { return Duration(samples * 1'000'000'000 / kSampleRate); }

}  // namespace

void SoundOptions::add_options(CLI::App& command) {
  command.add_option("--sound", to, "click and say the count-in: FILE.wav, or a sound device of ALSA, as \"default\"");
  command.add_option("--sound-language", language, "of the numbers, by the program espeak-ng where it is installed")
      ->capture_default_str();
}

HeardCountIn::HeardCountIn(const Show& show, double counts, const Clock& clock)
    : show_(show),
      counts_(counts),
      clock_(clock),
      click_(std::make_shared<const Samples>(click(false))),
      accent_(std::make_shared<const Samples>(click(true))) {}

Result<std::unique_ptr<HeardCountIn>> HeardCountIn::open(const Show& show, const SoundOptions& options, double counts,
                                                         const Clock& clock) {
  std::unique_ptr<HeardCountIn> out(new HeardCountIn(show, counts, clock));
  if (options.to.ends_with(".wav")) {
    auto file = SoundFile::create(options.to);
    if (!file) return std::move(file).error();
    out->file_ = std::move(file).value();
  } else {
    auto device = SoundDevice::open(options.to);
    if (!device) return std::move(device).error();
    out->device_ = std::move(device).value();
  }
  if (auto voice = speak_numbers(options.language)) {
    out->voice_ = std::move(voice).value();
  } else {
    out->lacks_ = voice.error().message;
  }
  out->began_ = clock.now();
  if (out->device_) out->thread_ = std::thread([sound = out.get()] { sound->feed_device(); });
  return out;
}

HeardCountIn::~HeardCountIn() {
  stopping_.store(true);
  if (thread_.joinable()) thread_.join();
}

void HeardCountIn::look(const DeskView& view, RunDesk& desk) {
  const Duration offset = clock_.now() - view.now;  // the run's clock has a zero of its own
  std::vector<Beat> beats = count_in_beats(show_, view, counts_);
  // The last click is that of the GO: it is still to be heard when the show goes.
  const bool over = beats.empty() && (view.show.phase == Phase::runs || view.show.phase == Phase::resets);
  // Planned once: the offset is measured anew at each look, and nothing begins again for a microsecond's sake.
  if (beats != beats_ && !over) {
    std::vector<Sounding> sounds;
    for (const Beat& beat : beats) {
      sounds.push_back({beat.at + offset, beat.accented ? accent_ : click_});
      const auto& spoken = voice_.numbers[static_cast<std::size_t>(beat.number)];
      if (spoken) sounds.push_back({beat.at + offset, spoken});
    }
    mixer_.plan(std::move(sounds));
  }
  beats_ = std::move(beats);
  if (file_) feed_file();
  if (!failed_.load(std::memory_order_acquire) || trouble_.empty()) return;
  desk.tell({RunEvent::Kind::note, std::exchange(trouble_, "") + ": the count-in is no longer heard"});
  file_.reset();
}

/// Up to now: what is planned lies ahead.
void HeardCountIn::feed_file() {
  std::array<float, kBlock> block{};
  const std::int64_t until = (clock_.now() - began_).count() / 1000 * kSampleRate / 1'000'000;
  while (written_ < until) {
    const auto count = static_cast<std::size_t>(std::min<std::int64_t>(kBlock, until - written_));
    mixer_.render(began_ + time_of(written_), std::span(block).first(count));
    written_ += static_cast<std::int64_t>(count);
    if (auto done = file_->write(std::span(block).first(count)); !done) {
      trouble_ = done.error().message;
      failed_.store(true);
      return;
    }
  }
}

void HeardCountIn::feed_device() noexcept {
  constexpr Duration kJump = milliseconds(5);
  constexpr int kSlow =
      64;  // so many blocks follow the difference of the two clocks: what is left of jitter is under 0.1 ms
  std::array<float, kBlock> block{};
  std::optional<Instant> next;
  while (!stopping_.load(std::memory_order_relaxed)) {
    const Instant heard = clock_.now() + time_of(device_->delay());
    if (!next || heard - *next > kJump || *next - heard > kJump) {
      next = heard;
    } else {
      *next += (heard - *next) / kSlow;
    }
    mixer_.render(*next, block);
    if (auto done = device_->play(block); !done) {
      trouble_ = done.error().message;
      failed_.store(true, std::memory_order_release);
      return;
    }
    *next += time_of(kBlock);
  }
}

}  // namespace footlight::app

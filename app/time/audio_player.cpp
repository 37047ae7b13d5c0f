// SPDX-License-Identifier: Apache-2.0
#include "app/time/audio_player.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>
#include <sndfile.h>

namespace footlight::app {
namespace {

constexpr std::size_t kPiece = 1024;      // frames
constexpr std::size_t kMostMarks = 4096;  // more than any buffer has pieces
constexpr int kMostEmpty = 64;            // pieces that a stretch may swallow before it gives one

}  // namespace

void AudioPlayer::CloseFile::operator()(sf_private_tag* file) const { sf_close(file); }

Result<std::unique_ptr<AudioPlayer>> AudioPlayer::open(const std::filesystem::path& file,
                                                       const MakeOutput& make_output) {
  SF_INFO info{};
  File opened(sf_open(file.c_str(), SFM_READ, &info));
  if (!opened) {
    std::string why = sf_strerror(nullptr);
    while (!why.empty() && (why.back() == '.' || why.back() == '\n')) why.pop_back();
    return input_error(fmt::format("{}: {} (a sound file is wanted: WAV, FLAC, MP3 ...)", file.string(), why));
  }
  if (info.samplerate < 8'000 || info.samplerate > 192'000 || info.channels < 1 || info.channels > 8 ||
      info.seekable == 0) {
    return input_error(fmt::format("{}: {} Hz on {} channels (8,000 to 192,000 Hz, 1 to 8 channels, no pipe)",
                                   file.string(), info.samplerate, info.channels));
  }
  return std::unique_ptr<AudioPlayer>(
      new AudioPlayer(std::move(opened), info.channels, info.samplerate, make_output(info.channels, info.samplerate)));
}

AudioPlayer::AudioPlayer(File file, int channels, int sample_rate, std::unique_ptr<SoundOutput> output)
    : file_(std::move(file)),
      channels_(static_cast<std::size_t>(channels)),
      sample_rate_(sample_rate),
      output_(std::move(output)),
      stretch_(make_time_stretch(channels, sample_rate)) {}

AudioPlayer::~AudioPlayer() = default;

void AudioPlayer::forget(Instant now) {
  output_->drop(now);
  if (stretch_) stretch_->clear();
  marks_.clear();
  written_ = 0;
  plays_ = stretches_ = false;
}

void AudioPlayer::step(Instant now, const Wanted& wanted) {
  if (plays_ && !wanted.plays) forget(now);
  if (!wanted.plays) return;
  if (!plays_) begin(now, wanted);
  fill(now, wanted.percent);
}

/// Silence until it is to be heard, then the file from its place on; a place before the file is silence, too.
void AudioPlayer::begin(Instant now, const Wanted& wanted) {
  forget(now);
  plays_ = true;
  over_ = false;
  Duration silence = std::max(Duration{}, wanted.at - now);
  Duration position = wanted.position;
  if (wanted.at < now) position += seconds(to_seconds(now - wanted.at) * wanted.percent / 100);
  if (position < Duration{}) silence += seconds(to_seconds(-position) * 100 / wanted.percent);
  read_ = std::max(0.0, to_seconds(position)) * sample_rate_;
  if (sf_seek(file_.get(), static_cast<sf_count_t>(read_), SEEK_SET) < 0) {
    (void)sf_seek(file_.get(), 0, SEEK_END);  // behind its end: silence
    over_ = true;
  }
  marks_.push_back({0, read_, false});
  silence_ = static_cast<std::size_t>(to_seconds(silence) * sample_rate_);
}

std::size_t AudioPlayer::read(std::vector<float>& frames, std::size_t count) {
  frames.assign(count * channels_, 0.0F);
  const sf_count_t got = sf_readf_float(file_.get(), frames.data(), static_cast<sf_count_t>(count));
  if (got < static_cast<sf_count_t>(count)) over_ = true;
  read_ += static_cast<double>(count);  // behind the end the time goes on in silence
  return count;
}

void AudioPlayer::write(std::span<const float> frames, Instant now, bool music) {
  output_->write(frames, now);
  written_ += frames.size() / channels_;
  const double inside = stretches_ ? stretch_->inside() : 0;
  marks_.push_back({written_, read_ - inside, music});
  if (marks_.size() > kMostMarks) marks_.pop_front();
}

void AudioPlayer::fill(Instant now, int percent) {
  refuses_speed_ = percent != 100 && !stretch_;
  if (percent != 100 && stretch_) {
    stretches_ = true;
    stretch_->set_speed(percent / 100.0);
  } else if (stretches_) {
    stretch_->set_speed(1);  // it keeps what is inside
  }
  std::vector<float> frames;
  std::size_t room = output_->room(now);
  while (room > 0 && silence_ > 0) {
    const std::size_t count = std::min({room, silence_, kPiece});
    frames.assign(count * channels_, 0.0F);
    write(frames, now, false);
    silence_ -= count;
    room -= count;
  }
  int empty = 0;
  while (room > 0 && silence_ == 0) {
    const std::size_t count = std::min(room, kPiece);
    if (!stretches_) {
      (void)read(frames, count);
      write(frames, now, true);
      room -= count;
      continue;
    }
    frames.assign(count * channels_, 0.0F);
    const std::size_t got = stretch_->take(frames);
    if (got > 0) {
      write(std::span(frames).first(got * channels_), now, true);
      room -= got;
      empty = 0;
      continue;
    }
    if (++empty > kMostEmpty) return;
    std::vector<float> more;
    (void)read(more, kPiece);
    stretch_->put(more);
  }
}

std::optional<Duration> AudioPlayer::position(Instant now) const {
  if (!plays_ || marks_.empty()) return std::nullopt;
  const std::size_t waiting = std::min(written_, output_->waiting(now));
  const std::size_t heard = written_ - waiting;
  const auto after = std::ranges::lower_bound(marks_, heard, {}, &Mark::written);
  if (after == marks_.end() || after == marks_.begin() || !after->music) return std::nullopt;
  const Mark& before = *std::prev(after);
  const double share =
      static_cast<double>(heard - before.written) / static_cast<double>(after->written - before.written);
  return seconds((before.source + share * (after->source - before.source)) / sample_rate_);
}

}  // namespace footlight::app

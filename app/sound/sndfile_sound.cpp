// SPDX-License-Identifier: Apache-2.0
#include <utility>

#include <fmt/format.h>
#include <sndfile.h>

#include "app/sound/sound_file.hpp"

namespace footlight::app {

struct SoundFile::Open {
  std::string name;
  SNDFILE* file = nullptr;
  ~Open() {
    if (file != nullptr) sf_close(file);
  }
};

SoundFile::SoundFile(std::unique_ptr<Open> open) : open_(std::move(open)) {}
SoundFile::SoundFile(SoundFile&&) noexcept = default;
SoundFile& SoundFile::operator=(SoundFile&&) noexcept = default;
SoundFile::~SoundFile() = default;

Result<SoundFile> SoundFile::create(const std::string& file) {
  SF_INFO info{};
  info.samplerate = kSampleRate;
  info.channels = 1;
  info.format = SF_FORMAT_WAV | SF_FORMAT_PCM_16;
  auto open = std::make_unique<Open>();
  open->name = file;
  open->file = sf_open(file.c_str(), SFM_WRITE, &info);
  if (open->file == nullptr) return input_error(fmt::format("cannot write '{}': {}", file, sf_strerror(nullptr)));
  sf_command(open->file, SFC_SET_UPDATE_HEADER_AUTO, nullptr, SF_TRUE);
  sf_command(open->file, SFC_SET_CLIPPING, nullptr, SF_TRUE);
  return SoundFile(std::move(open));
}

Status<> SoundFile::write(std::span<const float> samples) {
  const auto count = static_cast<sf_count_t>(samples.size());
  if (sf_writef_float(open_->file, samples.data(), count) == count) return Done{};
  return input_error(fmt::format("cannot write '{}': {}", open_->name, sf_strerror(open_->file)));
}

Result<Samples> SoundFile::read(const std::string& file) {
  SF_INFO info{};
  Open open;
  open.file = sf_open(file.c_str(), SFM_READ, &info);
  if (open.file == nullptr) return input_error(fmt::format("cannot read '{}': {}", file, sf_strerror(nullptr)));
  constexpr sf_count_t kMost = 60 * 192'000;
  if (info.channels < 1 || info.samplerate < 1000 || info.frames > kMost) {
    return input_error(fmt::format("cannot read '{}': no sound of at most a minute", file));
  }
  std::vector<float> all(static_cast<std::size_t>(info.frames) * static_cast<std::size_t>(info.channels));
  const sf_count_t frames = sf_readf_float(open.file, all.data(), info.frames);
  Samples mono(static_cast<std::size_t>(frames));
  for (std::size_t i = 0; i < mono.size(); ++i) {
    float sum = 0;
    for (int c = 0; c < info.channels; ++c)
      sum += all[i * static_cast<std::size_t>(info.channels) + static_cast<std::size_t>(c)];
    mono[i] = sum / static_cast<float>(info.channels);
  }
  return resampled(mono, info.samplerate);
}

}  // namespace footlight::app

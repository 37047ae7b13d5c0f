// SPDX-License-Identifier: Apache-2.0
#include "app/sound/sound_device.hpp"

namespace footlight::app {

struct SoundDevice::Open {};

SoundDevice::SoundDevice(std::unique_ptr<Open> open) : open_(std::move(open)) {}
SoundDevice::SoundDevice(SoundDevice&&) noexcept = default;
SoundDevice& SoundDevice::operator=(SoundDevice&&) noexcept = default;
SoundDevice::~SoundDevice() = default;
Result<SoundDevice> SoundDevice::open(const std::string& name) {
  return device_error("sound device \"" + name + "\": built without ALSA (a file, FILE.wav, is possible)");
}
Status<> SoundDevice::play(std::span<const float> /*block*/) { return Done{}; }
long SoundDevice::delay() const { return 0; }

}  // namespace footlight::app

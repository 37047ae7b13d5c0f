// SPDX-License-Identifier: Apache-2.0
#include "app/time/sound_input.hpp"
#include "app/time/sound_output.hpp"

namespace footlight::app {

Result<std::unique_ptr<SoundInput>> open_alsa_input(const std::string& device) {
  return device_error("no sound input \"" + device + "\": this program was built without ALSA (libasound2-dev)");
}

Result<std::unique_ptr<SoundOutput>> open_alsa_output(const std::string& device, int /*channels*/, int /*rate_hz*/) {
  return device_error("no sound output \"" + device + "\": this program was built without ALSA (libasound2-dev)");
}

}  // namespace footlight::app

// SPDX-License-Identifier: Apache-2.0
#include "app/sound/click_file.hpp"

#include <array>
#include <cstdint>
#include <memory>
#include <utility>

#include "app/sound/mixer.hpp"
#include "app/sound/samples.hpp"
#include "app/sound/sound_file.hpp"

namespace footlight::app {

Status<> write_clicks(const std::string& file, const std::vector<Beat>& beats, Instant start) {
  auto out = SoundFile::create(file);
  if (!out) return std::move(out).error();
  const auto plain = std::make_shared<const Samples>(click(false));
  const auto accent = std::make_shared<const Samples>(click(true));
  std::vector<Sounding> sounds;
  for (const Beat& beat : beats) sounds.push_back({beat.at, beat.accented ? accent : plain});
  const Instant end = beats.empty() ? start : beats.back().at + milliseconds(100);
  Mixer mixer;
  mixer.plan(std::move(sounds));
  std::array<float, kSampleRate / 10> block{};
  for (std::int64_t k = 0;; ++k) {
    const Instant from = start + k * milliseconds(100);
    if (from > end) return Done{};
    mixer.render(from, block);
    if (auto done = out->write(block); !done) return done;
  }
}

}  // namespace footlight::app

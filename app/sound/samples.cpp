// SPDX-License-Identifier: Apache-2.0
#include "app/sound/samples.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>

namespace footlight::app {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr float kSilent = 0.01F;

}  // namespace

Samples click(bool accented) {
  constexpr double kLength_s = 0.040;
  constexpr double kAttack_s = 0.0005;
  constexpr double kFalls_s = 0.008;
  const double tone_hz = accented ? 1760 : 1100;
  const double loud = accented ? 0.8 : 0.5;
  Samples out(static_cast<std::size_t>(kLength_s * kSampleRate));
  for (std::size_t i = 0; i < out.size(); ++i) {
    const double t = static_cast<double>(i) / kSampleRate;
    const double envelope = std::min(1.0, t / kAttack_s) * std::exp(-t / kFalls_s);
    out[i] = static_cast<float>(loud * envelope * std::cos(2 * kPi * tone_hz * t));
  }
  return out;
}

Samples resampled(const Samples& sound, int rate) {
  if (rate == kSampleRate || sound.empty()) return sound;
  constexpr int kTaps = 16;  // on each side
  const double step = static_cast<double>(rate) / kSampleRate;
  const double cutoff = std::min(1.0, 1 / step);  // of the source's Nyquist frequency
  const auto size = static_cast<std::size_t>(std::ceil(static_cast<double>(sound.size()) / step));
  Samples out(size);
  for (std::size_t i = 0; i < size; ++i) {
    const double at = static_cast<double>(i) * step;
    const double reach = kTaps / cutoff;
    const auto from = static_cast<std::ptrdiff_t>(std::ceil(at - reach));
    const auto to = static_cast<std::ptrdiff_t>(std::floor(at + reach));
    double sum = 0;
    double weights = 0;  // the window is not exactly a unit response
    for (std::ptrdiff_t k = from; k <= to; ++k) {
      const double x = at - static_cast<double>(k);
      const double sinc = x == 0 ? 1.0 : std::sin(kPi * cutoff * x) / (kPi * cutoff * x);
      const double weight = sinc * (0.5 + 0.5 * std::cos(kPi * x / reach));
      weights += weight;
      if (k >= 0 && k < static_cast<std::ptrdiff_t>(sound.size())) sum += weight * sound[static_cast<std::size_t>(k)];
    }
    out[i] = static_cast<float>(sum / weights);
  }
  return out;
}

Samples trimmed(const Samples& sound, double most_s) {
  const auto loud = [](float sample) { return std::abs(sample) > kSilent; };
  const auto first = std::find_if(sound.begin(), sound.end(), loud);
  const auto last = std::find_if(sound.rbegin(), sound.rend(), loud).base();
  if (first >= last) return {};
  Samples out(first, last);
  const auto most = static_cast<std::size_t>(most_s * kSampleRate);
  if (out.size() <= most) return out;
  out.resize(most);
  const std::size_t fade = std::min(most, static_cast<std::size_t>(kSampleRate / 100));
  for (std::size_t i = 0; i < fade; ++i) {
    out[most - 1 - i] *= static_cast<float>(i) / static_cast<float>(fade);
  }
  return out;
}

}  // namespace footlight::app

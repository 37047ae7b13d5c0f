// SPDX-License-Identifier: Apache-2.0
#include "app/commission/film_reading.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "app/commission/lamp_tracking.hpp"

namespace footlight::app {
namespace {

constexpr double kLeastContrast = 0.35;  // median over the bits: below, a light does not flash
constexpr double kLeastReadable = 0.3;   // of the flashing lights; fewer: it is another sequence

/// (light in the bit - light in its complement) / their sum, for each bit.
std::vector<double> contrasts_of(const LightSite& site, const FlashSequence& sequence) {
  std::vector<double> out(static_cast<std::size_t>(sequence.code().bits()));
  std::vector<double> lit(out.size());
  std::vector<double> unlit(out.size());
  for (std::size_t p = 0; p < sequence.parts().size(); ++p) {
    const FlashPart& part = sequence.parts()[p];
    if (part.kind != FlashPart::Kind::bit) continue;
    (part.complement ? unlit : lit)[static_cast<std::size_t>(part.bit)] = site.light_of_part[p];
  }
  for (std::size_t b = 0; b < out.size(); ++b) {
    const double sum = lit[b] + unlit[b];
    out[b] = sum <= 0 ? 0 : (lit[b] - unlit[b]) / sum;
  }
  return out;
}

double median_size(const std::vector<double>& values) {
  std::vector<double> sizes;
  for (const double value : values) sizes.push_back(std::abs(value));
  const auto middle = sizes.begin() + static_cast<std::ptrdiff_t>(sizes.size() / 2);
  std::ranges::nth_element(sizes, middle);
  return *middle;
}

}  // namespace

Result<FilmReading> read_flashes(const config::LampFilm& film, const FlashSequence& sequence, double step_s,
                                 const std::string& name) {
  const double length_s = film.frames.empty() ? 0 : film.frames.back().time_s - film.frames.front().time_s;
  const double needed_s = sequence.steps() * step_s;
  if (least_light(film) <= 0) {
    return input_error(
        fmt::format("'{}' shows no lamps: not a single point of light in {} frames (the whole floor in "
                    "the picture, the hall dark, the exposure fixed)",
                    name, film.frames.size()));
  }
  const auto timing = find_sequence(film, sequence, step_s);
  if (!timing) {
    return input_error(
        fmt::format("'{}' is too short: {:.1f} s, and the sequence takes {:.1f} s (film from before the "
                    "first flash until after the last one)",
                    name, length_s, needed_s));
  }
  if (timing->fit < kLeastFit) {
    return input_error(fmt::format(
        "'{}' does not show the flash sequence of this rig's {} lamps: the best fit is {:.2f}, {:.2f} is needed (film "
        "all of it, the whole floor in the picture, with the rig and the --step that it was played with)",
        name, sequence.code().lamps(), timing->fit, kLeastFit));
  }
  const TrackedFilm tracked = track_lamps(film, sequence, *timing);
  FilmReading out;
  out.timing = *timing;
  out.most_moved_px = tracked.most_moved_px;
  out.reference_s = film.frames[tracked.reference].time_s;
  std::size_t exact = 0;
  for (const LightSite& site : tracked.sites) {
    const std::vector<double> contrasts = contrasts_of(site, sequence);
    if (median_size(contrasts) < kLeastContrast) {
      ++out.steady;
      continue;
    }
    const LampCode::Read read = sequence.code().read(contrasts);
    SeenLight light{site.place, std::nullopt, read.outcome == LampCode::Outcome::corrected};
    if (read.outcome != LampCode::Outcome::wrong) light.lamp = read.lamp;
    exact += read.outcome == LampCode::Outcome::exact ? 1 : 0;
    out.lights.push_back(light);
  }
  if (static_cast<double>(exact) < kLeastReadable * static_cast<double>(out.lights.size()) || out.lights.empty()) {
    return input_error(fmt::format(
        "'{}' shows the flash sequence of another rig: {} of {} flashing lights have a word of this one (the rig must "
        "have the buses, nodes and channels with which the sequence was played)",
        name, exact, out.lights.size()));
  }
  return out;
}

}  // namespace footlight::app

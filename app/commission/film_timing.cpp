// SPDX-License-Identifier: Apache-2.0
#include "app/commission/film_timing.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/check.hpp"

namespace footlight::app {
namespace {

constexpr double kGrain_s = 0.005;  // the series of lights is sampled this often
constexpr double kSlowMotions[] = {1, 2, 4, 8};
constexpr double kStepOff = 0.06;
constexpr double kStepGrain = 0.004;
constexpr double kStartGrain = 1.0 / 6;  // of a step
constexpr double kQuarter = 0.25;
constexpr double kStrongShare = 0.1;
constexpr double kMargin = 0.1;       // of a part at each end: frames that see two parts
constexpr double kMostFilm_s = 3600;  // longer films are not sampled beyond

/// Lights over time, for means of any stretch.
class Lights {
 public:
  explicit Lights(const config::LampFilm& film) {
    const float least = least_light(film);
    begin_s_ = film.frames.front().time_s;
    const double end_s = std::min(film.frames.back().time_s, begin_s_ + kMostFilm_s);
    sums_.push_back(0);
    std::size_t frame = 0;
    for (double t = begin_s_; t <= end_s; t += kGrain_s) {
      while (frame + 1 < film.frames.size() && film.frames[frame + 1].time_s <= t) ++frame;
      if (counts_.size() <= frame) {
        counts_.resize(frame + 1);
        counts_[frame] = static_cast<double>(std::ranges::count_if(
            film.frames[frame].spots, [&](const config::LightSpot& spot) { return spot.light >= least; }));
      }
      sums_.push_back(sums_.back() + counts_[frame]);
    }
  }
  [[nodiscard]] double begin_s() const { return begin_s_; }
  [[nodiscard]] double end_s() const { return begin_s_ + kGrain_s * static_cast<double>(sums_.size() - 1); }
  /// Mean between two instants; what is beyond the film counts as its end.
  [[nodiscard]] double mean(double from_s, double to_s) const {
    const std::size_t a = at(from_s);
    const std::size_t b = std::min(std::max(a + 1, at(to_s)), sums_.size() - 1);
    return b <= a ? 0 : (sums_[b] - sums_[a]) / static_cast<double>(b - a);
  }

 private:
  [[nodiscard]] std::size_t at(double t_s) const {
    const double position = std::clamp((t_s - begin_s_) / kGrain_s, 0.0, static_cast<double>(sums_.size() - 1));
    return static_cast<std::size_t>(position);
  }
  double begin_s_ = 0;
  std::vector<double> counts_;  ///< by frame
  std::vector<double> sums_;
};

/// Correlation of lights and shares, each part with its length as weight.
double fit_of(const Lights& lights, const FlashSequence& sequence, double start_s, double step_s) {
  double w = 0, x = 0, y = 0, xx = 0, yy = 0, xy = 0;
  for (std::size_t p = 0; p < sequence.parts().size(); ++p) {
    const FlashPart& part = sequence.parts()[p];
    const double from = start_s + (part.begins + kMargin) * step_s;
    const double to = start_s + (part.begins + part.steps - kMargin) * step_s;
    const double seen = lights.mean(from, to);
    const double share = sequence.share(p);
    const double weight = part.steps;
    w += weight;
    x += weight * share;
    y += weight * seen;
    xx += weight * share * share;
    yy += weight * seen * seen;
    xy += weight * share * seen;
  }
  const double spread = (w * xx - x * x) * (w * yy - y * y);
  return spread <= 0 ? 0 : (w * xy - x * y) / std::sqrt(spread);
}

}  // namespace

float least_light(const config::LampFilm& film) {
  // What the brightest tenth of the frames have: those in which many lamps shine.
  std::vector<std::pair<std::size_t, const config::LampFrame*>> fullest;
  for (const auto& frame : film.frames) fullest.emplace_back(frame.spots.size(), &frame);
  std::ranges::stable_sort(fullest, std::ranges::greater{}, &std::pair<std::size_t, const config::LampFrame*>::first);
  fullest.resize((fullest.size() + 9) / 10);
  std::vector<float> lights;
  for (const auto& [count, frame] : fullest) {
    for (const auto& spot : frame->spots) lights.push_back(spot.light);
  }
  if (lights.empty()) return 0;
  const auto weak = static_cast<std::ptrdiff_t>(kStrongShare * static_cast<double>(lights.size()));
  std::ranges::nth_element(lights, lights.begin() + weak);
  return static_cast<float>(kQuarter) * lights[static_cast<std::size_t>(weak)];
}

std::optional<FilmTiming> find_sequence(const config::LampFilm& film, const FlashSequence& sequence, double step_s) {
  FL_CHECK(step_s > 0);
  if (film.frames.size() < 2) return std::nullopt;
  const Lights lights(film);
  // The dark at both ends need not be in the film.
  const FlashPart& first = sequence.parts()[1];
  const FlashPart& last = sequence.parts()[sequence.parts().size() - 2];
  FilmTiming best;
  const auto consider = [&](double start, double step) {
    if (start + first.begins * step < lights.begin_s() - 0.5 * step) return;
    if (start + (last.begins + last.steps) * step > lights.end_s() + 0.5 * step) return;
    const double fit = fit_of(lights, sequence, start, step);
    if (fit > best.fit) best = {start, step, fit};
  };
  bool long_enough = false;
  for (const double slow : kSlowMotions) {
    for (double off = 1 - kStepOff; off <= 1 + kStepOff + 1e-9; off += kStepGrain) {
      const double step = step_s * slow * off;
      const double begin = lights.begin_s() - (first.begins + 0.5) * step;
      const double end = lights.end_s() - (last.begins + last.steps - 0.5) * step;
      long_enough = long_enough || begin <= end;
      for (double start = begin; start <= end; start += kStartGrain * step) consider(start, step);
    }
  }
  if (!long_enough) return std::nullopt;
  for (double grain = 0.5; grain > 0.01; grain /= 2) {
    const FilmTiming from = best;
    for (int s = -2; s <= 2; ++s) {
      for (int t = -2; t <= 2; ++t) {
        const double step = from.step_s * (1 + s * grain * kStepGrain);
        // Around the middle of the sequence, so that step and beginning are found apart.
        const double middle = from.start_s + 0.5 * sequence.steps() * from.step_s;
        consider(middle - 0.5 * sequence.steps() * step + t * grain * kStartGrain * step, step);
      }
    }
  }
  return best;
}

}  // namespace footlight::app

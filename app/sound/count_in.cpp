// SPDX-License-Identifier: Apache-2.0
#include "app/sound/count_in.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

namespace footlight::app {
namespace {

using Phase = controller::Rehearsal::Phase;
constexpr int kMostSaid = 8;

struct Beginning {
  Instant at;      ///< clock: people begin to walk
  Duration count;  ///< length of one
  double counts = 0;
};

std::optional<Beginning> beginning_of(const Show& show, const DeskView& view, double counts) {
  const ShowState& state = view.show;
  if (state.phase == Phase::counts_in && state.goes_at != kNever && counts > 0) {
    const double count = show.tempo.count_at(state.position);
    const Duration span = show.tempo.span(count, counts);
    return Beginning{state.goes_at, seconds(to_seconds(span) / counts * 100 / state.percent), counts};
  }
  // In a reset move people stand for the count-in, then walk: its plan says when.
  if (state.phase != Phase::resets || !view.way || view.way->sections.empty()) return std::nullopt;
  const PlanSection& stand = view.way->sections.front();
  const Instant begins = state.goes_at != kNever ? state.goes_at : state.at - state.target.show_time;
  const Duration stands = stand.end - stand.start;
  const double whole = std::max(1.0, counts);
  if (stands <= Duration{}) return std::nullopt;
  return Beginning{begins + stands, Duration(static_cast<Duration::rep>(static_cast<double>(stands.count()) / whole)),
                   whole};
}

}  // namespace

std::vector<Beat> count_in_beats(const Show& show, const DeskView& view, double counts) {
  std::vector<Beat> beats;
  const auto begins = beginning_of(show, view, counts);
  if (!begins) return beats;
  const int whole = static_cast<int>(std::floor(begins->counts + 1e-9));
  const int said = std::min(whole, kMostSaid);
  for (int left = whole; left >= 1; --left) {
    const int number = left <= said ? said - left + 1 : 0;
    beats.push_back({begins->at - left * begins->count, number, number == 1});
  }
  beats.push_back({begins->at, 0, true});
  return beats;
}

std::vector<Beat> click_track(const TempoMap& tempo, Instant from, Instant to) {
  std::vector<Beat> beats;
  for (double count = std::ceil(tempo.count_at(from) - 1e-9); tempo.at(count) <= to; ++count) {
    beats.push_back({tempo.at(count), 0, tempo.measure_beat(count).ends_with(":1")});
  }
  return beats;
}

}  // namespace footlight::app

// SPDX-License-Identifier: Apache-2.0
#include "app/remote/cue_light.hpp"

namespace footlight::app {
namespace {

constexpr Duration kPeriod = milliseconds(1000);

}  // namespace

void CueLight::standby(Instant now) {
  state_ = State::standby;
  since_ = now;
}

bool CueLight::acknowledge() {
  if (state_ == State::standby) state_ = State::acknowledged;
  return state_ == State::acknowledged;
}

void CueLight::go(Instant now) {
  state_ = State::go;
  since_ = now;
}

CueLight::Lamps CueLight::lamps(Instant now) {
  const Duration phase = (now - since_) % kPeriod;
  switch (state_) {
    case State::off:
      return {};
    case State::standby:
      return {phase < milliseconds(500), false};
    case State::acknowledged:
      return {true, false};
    case State::go:
      if (now - since_ >= kGreen) {
        state_ = State::off;
        return {};
      }
      return {false, phase < milliseconds(200) || (phase >= milliseconds(350) && phase < milliseconds(550))};
  }
  return {};
}

}  // namespace footlight::app

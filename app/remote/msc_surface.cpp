// SPDX-License-Identifier: Apache-2.0
#include "app/remote/msc_surface.hpp"

#include <utility>

#include <fmt/format.h>

namespace footlight::app {
namespace {

constexpr Duration kTellLost = milliseconds(1000);
constexpr Duration kAgain = milliseconds(1000);
constexpr int kMostTaken = 1024;  // a look

}  // namespace

Result<std::unique_ptr<MscSurface>> MscSurface::open(const config::MidiRemote& settings, const Clock& clock,
                                                     bool listens) {
  auto input = open_midi_input(settings.port, clock);
  if (!input) return std::move(input).error();
  return std::unique_ptr<MscSurface>(new MscSurface(settings, std::move(input).value(), clock, listens));
}

MscSurface::MscSurface(const config::MidiRemote& settings, std::unique_ptr<MidiInput> input, const Clock& clock,
                       bool listens)
    : settings_(settings),
      input_(std::move(input)),
      clock_(clock),
      listens_(listens),
      me_{controller::GoSource::network, "msc " + input_->name()} {}

int MscSurface::file() const { return input_ ? input_->poll_handle() : -1; }

void MscSurface::look(const DeskView& view, RunDesk& desk) {
  if (!input_) return reopen(desk);
  guard_.begin_look();
  for (int i = 0; i < kMostTaken; ++i) {
    const auto message = input_->take();
    if (!message) break;
    const MscHeard heard = hear_msc(message->view(), settings_);
    if (!heard.call && heard.why_not.empty()) continue;
    const bool holds = heard.call && heard.call->kind == RemoteCall::Kind::hold;
    if (holds ? guard_.take_hold(clock_.now()) : guard_.take({}, clock_.now())) say(heard, view, desk);
  }
  tell_lost(desk);
  if (!input_->closed()) return;
  desk.tell({RunEvent::Kind::alarm, "MIDI \"" + input_->name() + "\" is gone: nobody presses GO there any more"});
  input_.reset();
  again_at_ = clock_.now() + kAgain;
}

void MscSurface::say(const MscHeard& heard, const DeskView& view, RunDesk& desk) {
  if (!heard.call) return desk.tell(refusal_of("show control", me_, heard.why_not));
  const auto words = words_of(*heard.call, view, desk.orders().plays());
  if (!words) return desk.tell(refusal_of("show control", me_, words.error().message));
  desk.say(words.value(), me_);
}

void MscSurface::reopen(RunDesk& desk) {
  if (clock_.now() < again_at_) return;
  again_at_ = clock_.now() + kAgain;
  auto input = open_midi_input(settings_.port, clock_);
  if (!input) return;
  input_ = std::move(input).value();
  lost_in_input_ = 0;
  desk.tell({RunEvent::Kind::note, "MIDI \"" + input_->name() + "\" is there again"});
}

void MscSurface::tell_lost(RunDesk& desk) {
  lost_ += guard_.lost() + input_->lost() - std::exchange(lost_in_input_, input_->lost());
  if (lost_ == 0 || clock_.now() - lost_told_ < kTellLost) return;
  lost_told_ = clock_.now();
  desk.tell({RunEvent::Kind::note,
             fmt::format("MIDI: {} messages were lost: too many, or cut off", std::exchange(lost_, 0))});
}

}  // namespace footlight::app

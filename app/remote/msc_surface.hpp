// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>

#include "app/midi/midi_input.hpp"
#include "app/remote/flood_guard.hpp"
#include "app/remote/msc.hpp"
#include "app/surfaces/run_desk.hpp"

namespace footlight::app {

/// The show led by MIDI Show Control. A port that is gone is asked for again every second; a flood costs messages,
/// but never a STOP or ALL_OFF.
class MscSurface final : public Surface {
 public:
  /// Borrows the clock. Errors (ErrorKind::device): no such port.
  [[nodiscard]] static Result<std::unique_ptr<MscSurface>> open(const config::MidiRemote& settings, const Clock& clock,
                                                                bool listens);

  void look(const DeskView& view, RunDesk& desk) override;
  [[nodiscard]] int file() const override;
  [[nodiscard]] bool listens() const override { return listens_; }

 private:
  MscSurface(const config::MidiRemote& settings, std::unique_ptr<MidiInput> input, const Clock& clock, bool listens);
  void say(const MscHeard& heard, const DeskView& view, RunDesk& desk);
  void reopen(RunDesk& desk);
  void tell_lost(RunDesk& desk);

  config::MidiRemote settings_;
  std::unique_ptr<MidiInput> input_;  ///< none: it is gone
  const Clock& clock_;
  bool listens_;
  Speaker me_;
  FloodGuard guard_;
  std::uint64_t lost_ = 0;
  std::uint64_t lost_in_input_ = 0;
  Instant lost_told_{};
  Instant again_at_{};
};

}  // namespace footlight::app

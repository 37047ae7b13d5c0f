// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <deque>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "app/remote/flood_guard.hpp"
#include "app/remote/interlocks.hpp"
#include "app/remote/osc_calls.hpp"
#include "app/remote/osc_door.hpp"
#include "app/remote/panel.hpp"
#include "app/surfaces/run_desk.hpp"
#include "app/surfaces/state_text.hpp"
#include "config/remote_file.hpp"
#include "core/clock.hpp"
#include "core/file_descriptor.hpp"

namespace footlight::app {

/// The show led and told by OSC over UDP (docs/remote.md). Every call is answered at `/reply` and its address with
/// "ok", "refused", "denied" or "error" and a text.
///
/// A flood costs whoever floods its messages beyond some every 20 ms, and nobody a HOLD: first it is asked who may,
/// then what is meant. /stop, hold buttons and gates are in no budget; of what is said too often of such an input the
/// level counts that is on the safe side. Messages without the token have a budget of their own.
class OscSurface final : public Surface {
 public:
  /// Borrows all but the settings. @param listens whether a run goes on for what might still be said here
  /// Errors: ErrorKind::input: the token; ErrorKind::device: the port is not to be had.
  [[nodiscard]] static Result<std::unique_ptr<OscSurface>> open(const config::OscRemote& settings, const Show& show,
                                                                const Plan& plan, const RunDesk& desk,
                                                                Interlocks& interlocks, Panel& panel,
                                                                const Clock& clock, bool listens);

  void look(const DeskView& view, RunDesk& desk) override;
  void told(const RunEvent& event) override;
  [[nodiscard]] int file() const override;
  [[nodiscard]] bool listens() const override { return listens_; }

 private:
  struct Pending {
    config::NetworkPlace client;
    std::string who;
    std::string order;
    std::string address;
  };
  OscSurface(const config::OscRemote& settings, std::string token, FileDescriptor socket, const Show& show,
             const Plan& plan, const RunDesk& desk, Interlocks& interlocks, Panel& panel, const Clock& clock,
             bool listens);
  void read(const DeskView& view, RunDesk& desk);
  void take(std::span<const std::byte> datagram, const config::NetworkPlace& client, const DeskView& view,
            RunDesk& desk);
  void carry_out(OscMessage message, const config::NetworkPlace& client, const DeskView& view, RunDesk& desk);
  /// @return whether one of that name is told by OSC
  bool hear(const OscInput& input, const config::NetworkPlace& client, RunDesk& desk);
  void settle_inputs(RunDesk& desk);
  void say(const RemoteCall& call, const std::string& address, const config::NetworkPlace& client, const DeskView& view,
           RunDesk& desk);
  void reply(const config::NetworkPlace& client, const std::string& address, const std::string& status,
             const std::string& text);
  void send(const config::NetworkPlace& to, const std::vector<std::byte>& bytes) const;
  [[nodiscard]] std::vector<OscMessage> state_of(const DeskView& view) const;
  void tell_lost(RunDesk& desk);

  config::OscRemote settings_;
  OscDoor door_;
  FileDescriptor socket_;
  StateText text_;
  const RunDesk& desk_;
  Interlocks& interlocks_;
  Panel& panel_;
  const Clock& clock_;
  bool listens_;
  std::deque<Pending> pending_;  ///< calls that are not answered yet
  FloodGuard guard_;
  std::map<std::pair<bool, std::string>, bool> levels_;  ///< of gates (true) and hold buttons that were told too often
  Instant lost_told_{};
  Instant state_told_{};
};

}  // namespace footlight::app

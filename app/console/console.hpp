// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "app/console/server.hpp"
#include "app/surfaces/run_desk.hpp"
#include "app/surfaces/state_text.hpp"

namespace footlight::app {

/// The console in a browser as a place from which a show is led: hands over between the desk and the server's thread.
class Console final : public Surface {
 public:
  struct Place {
    std::string address = "127.0.0.1";  ///< numeric
    std::uint16_t port = 0;             ///< 0: any that is free
    std::vector<std::string> hosts{};   ///< names by which browsers may ask for it besides, with their port
    Role most = Role::admin;            ///< that anybody may be
  };
  /// @param place "8440", "127.0.0.1:8440", "[::]:8440": an address and a port. Errors (ErrorKind::input)
  /// @param what for the message
  [[nodiscard]] static Result<Place> place_from(const std::string& place, const std::string& what = "the console");

  /// Listens from here on. Borrows show, plan, rig and desk.
  /// @param folder for the token and the audit log
  /// @param leads false: the run does not wait for what is said here
  /// Errors: as AuditLog::open, token_in and ConsoleServer::open.
  [[nodiscard]] static Result<std::unique_ptr<Console>> open(const Place& place, const std::filesystem::path& folder,
                                                             const Show& show, const Plan& plan, const Rig& rig,
                                                             const RunDesk& desk, bool leads);

  /// For LiveOptions.
  [[nodiscard]] NodeBoard& nodes() { return board_; }
  /// Of the plan that plays, before the first look at it.
  void take_limits(std::vector<controller::TempoLimit> limits) { limits_ = std::move(limits); }
  /// The show has its buses from here on: what was told of it before had no lamps.
  void begin();
  /// "http://127.0.0.1:8440"
  [[nodiscard]] const std::string& address() const { return address_; }
  [[nodiscard]] bool needs_token() const { return needs_token_; }

  void look(const DeskView& view, RunDesk& desk) override;
  void told(const RunEvent& event) override { server_->told(event); }
  void plan_taken() override;
  [[nodiscard]] int file() const override { return orders_.file(); }
  [[nodiscard]] bool listens() const override { return leads_; }

 private:
  Console(const Show& show, const Plan& plan, const Rig& rig, const RunDesk& desk, bool leads);
  void tell_show(const DeskView& view);
  void tell_looks(const DeskView& view);
  void tell_state(const DeskView& view);
  void tell_health(const DeskView& view);
  void tell_untold(const DeskView& view);

  const Show& show_;
  const Plan& plan_;
  const Rig& rig_;
  StateText text_;
  bool leads_;
  SteadyClock clock_;
  NodeBoard board_;
  OrderBox orders_;
  std::vector<controller::TempoLimit> limits_;
  std::string address_;
  bool needs_token_ = false;
  std::uint32_t epoch_ = 1;  ///< of plans
  bool show_told_ = false;   ///< of this epoch
  std::shared_ptr<const Plan> way_;
  std::vector<std::size_t> looks_wanted_;
  std::string state_;
  Instant state_at_ = Instant::min();
  std::shared_ptr<const std::vector<std::string>> untold_;
  std::string health_;
  Instant health_at_ = Instant::min();
  std::unique_ptr<AuditLog> audit_;
  std::unique_ptr<ConsoleServer> server_;  ///< ends before what it borrows
};

}  // namespace footlight::app

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "app/surfaces/surface.hpp"
#include "app/surviving/lead_line.hpp"
#include "core/file_descriptor.hpp"
#include "core/result.hpp"

namespace footlight::app {

/// A leading run's door for understudies: tells those who have the token and the same plan where the show is, ten times
/// a second while the cue thread lives. Nothing that comes in is an order, but that an understudy takes over. Nobody
/// here can make the show wait: sockets do not block, and whoever does not take what is said is hung up on. `beat` is
/// called by one thread, everything else by the desk's.
class LeadPort final : public Surface {
 public:
  static constexpr std::size_t kMostClients = 8;
  static constexpr Duration kFirstLineWithin = milliseconds(5000);

  struct Settings {
    std::string address = "127.0.0.1";
    int port = 0;       ///< 0: any that is free
    std::string token;  ///< empty: whoever is on this machine may follow; only on a loopback address
    std::string plan;   ///< config::digest_of
    std::uint32_t epoch = 0;
  };
  /// Errors (ErrorKind::input): an address that is not this machine's, a port that is taken, no token beyond loopback.
  static Result<std::unique_ptr<LeadPort>> open(Settings settings);

  /// Some fifty times a second. @param state what the cue thread has published last
  void beat(const ShowState& state);
  /// Tells what has come of those who wanted to follow.
  void look(const DeskView& view, RunDesk& desk) override;
  [[nodiscard]] bool listens() const override { return false; }

  [[nodiscard]] int port() const { return port_; }
  /// The epoch of an understudy that has taken over; 0: none has.
  [[nodiscard]] std::uint32_t taken_over() const { return taken_over_.load(std::memory_order_relaxed); }
  /// Another plan is led from now on: who follows has the one before, and its places would mean something else to her.
  /// She is told so, and hung up on. @param digest config::digest_of
  void plan_is(const std::string& digest);
  /// Says good-bye: nobody is to take over from a run that ends of its own will. After the last `beat`.
  void close(const std::string& how);

 private:
  struct Client {
    FileDescriptor socket;
    std::string heard;
    bool follows = false;
    Duration since{};  ///< of `machine_time`
  };
  LeadPort(Settings settings, FileDescriptor listener, int port)
      : settings_(std::move(settings)), listener_(std::move(listener)), port_(port) {}
  void go_over(const std::string& digest);
  void welcome(Duration now);
  /// @return false when it is to be hung up on
  bool listen_to(Client& client, Duration now);
  bool take_line(Client& client, std::string_view line);
  void tell(RunEvent::Kind kind, std::string text);

  Settings settings_;
  FileDescriptor listener_;
  int port_;
  std::vector<Client> clients_;
  std::atomic<std::uint32_t> taken_over_{0};
  Duration machine_ahead_ = Duration::max();
  Instant said_at_ = Instant::min();  ///< of the run's clock
  std::mutex mutex_;
  // Under the mutex.
  std::vector<RunEvent> news_;  ///< for the desk
  bool looked_ = false;         ///< the desk has said what it knows beyond the cue thread: the next two
  bool emergency_hold_ = false;
  std::string readiness_;
  std::string next_plan_;  ///< led from now on; empty: no other one
};

/// "127.0.0.1", "::1", "localhost" and the like.
[[nodiscard]] bool is_loopback(const std::string& address);

/// A token of 256 bits of chance in a file of mode 0600, made where it is not there. Errors: a file that others may
/// read.
[[nodiscard]] Result<std::string> token_in(const std::string& file);

}  // namespace footlight::app

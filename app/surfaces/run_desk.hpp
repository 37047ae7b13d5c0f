// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "app/surfaces/orders.hpp"
#include "app/surfaces/surface.hpp"

namespace footlight::app {

/// The desk of a run: whatever surface somebody uses, her words become commands here, and everybody is told what came
/// of them. One thread.
class RunDesk {
 public:
  /// An order that does not concern where the show is: "note ...". It answers at once.
  struct Verb {
    std::string word;  ///< its first word, lower case
    std::string help;  ///< lines as `kOrders`
    /// @param words after the verb, as they were said  @return what to answer; an error's message says what would be
    /// right
    std::function<Result<std::string>(const std::vector<std::string>& words, const Speaker& who)> carry_out;
  };

  /// Fills in what a view has beyond what the run knows.
  using Facts = std::function<void(DeskView&)>;

  /// Borrows show and plan.
  RunDesk(const Show& show, const Plan& plan) : orders_(show, plan) {}

  /// Before the run. @param surface borrowed
  void add(Surface& surface) { surfaces_.push_back(&surface); }
  void add(Verb verb);
  void add(Facts facts) { facts_.push_back(std::move(facts)); }

  /// An order in words (`help`). What came of it, also that it was not understood, is told to all.
  void say(std::string_view line, const Speaker& who);
  /// An order that is understood already. @param order how to call it
  void say(controller::Command command, std::string order, const Speaker& who);
  void tell(RunEvent event);
  /// Of the show itself: nobody is told what came of it.
  void send(const controller::Command& command) { wishes_.commands.push_back(command); }
  /// What stands against walking, until it is taken back. @param bars bits of controller/bars.hpp
  void bar(controller::Bars bars, bool there) { wishes_.bars = there ? wishes_.bars | bars : wishes_.bars & ~bars; }
  /// Show and plan have other contents: told to all surfaces.
  void plan_taken();
  /// Who is not guided from now on, as `DeskWishes::muted`.
  void mute(std::vector<bool> muted) { wishes_.muted = std::move(muted); }
  [[nodiscard]] std::string help() const;
  [[nodiscard]] const Orders& orders() const { return orders_; }

  // For LiveOptions.
  DeskWishes look(const DeskView& view);
  void answered(const Answer& answer);
  /// Until a surface has something, at most so long.
  void wait(Duration most) const;

 private:
  struct Said {
    std::string order;
    Speaker who;
  };
  void refuse(std::string_view order, const Speaker& who, std::string why);
  std::uint8_t number_of(const Speaker& who);
  void tell_switched_off(std::uint64_t inputs);

  Orders orders_;
  std::vector<Verb> verbs_;
  std::vector<Surface*> surfaces_;
  std::map<std::uint32_t, Said> said_;  ///< by command, until it is answered
  std::vector<Facts> facts_;
  std::vector<std::string> inputs_;  ///< names of speakers, by their numbers for the GO guard
  std::uint64_t off_ = 0;            ///< of them, those that are known to be switched off
  std::vector<std::string> against_;
  const std::vector<controller::TempoLimit>* limits_ = nullptr;  ///< of the last view
  int cue_ = -1;                                                 ///< that runs, or is standby
  std::uint32_t last_ = 0;
  DeskWishes wishes_;
  Instant now_{};
};

}  // namespace footlight::app

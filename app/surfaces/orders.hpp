// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>
#include <vector>

#include "controller/cue_list.hpp"
#include "controller/rehearsal.hpp"
#include "core/plan.hpp"
#include "core/result.hpp"
#include "core/show.hpp"

namespace footlight::app {

/// What somebody at the desk has said.
struct Order {
  enum class Kind { command, quit };
  Kind kind = Kind::command;
  controller::Command command{};
};

/// Understands a line as `kOrders` explains it; names of cues, sections, counts and times become positions of the show.
/// Upper case, spaces and a % more do no harm; an empty line is GO. Errors (ErrorKind::input) say what would be right.
class Orders {
 public:
  /// Borrows show and plan.
  Orders(const Show& show, const Plan& plan);
  [[nodiscard]] Result<Order> from(std::string_view line) const;
  /// Show and plan have other contents.
  void plan_taken() { plays_ = controller::cue_plays(show_, plan_); }
  [[nodiscard]] const std::vector<controller::CuePlay>& plays() const { return plays_; }

 private:
  struct Stretch {
    Instant from;
    Instant to;
  };
  [[nodiscard]] Result<Stretch> stretch(std::string_view verb, const std::vector<std::string>& words) const;
  /// Of a timecode of the show's source; nothing: it is none of its rate, or not on the show.
  [[nodiscard]] std::optional<Instant> position_of(std::string_view timecode) const;

  const Show& show_;
  const Plan& plan_;
  std::vector<controller::CuePlay> plays_;
};

/// For people: every order, a line each.
extern const std::string_view kOrders;

}  // namespace footlight::app

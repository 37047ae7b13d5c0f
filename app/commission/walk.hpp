// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "app/commission/lamps.hpp"
#include "core/result.hpp"
#include "core/rig.hpp"
#include "core/stage.hpp"

namespace footlight::app {

/// Somebody walks from lamp to lamp and says where each is. What was said is a text, a line for each answer, from which
/// the walk can be taken up again after anything. Borrows rig and stage.
class Walk {
 public:
  Walk(const Rig& rig, const Stage& stage, std::vector<FloorLamp> lamps, WalkOrder order);

  [[nodiscard]] const std::vector<FloorLamp>& lamps() const { return lamps_; }
  [[nodiscard]] bool finished() const { return answers_.size() == order_.size(); }
  /// Position in the walking order of the lamp that is asked for, and which lamp that is; not when it is finished.
  [[nodiscard]] std::size_t position() const { return answers_.size(); }
  [[nodiscard]] std::size_t lamp() const { return order_[answers_.size()]; }
  [[nodiscard]] const std::vector<std::size_t>& order() const { return order_; }
  /// "12 of 900: can-1-7/3 should be on A5", in whole words.
  [[nodiscard]] std::string question() const;

  /// What the answer was about.
  enum class Said { placed, dead, back, quit };
  /// "" or "y": where the rig says; a cell, or "n" and a cell: there; "d": dead; "b": back to the lamp before; "q":
  /// enough for now. Errors (ErrorKind::input): anything else; a cell that is blocked, beyond the stage or another
  /// lamp's.
  [[nodiscard]] Result<Said> answer(std::string_view text);

  /// First line of the text.
  [[nodiscard]] std::string head() const;
  /// The line that the last answer adds to the text; "back" after going back.
  [[nodiscard]] const std::string& last_line() const { return last_line_; }
  /// Takes up a walk from its text; a last line without its end was not finished and does not count.
  /// Errors (ErrorKind::input): of another rig, or in a line that is named.
  [[nodiscard]] Status<> take_up(std::string_view text, const std::string& file);

  /// Where lamps are; nothing: not asked yet, or dead.
  [[nodiscard]] std::vector<std::optional<CellIndex>> seen() const;
  [[nodiscard]] std::vector<std::size_t> dead() const;

 private:
  struct Answer {
    std::optional<CellIndex> cell;  ///< nothing: dead
  };
  [[nodiscard]] Result<CellIndex> cell_of(std::string_view text) const;
  [[nodiscard]] std::optional<std::size_t> lamp_on(CellIndex cell) const;

  const Rig& rig_;
  const Stage& stage_;
  std::vector<FloorLamp> lamps_;
  std::vector<std::size_t> order_;
  WalkOrder how_;
  std::vector<Answer> answers_;
  std::string last_line_;
};

}  // namespace footlight::app

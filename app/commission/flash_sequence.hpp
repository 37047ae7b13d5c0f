// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <memory>
#include <vector>

#include "app/commission/lamp_code.hpp"
#include "app/commission/lamps.hpp"
#include "controller/cue_schedule.hpp"
#include "core/look.hpp"
#include "core/rig.hpp"
#include "drivers/driver.hpp"

namespace footlight::app {

/// What all lamps show from one instant to the next.
struct FlashPart {
  enum class Kind { dark, all, bit };
  Kind kind = Kind::dark;
  int bit = 0;              ///< of the lamps' words
  bool complement = false;  ///< its opposite: a lamp that shines in a bit is dark in its complement
  int steps = 1;            ///< how long
  int begins = 0;           ///< steps since the beginning
};

/// The order in which lamps flash their words: dark; all for three steps, twice off and on again; then each bit
/// followed by its complement; all for three steps; dark. So the beginning and the end are found in a film of any rate,
/// exposure matters to no bit, and every lamp shines about half of the time.
class FlashSequence {
 public:
  explicit FlashSequence(LampCode code);

  [[nodiscard]] const LampCode& code() const { return code_; }
  [[nodiscard]] const std::vector<FlashPart>& parts() const { return parts_; }
  [[nodiscard]] int steps() const { return steps_; }
  [[nodiscard]] bool lit(std::size_t part, std::size_t lamp) const;
  /// Share of the lamps that shine in a part, 0..1.
  [[nodiscard]] double share(std::size_t part) const { return shares_[part]; }

 private:
  LampCode code_;
  std::vector<FlashPart> parts_;
  std::vector<double> shares_;
  int steps_ = 0;
};

/// White, as bright as the supplies of the rig bear with all lamps lit, at most full; at least 1/255.
[[nodiscard]] Look lamp_white(const Rig& rig);

/// Which lamps shine (positions in `lamps`) in each switch, and when it begins.
struct LitLamps {
  Duration at{};
  std::vector<std::size_t> lamps;
};
/// A schedule of one look: those lamps show it, all others are dark.
[[nodiscard]] controller::CueSchedule lit_schedule(const Rig& rig, const std::vector<FloorLamp>& lamps,
                                                   const Look& look, const std::vector<LitLamps>& switches);

/// The whole sequence, its first part at 0.
[[nodiscard]] controller::CueSchedule flash_schedule(const Rig& rig, const std::vector<FloorLamp>& lamps,
                                                     const FlashSequence& sequence, Duration step, const Look& look);

/// The shortest step in which every bus preloads all of its nodes, latches and hears their receipts with 30 % reserve;
/// at least 400 ms, so that a film of 25 frames a second has six whole frames in its middle; in steps of 50 ms.
[[nodiscard]] Duration shortest_step(const Rig& rig, const std::vector<std::unique_ptr<drivers::Driver>>& drivers);

}  // namespace footlight::app

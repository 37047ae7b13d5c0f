// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "app/live/live_run.hpp"
#include "controller/go_guard.hpp"

namespace footlight::app {

class RunDesk;

/// Who says something at the desk.
struct Speaker {
  controller::GoSource input = controller::GoSource::lines;
  std::string name = "lines";  ///< for people and the journal: "keyboard", "osc 10.0.0.4"
  std::uint64_t tag = 0;       ///< a surface's own; comes back with the answer
};

/// What all surfaces and the journal of a run are told, besides its state.
struct RunEvent {
  enum class Kind : std::uint8_t {
    answer,  ///< what came of an order
    moment,  ///< a switch was lit
    reset,   ///< a way back was planned, or could not be
    alarm,   ///< something is wrong that somebody has to look at
    note,    ///< anything else worth a line
  };
  Kind kind = Kind::note;
  std::string text{};
  Instant at{};  ///< clock; `RunDesk::tell` fills it in
  // Of an answer.
  std::string order{};  ///< as it was said: "jump cue 12"
  Speaker who{};
  bool refused = false;
};

/// "answer", "moment" ...: as in JSON and in the journal.
[[nodiscard]] std::string_view to_text(RunEvent::Kind kind);
/// One line of JSON: {"answer": {"order", "who", "refused", "text"}}, {"moment": text}, {"alarm": text} ...
[[nodiscard]] std::string json_of(const RunEvent& event);

/// A place from which the show is led or watched: keys, lines, a page, OSC, buttons, the journal. All of them speak to
/// one desk. Everything is called by the calling thread of the run, which is no thread of the show: what is slow here
/// delays other surfaces, never a cue. A surface with threads of its own hands over in `look`.
class Surface {
 public:
  virtual ~Surface() = default;
  /// Asked some fifty times a second: says what is wanted to `desk`, takes what the view shows. Must not block.
  virtual void look(const DeskView& view, RunDesk& desk) = 0;
  virtual void told(const RunEvent& /*event*/) {}
  /// Another plan plays from now on: show, plan and rig that were borrowed have other contents, at the same address,
  /// and so have the desk's cues. Views after this are of that plan. Who reads them in another thread keeps copies.
  virtual void plan_taken() {}
  /// Becomes readable when `look` has something to do; -1: there is none.
  [[nodiscard]] virtual int file() const { return -1; }
  /// Whether an order may still come from here. A run whose show is over ends when nobody can say anything any more.
  [[nodiscard]] virtual bool listens() const = 0;
};

}  // namespace footlight::app

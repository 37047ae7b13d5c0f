// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "app/time/time_desk.hpp"
#include "app/time/time_out.hpp"
#include "app/time/time_source.hpp"
#include "core/result.hpp"
#include "core/show.hpp"

namespace CLI {
class App;
}

namespace footlight::app {

/// The surfaces of a run that have to do with time.
struct TimePlaces {
  TimeDesk desk;
  std::vector<std::unique_ptr<TimeOut>> outs{};

  /// Borrowed by the desk of the run; before any other surface, so that in a flood of orders time is not what gets
  /// lost.
  void add_to(RunDesk& run);
  /// The clock of the run, before it begins.
  void use(const Clock& run);
};

/// `footlight run --time`, `--time-out`.
struct TimeOptions {
  std::string source{};  ///< empty: as the show file says
  std::vector<std::string> outs{};

  void add_options(CLI::App& command);
  /// Borrows show and clock. @param go GO is pressed by itself
  /// Errors: as open_time_source and TimeOut::open; ErrorKind::input for a source that brings the cues and a GO by
  /// itself.
  [[nodiscard]] Result<std::unique_ptr<TimePlaces>> open(const Show& show, bool go, const Clock& clock) const;

 private:
  [[nodiscard]] Result<std::unique_ptr<TimeSource>> open_source(const Show& show, bool go, const Clock& clock) const;
};

}  // namespace footlight::app

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>

#include "app/surfaces/run_desk.hpp"
#include "core/clock.hpp"
#include "core/result.hpp"

namespace CLI {
class App;
}

namespace footlight::app {

struct RemoteOptions {
  std::string file;
  bool gates_by_people = false;

  void add_options(CLI::App& command);
};

/// Everything from which a run is led besides its desk, as the file of `--remote` says.
class RemoteControl {
 public:
  /// Opens all of it or nothing, and adds surfaces, orders and facts to the desk. Borrows all.
  /// @param listens whether a run goes on for what might still be said
  /// Errors: what is wrong with the file, each with its place; devices and ports that are not to be had; a show with
  /// gates that nothing tells.
  [[nodiscard]] static Result<std::unique_ptr<RemoteControl>> open(const RemoteOptions& options, const Show& show,
                                                                   const Plan& plan, RunDesk& desk, const Clock& clock,
                                                                   bool listens);
  ~RemoteControl();
  /// Before the run: nobody has acknowledged an emergency hold under the program that led before.
  void take_up_emergency_hold();
  RemoteControl(const RemoteControl&) = delete;
  RemoteControl& operator=(const RemoteControl&) = delete;

 private:
  struct Parts;
  explicit RemoteControl(std::unique_ptr<Parts> parts);
  std::unique_ptr<Parts> parts_;
};

}  // namespace footlight::app

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "app/surfaces/run_desk.hpp"

namespace footlight::app {

/// Writes down what everybody at the desk is told.
class Listener final : public Surface {
 public:
  void look(const DeskView& /*view*/, RunDesk& /*desk*/) override {}
  void told(const RunEvent& event) override {
    if (event.kind == RunEvent::Kind::alarm) heard_.push_back("alarm: " + event.text);
    if (event.kind == RunEvent::Kind::note) heard_.push_back("note: " + event.text);
    if (event.kind != RunEvent::Kind::answer || !event.refused) return;
    heard_.push_back(event.order + " by " + event.who.name + " refused: " + event.text);
  }
  [[nodiscard]] bool listens() const override { return false; }
  std::vector<std::string> take() { return std::exchange(heard_, {}); }

 private:
  std::vector<std::string> heard_;
};

}  // namespace footlight::app

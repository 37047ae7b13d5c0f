// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace footlight::app {

/// The swap of a node for a spare while the show goes on, as a dialogue: the node is unplugged, a spare with its
/// address is plugged in, and the show finds it, lights it as it should be, and confirms. Nothing is sent for it: what
/// a node shows is a function of the position, so a spare is no other case than a node that has restarted. Pure.
class SpareSwap {
 public:
  enum class Step : std::uint8_t { unplug, plug_in, done, given_up };
  /// @param node its name  @param address on its bus  @param bus its name
  SpareSwap(std::string node, int address, std::string bus);

  /// @param silent it does not answer  @param right it has confirmed what it should show now
  /// @return whether the step is another one now
  bool look(bool silent, bool right);
  void give_up() { step_ = Step::given_up; }
  [[nodiscard]] Step step() const { return step_; }
  [[nodiscard]] const std::string& node() const { return node_; }
  [[nodiscard]] bool over() const { return step_ == Step::done || step_ == Step::given_up; }
  /// "unplug", "plug-in" ...: for programs.
  [[nodiscard]] std::string_view step_name() const;
  /// What is to be done now, for people.
  [[nodiscard]] std::string text() const;

 private:
  std::string node_;
  int address_;
  std::string bus_;
  Step step_ = Step::unplug;
};

}  // namespace footlight::app

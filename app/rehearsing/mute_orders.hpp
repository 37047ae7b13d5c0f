// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "app/surfaces/run_desk.hpp"
#include "app/surfaces/surface.hpp"
#include "core/show.hpp"

namespace footlight::app {

/// "solo trumpets", "mute kids, tubas", "unmute kids", "solo off": who is guided (docs/looks.md, "Solo and mute").
class MuteOrders final : public Surface {
 public:
  /// Borrows the show.
  explicit MuteOrders(const Show& show) : show_(show), muted_(show.groups.size() + 1, false) {}

  void add_to(RunDesk& desk);
  void look(const DeskView& view, RunDesk& desk) override;
  void plan_taken() override;
  [[nodiscard]] bool listens() const override { return false; }
  /// "kids, those in no group"; empty: nobody is.
  [[nodiscard]] std::string names() const;

 private:
  Result<std::string> solo(const std::vector<std::string>& words);
  Result<std::string> mute(const std::vector<std::string>& words, bool muted);
  /// Positions of groups named, in commas; the last one means those in none.
  [[nodiscard]] Result<std::vector<std::size_t>> groups_in(std::string_view verb,
                                                           const std::vector<std::string>& words) const;
  std::string changed();

  const Show& show_;
  std::vector<bool> muted_;
  bool wanted_ = false;    ///< and not told yet
  bool possible_ = false;  ///< the markers have a look for it
};

}  // namespace footlight::app

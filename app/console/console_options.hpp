// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "app/console/console.hpp"
#include "app/session.hpp"

namespace CLI {
class App;
}

namespace footlight::app {

/// --console and what belongs to it.
struct ConsoleOptions {
  std::string place;  ///< empty: no console
  std::vector<std::string> hosts;
  Role most = Role::admin;  ///< that anybody may be

  void add_options(CLI::App& command);
  /// Opens it, adds it to the desk and says where it is. @param folder for token and audit log  @return null when
  /// nobody wants one; else as Console::open
  [[nodiscard]] Result<std::unique_ptr<Console>> open(Session& session, const std::filesystem::path& folder,
                                                      const Show& show, const Plan& plan, const Rig& rig, RunDesk& desk,
                                                      bool leads) const;
};

}  // namespace footlight::app

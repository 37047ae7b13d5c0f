// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "app/remote/panel.hpp"
#include "app/remote/settled_input.hpp"
#include "core/clock.hpp"
#include "core/file_descriptor.hpp"
#include "drivers/transports/push_button.hpp"

namespace footlight::app {

/// Buttons, gates, cue lights and tallies on GPIO lines, and what interlocks say, for the desk. Edges wake; every level
/// is read at each look, for the kernel drops edges. A line that is gone is asked for again every second.
class PanelSurface final : public Surface {
 public:
  using OpenLine =
      std::function<Result<std::unique_ptr<drivers::GpioLine>>(const config::GpioPlace&, drivers::GpioSettings)>;

  /// Borrows interlocks, panel and clock. Errors (ErrorKind::device): all lines that were not given to us.
  [[nodiscard]] static Result<std::unique_ptr<PanelSurface>> open(const config::Remote& remote, Interlocks& interlocks,
                                                                  Panel& panel, const Clock& clock, bool listens,
                                                                  OpenLine open_line);

  void look(const DeskView& view, RunDesk& desk) override;
  void told(const RunEvent& event) override { panel_.told(event); }
  [[nodiscard]] int file() const override { return inputs_.empty() ? -1 : epoll_.get(); }
  [[nodiscard]] bool listens() const override { return listens_ && !inputs_.empty(); }

 private:
  struct Input {
    config::GpioPlace place;
    bool gate = false;
    std::size_t index = 0;  ///< in remote.gates or remote.buttons
    bool holds = false;     ///< a level; else presses
    std::string name;
    std::optional<SettledInput> level{};
    std::optional<drivers::ButtonInput> button{};
    Instant again_at{};  ///< when a line that is gone is asked for again
  };
  struct Lamp {
    config::GpioPlace place;
    std::function<bool()> lit;
    std::unique_ptr<drivers::GpioLine> line{};
    std::optional<bool> shown{};
    Instant again_at{};
    bool told = false;
  };
  PanelSurface(Interlocks& interlocks, Panel& panel, const Clock& clock, bool listens, OpenLine open_line);
  void add_inputs(const config::Remote& remote);
  void add_lamps(const config::Remote& remote);
  Status<> open(Input& input);
  Status<> open(Lamp& lamp);
  void read(Input& input, Instant now, RunDesk& desk);
  void read_presses(Input& input, Instant now, RunDesk& desk);
  void read_level(Input& input, Instant now);
  void lose(Input& input, Instant now, const std::string& why);
  void show(Lamp& lamp, Instant now, RunDesk& desk);

  Interlocks& interlocks_;
  Panel& panel_;
  const Clock& clock_;
  bool listens_;
  OpenLine open_line_;
  FileDescriptor epoll_;
  std::vector<Input> inputs_;
  std::vector<Lamp> lamps_;
};

}  // namespace footlight::app

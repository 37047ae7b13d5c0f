// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "sim/simulated_bus.hpp"

namespace footlight::sim {

/// A half-duplex pair of wires, RS-485: everybody hears everybody, nobody hears himself, and who talk at the same time
/// garble each other from the first character that overlaps.
class SharedLine final : public Actor {
 public:
  class Listener {
   public:
    virtual ~Listener() = default;
    /// At the end of the last character. @param copy true for the second hearing of a duplicated frame; it takes no
    /// more time on the wire
    virtual void heard(int speaker, std::span<const std::uint8_t> bytes, bool copy) = 0;
    /// Before `heard`: draws who misses this frame and adds the names to its note.
    virtual void draw_losses(int speaker, std::string& note) = 0;
  };

  /// @param gap silence that every frame needs after it; counts as use of the wire
  SharedLine(const Bus& bus, int bits_per_character, Duration gap, Surroundings& around, BusUse& use,
             Listener& listener)
      : bus_(bus), bits_(bits_per_character), gap_(gap), around_(around), use_(use), listener_(listener) {}

  [[nodiscard]] Duration time_of(std::size_t characters) const {
    return bit_time(static_cast<std::int64_t>(characters) * bits_, bus_.bits_per_second);
  }
  /// @param start not before now  @return the end of the last character
  Instant say(int speaker, std::vector<std::uint8_t> bytes, Instant start);
  /// A node loses power: what it is saying breaks off.
  void cut(int speaker);
  /// The end of everything that is being said now; now when nothing is.
  [[nodiscard]] Instant quiet_at() const;

  void act(std::uint64_t token) override;

 private:
  struct Talk {
    int speaker = kController;
    Instant start;
    Instant end = kStart;
    Instant garbled_from = kNever;
    Instant garbled_until = kStart;
    std::vector<std::uint8_t> bytes;
    bool under_way = false;
  };

  void begin(Talk& talk);
  void finish(Talk& talk);
  void garble(Talk& talk);

  const Bus& bus_;
  int bits_;
  Duration gap_;
  Surroundings& around_;
  BusUse& use_;
  Listener& listener_;
  std::vector<Talk> talks_;
  std::vector<std::size_t> free_;
  Instant used_until_ = kStart;
};

}  // namespace footlight::sim

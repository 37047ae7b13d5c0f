// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <cstdint>
#include <deque>
#include <filesystem>
#include <fstream>
#include <memory>
#include <span>
#include <string>
#include <thread>
#include <vector>

#include "app/wire_log/wire_log.hpp"
#include "core/clock.hpp"
#include "core/result.hpp"
#include "core/rig.hpp"

namespace footlight::app {

/// Packets on their way from the thread of a bus to the thread that writes: a ring of bytes. One writer, one reader;
/// neither waits.
class PacketQueue {
 public:
  struct Packet {
    Instant at;
    Heading heading = Heading::sent;
    std::vector<std::uint8_t> bytes;
  };
  /// @param capacity a power of two
  explicit PacketQueue(std::size_t capacity = std::size_t{1} << 18U);
  /// @return false when there is no room: the packet is not taken
  bool push(Instant at, Heading heading, std::span<const std::uint8_t> bytes) noexcept;
  bool pop(Packet& packet);

 private:
  void put(std::uint64_t at, std::span<const std::uint8_t> bytes) noexcept;
  void get(std::uint64_t at, std::span<std::uint8_t> bytes) const noexcept;

  std::vector<std::uint8_t> ring_;
  std::atomic<std::uint64_t> head_{0};  ///< bytes ever put in
  std::atomic<std::uint64_t> tail_{0};  ///< bytes ever taken out
};

/// The log of a real run: a file of all that goes over the wires, and a ring of the last ten minutes in pieces of one
/// minute, which is there even after the program was killed. What the bus threads tell is written by a thread of its
/// own; a disk that is slow, full or gone costs packets and never a cue.
class WireRecorder final : public WireLog {
 public:
  static constexpr Duration kPiece = std::chrono::minutes(1);
  static constexpr std::size_t kPieces = 11;

  struct Places {
    std::filesystem::path ring;  ///< folder for the pieces, made when it is not there; empty: no ring
    std::ostream* file = nullptr;
  };
  /// @param clock real time; borrowed, as is the file. Errors: the folder cannot be made or written to.
  static Result<std::unique_ptr<WireRecorder>> open(const Rig& rig, const Places& places, const Clock& clock);
  ~WireRecorder() override;

  void record(std::size_t bus, Heading heading, std::span<const std::uint8_t> packet) noexcept override;
  /// Writes what is left. Nothing may be recorded any more.
  void close();
  /// Packets for which there was no room.
  [[nodiscard]] std::uint64_t dropped() const noexcept { return dropped_.load(std::memory_order_relaxed); }
  /// False when a piece of the ring could not be written to its end.
  [[nodiscard]] bool whole() const noexcept { return whole_; }

 private:
  WireRecorder(const Rig& rig, const Places& places, const Clock& clock);
  void run();
  void drain();
  bool next_piece();

  std::vector<Wire> wires_;
  Places places_;
  const Clock& clock_;
  Duration zero_;  ///< the clock's zero, since 1970
  std::deque<PacketQueue> queues_;
  std::atomic<std::uint64_t> dropped_{0};
  bool whole_ = true;
  std::ofstream piece_;
  Instant piece_since_ = kStart;
  std::atomic<bool> stopping_{false};
  std::thread thread_;
};

/// Pieces of a ring, oldest first.
[[nodiscard]] std::vector<std::filesystem::path> ring_pieces(const std::filesystem::path& folder);

}  // namespace footlight::app

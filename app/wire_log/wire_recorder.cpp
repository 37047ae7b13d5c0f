// SPDX-License-Identifier: Apache-2.0
#include "app/wire_log/wire_recorder.hpp"

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <system_error>
#include <utility>

#include <fmt/format.h>

#include "core/check.hpp"

namespace footlight::app {
namespace {

constexpr auto kDrain = std::chrono::milliseconds(50);
constexpr std::size_t kHead = 13;  // size 4, instant 8, heading 1

}  // namespace

PacketQueue::PacketQueue(std::size_t capacity) : ring_(capacity) { FL_CHECK((capacity & (capacity - 1)) == 0); }

bool PacketQueue::push(Instant at, Heading heading, std::span<const std::uint8_t> bytes) noexcept {
  const std::uint64_t head = head_.load(std::memory_order_relaxed);
  const std::uint64_t tail = tail_.load(std::memory_order_acquire);
  if (head - tail + kHead + bytes.size() > ring_.size()) return false;
  std::array<std::uint8_t, kHead> front{};
  const auto size = static_cast<std::uint32_t>(bytes.size());
  const Duration::rep time = at.time_since_epoch().count();
  std::memcpy(front.data(), &size, 4);
  std::memcpy(front.data() + 4, &time, 8);
  front[12] = static_cast<std::uint8_t>(heading);
  put(head, front);
  put(head + kHead, bytes);
  head_.store(head + kHead + bytes.size(), std::memory_order_release);
  return true;
}

bool PacketQueue::pop(Packet& packet) {
  const std::uint64_t tail = tail_.load(std::memory_order_relaxed);
  if (tail == head_.load(std::memory_order_acquire)) return false;
  std::array<std::uint8_t, kHead> front{};
  get(tail, front);
  std::uint32_t size = 0;
  Duration::rep time = 0;
  std::memcpy(&size, front.data(), 4);
  std::memcpy(&time, front.data() + 4, 8);
  packet.at = Instant(Duration(time));
  packet.heading = static_cast<Heading>(front[12]);
  packet.bytes.resize(size);
  get(tail + kHead, packet.bytes);
  tail_.store(tail + kHead + size, std::memory_order_release);
  return true;
}

void PacketQueue::put(std::uint64_t at, std::span<const std::uint8_t> bytes) noexcept {
  const std::size_t begin = at & (ring_.size() - 1);
  const std::size_t first = std::min(bytes.size(), ring_.size() - begin);
  std::copy_n(bytes.begin(), first, ring_.begin() + static_cast<std::ptrdiff_t>(begin));
  std::copy_n(bytes.begin() + static_cast<std::ptrdiff_t>(first), bytes.size() - first, ring_.begin());
}

void PacketQueue::get(std::uint64_t at, std::span<std::uint8_t> bytes) const noexcept {
  const std::size_t begin = at & (ring_.size() - 1);
  const std::size_t first = std::min(bytes.size(), ring_.size() - begin);
  std::copy_n(ring_.begin() + static_cast<std::ptrdiff_t>(begin), first, bytes.begin());
  std::copy_n(ring_.begin(), bytes.size() - first, bytes.begin() + static_cast<std::ptrdiff_t>(first));
}

WireRecorder::WireRecorder(const Rig& rig, const Places& places, const Clock& clock)
    : wires_(wires_of(rig)),
      places_(places),
      clock_(clock),
      zero_(wall_time() - clock.now().time_since_epoch()),
      queues_(rig.buses.size()) {}

Result<std::unique_ptr<WireRecorder>> WireRecorder::open(const Rig& rig, const Places& places, const Clock& clock) {
  std::unique_ptr<WireRecorder> recorder(new WireRecorder(rig, places, clock));
  if (places.file != nullptr) PcapngWriter(*places.file).begin(recorder->wires_);
  if (!places.ring.empty()) {
    std::error_code error;
    std::filesystem::create_directories(places.ring, error);
    if (error || !recorder->next_piece()) {
      return input_error(fmt::format("cannot write the wire logs in '{}': {} (--state names another folder)",
                                     places.ring.string(),
                                     error ? error.message() : std::generic_category().message(errno)));
    }
  }
  recorder->thread_ = std::thread([raw = recorder.get()] { raw->run(); });
  return recorder;
}

WireRecorder::~WireRecorder() { close(); }

void WireRecorder::record(std::size_t bus, Heading heading, std::span<const std::uint8_t> packet) noexcept {
  if (!queues_[bus].push(clock_.now(), heading, packet)) dropped_.fetch_add(1, std::memory_order_relaxed);
}

void WireRecorder::close() {
  if (!thread_.joinable()) return;
  stopping_.store(true, std::memory_order_relaxed);
  thread_.join();
  drain();
}

void WireRecorder::run() {
  while (!stopping_.load(std::memory_order_relaxed)) {
    std::this_thread::sleep_for(kDrain);
    drain();
    if (!places_.ring.empty() && clock_.now() - piece_since_ >= kPiece) whole_ = next_piece() && whole_;
  }
}

void WireRecorder::drain() {
  std::vector<std::pair<std::size_t, PacketQueue::Packet>> packets;
  for (std::size_t bus = 0; bus < queues_.size(); ++bus) {
    PacketQueue::Packet packet;
    while (queues_[bus].pop(packet)) packets.emplace_back(bus, std::move(packet));
  }
  std::ranges::stable_sort(packets, {}, [](const auto& packet) { return packet.second.at; });
  for (std::ostream* out : {places_.file, places_.ring.empty() ? nullptr : static_cast<std::ostream*>(&piece_)}) {
    if (out == nullptr || packets.empty()) continue;
    PcapngWriter writer(*out);
    for (const auto& [bus, packet] : packets) {
      writer.packet(bus, zero_ + packet.at.time_since_epoch(), packet.heading, packet.bytes);
    }
    out->flush();
  }
  whole_ = whole_ && !piece_.fail();
}

bool WireRecorder::next_piece() {
  auto pieces = ring_pieces(places_.ring);
  int number = 1;
  if (!pieces.empty()) {
    const std::string last = pieces.back().stem().string();
    number = std::stoi(last.substr(last.find('-') + 1)) + 1;
  }
  for (std::size_t i = 0; i + kPieces <= pieces.size(); ++i) {
    std::error_code ignored;
    std::filesystem::remove(pieces[i], ignored);
  }
  piece_.close();
  piece_.clear();
  piece_.open(places_.ring / fmt::format("wires-{:06}.pcapng", number), std::ios::binary | std::ios::trunc);
  piece_since_ = clock_.now();
  PcapngWriter(piece_).begin(wires_);
  piece_.flush();
  return piece_.good();
}

std::vector<std::filesystem::path> ring_pieces(const std::filesystem::path& folder) {
  std::vector<std::filesystem::path> pieces;
  std::error_code error;
  for (const auto& entry : std::filesystem::directory_iterator(folder, error)) {
    const std::string name = entry.path().filename().string();
    const std::string digits = name.size() == 19 ? name.substr(6, 6) : "";
    const bool number = digits.size() == 6 && std::ranges::all_of(digits, [](char c) { return c >= '0' && c <= '9'; });
    if (number && name.starts_with("wires-") && name.ends_with(".pcapng")) pieces.push_back(entry.path());
  }
  std::ranges::sort(pieces);
  return pieces;
}

}  // namespace footlight::app

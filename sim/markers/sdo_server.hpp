// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "drivers/transport.hpp"
#include "sim/markers/canopen_objects.hpp"

namespace footlight::sim {

/// The SDO server of a node (CiA 301, 7.2.4): expedited and segmented transfers, one at a time.
class SdoServer {
 public:
  using Bytes8 = std::span<const std::uint8_t, 8>;

  /// @param objects borrowed
  SdoServer(std::uint8_t id, ObjectDictionary& objects) : id_(id), objects_(objects) {}

  /// @param request the data of a frame 0x600 + id  @return the answer; absent: the other side has aborted
  std::optional<drivers::CanFrame> answer(Bytes8 request, Instant now);
  void reset() { transfer_ = Transfer::none; }

 private:
  enum class Transfer { none, upload, download };

  drivers::CanFrame start_download(Bytes8 request, Instant now);
  drivers::CanFrame start_upload(Bytes8 request);
  drivers::CanFrame next_download(Bytes8 request, Instant now);
  drivers::CanFrame next_upload(Bytes8 request);
  [[nodiscard]] drivers::CanFrame frame(std::uint8_t command) const;
  drivers::CanFrame abort(SdoAbort code);

  std::uint8_t id_;
  ObjectDictionary& objects_;
  Transfer transfer_ = Transfer::none;
  std::uint16_t index_ = 0;
  std::uint8_t sub_ = 0;
  std::uint8_t toggle_ = 0;  ///< expected in the next segment: 0 or 0x10
  std::vector<std::uint8_t> data_;
  std::size_t sent_ = 0;
};

}  // namespace footlight::sim

// SPDX-License-Identifier: Apache-2.0
#include "sim/markers/sdo_server.hpp"

#include <algorithm>

namespace footlight::sim {
namespace {

constexpr std::size_t kSegment = 7;
constexpr std::size_t kExpedited = 4;
constexpr std::size_t kLongestDownload = 64;  // nothing that can be written is longer than four
constexpr std::uint8_t kToggle = 0x10;

}  // namespace

std::optional<drivers::CanFrame> SdoServer::answer(Bytes8 request, Instant now) {
  switch (request[0] >> 5U) {
    case 0:
      return transfer_ == Transfer::download ? next_download(request, now) : abort(SdoAbort::command);
    case 1:
      return start_download(request, now);
    case 2:
      return start_upload(request);
    case 3:
      return transfer_ == Transfer::upload ? next_upload(request) : abort(SdoAbort::command);
    case 4:
      reset();
      return std::nullopt;
    default:
      return abort(SdoAbort::command);
  }
}

drivers::CanFrame SdoServer::start_download(Bytes8 request, Instant now) {
  reset();
  index_ = static_cast<std::uint16_t>(request[1] | (request[2] << 8));
  sub_ = request[3];
  const bool expedited = (request[0] & 0x02U) != 0;
  const bool size_given = (request[0] & 0x01U) != 0;
  if (!expedited) {
    transfer_ = Transfer::download;
    toggle_ = 0;
    data_.clear();
    return frame(0x60);
  }
  std::size_t size = size_given ? kExpedited - ((request[0] >> 2U) & 3U) : kExpedited;
  if (!size_given) {  // then the object's own size counts
    std::vector<std::uint8_t> old;
    if (objects_.read(index_, sub_, old) == SdoAbort::none) size = std::min(old.size(), kExpedited);
  }
  const SdoAbort code = objects_.write(index_, sub_, request.subspan<4, 4>().first(size), now);
  return code == SdoAbort::none ? frame(0x60) : abort(code);
}

drivers::CanFrame SdoServer::start_upload(Bytes8 request) {
  reset();
  index_ = static_cast<std::uint16_t>(request[1] | (request[2] << 8));
  sub_ = request[3];
  const SdoAbort code = objects_.read(index_, sub_, data_);
  if (code != SdoAbort::none) return abort(code);
  if (data_.size() <= kExpedited) {
    drivers::CanFrame expedited = frame(static_cast<std::uint8_t>(0x43U | ((kExpedited - data_.size()) << 2U)));
    std::copy(data_.begin(), data_.end(), expedited.data.begin() + 4);
    return expedited;
  }
  transfer_ = Transfer::upload;
  toggle_ = 0;
  sent_ = 0;
  drivers::CanFrame first = frame(0x41);
  first.data[4] = static_cast<std::uint8_t>(data_.size());
  return first;
}

drivers::CanFrame SdoServer::next_download(Bytes8 request, Instant now) {
  if ((request[0] & kToggle) != toggle_) return abort(SdoAbort::toggle);
  const std::size_t size = kSegment - ((request[0] >> 1U) & 7U);
  data_.insert(data_.end(), request.begin() + 1, request.begin() + 1 + static_cast<std::ptrdiff_t>(size));
  if (data_.size() > kLongestDownload) return abort(SdoAbort::length);
  if ((request[0] & 1U) != 0) {
    const SdoAbort code = objects_.write(index_, sub_, data_, now);
    if (code != SdoAbort::none) return abort(code);
    reset();
  }
  drivers::CanFrame answer = frame(static_cast<std::uint8_t>(0x20U | toggle_));
  std::fill(answer.data.begin() + 1, answer.data.begin() + 4, std::uint8_t{0});
  toggle_ ^= kToggle;
  return answer;
}

drivers::CanFrame SdoServer::next_upload(Bytes8 request) {
  if ((request[0] & kToggle) != toggle_) return abort(SdoAbort::toggle);
  const std::size_t size = std::min(kSegment, data_.size() - sent_);
  const bool last = sent_ + size == data_.size();
  drivers::CanFrame answer = frame(static_cast<std::uint8_t>(toggle_ | ((kSegment - size) << 1U) | (last ? 1U : 0U)));
  std::fill(answer.data.begin() + 1, answer.data.begin() + 8, std::uint8_t{0});
  std::copy_n(data_.begin() + static_cast<std::ptrdiff_t>(sent_), size, answer.data.begin() + 1);
  sent_ += size;
  toggle_ ^= kToggle;
  if (last) reset();
  return answer;
}

drivers::CanFrame SdoServer::frame(std::uint8_t command) const {
  return {static_cast<std::uint16_t>(0x580 + id_),
          8,
          {command, static_cast<std::uint8_t>(index_ & 0xFFU), static_cast<std::uint8_t>(index_ >> 8U), sub_}};
}

drivers::CanFrame SdoServer::abort(SdoAbort code) {
  reset();
  drivers::CanFrame answer = frame(0x80);
  const auto number = static_cast<std::uint32_t>(code);
  for (unsigned i = 0; i < 4; ++i) answer.data.at(4 + i) = static_cast<std::uint8_t>((number >> (8U * i)) & 0xFFU);
  return answer;
}

}  // namespace footlight::sim

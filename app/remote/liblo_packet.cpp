// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cstring>
#include <memory>
#include <string_view>

#include <lo/lo.h>

#include "app/remote/osc_packet.hpp"

namespace footlight::app {
namespace {

constexpr std::size_t kMostMessages = 32;
constexpr std::size_t kMostValues = 16;
constexpr int kDeepest = 4;
constexpr std::string_view kBundle{"#bundle\0", 8};
constexpr std::size_t kBundleHead = 16;  // and a time
constexpr std::string_view kTypes = "ifdsSTF";
constexpr const char* kWrongType = "arguments are numbers, strings, true and false";

struct FreeMessage {
  void operator()(void* message) const { lo_message_free(message); }
};
using Message = std::unique_ptr<void, FreeMessage>;

bool is_bundle(std::span<const std::byte> bytes) {
  return bytes.size() >= kBundle.size() && std::memcmp(bytes.data(), kBundle.data(), kBundle.size()) == 0;
}

std::uint32_t number_at(std::span<const std::byte> bytes) {
  std::uint32_t value = 0;
  for (const std::byte byte : bytes.first(4)) value = value << 8U | std::to_integer<std::uint32_t>(byte);
  return value;
}

/// The types that orders have, before the library sees the others: liblo 0.31 reads the length of a blob beyond the end
/// of a message that has none.
bool has_known_types(std::span<const std::byte> bytes) {
  const auto address = std::ranges::find(bytes, std::byte{0});
  const auto types = static_cast<std::size_t>(address - bytes.begin()) / 4 * 4 + 4;
  if (types >= bytes.size() || bytes[types] != std::byte{','}) return true;  // refused by the library
  for (const std::byte type : bytes.subspan(types + 1)) {
    if (type == std::byte{0}) break;
    if (kTypes.find(std::to_integer<char>(type)) == std::string_view::npos) return false;
  }
  return true;
}

/// The library aligns to four bytes what some machines want at eight.
template <class T>
T copied(const void* argument) {
  T value;
  std::memcpy(&value, argument, sizeof value);
  return value;
}

/// @return false: of a type that no order has
bool take_value(char type, const void* argument, std::vector<OscValue>& values) {
  switch (type) {
    case LO_INT32:
      values.emplace_back(copied<std::int32_t>(argument));
      return true;
    case LO_FLOAT:
      values.emplace_back(static_cast<double>(copied<float>(argument)));
      return true;
    case LO_DOUBLE:
      values.emplace_back(copied<double>(argument));
      return true;
    case LO_STRING:
    case LO_SYMBOL:
      values.emplace_back(std::string(static_cast<const char*>(argument)));
      return true;
    case LO_TRUE:
    case LO_FALSE:
      values.emplace_back(std::int32_t{type == LO_TRUE});
      return true;
    default:
      return false;
  }
}

Status<> read_message(std::span<const std::byte> bytes, std::vector<OscMessage>& out) {
  if (bytes.size() % 4 != 0 || bytes.empty() || bytes[0] != std::byte{'/'}) return input_error("no OSC message");
  if (out.size() == kMostMessages) return input_error("more than 32 messages in one datagram");
  if (!has_known_types(bytes)) return input_error(kWrongType);
  std::vector<std::byte> copy(bytes.begin(), bytes.end());  // the library turns numbers round in place
  int result = 0;
  const Message message(lo_message_deserialise(copy.data(), copy.size(), &result));
  if (!message) return input_error("no OSC message");
  OscMessage read{reinterpret_cast<const char*>(bytes.data())};  // the library has found its end
  const std::string types = lo_message_get_types(message.get());
  if (types.size() > kMostValues) return input_error("more than 16 arguments");
  lo_arg** arguments = lo_message_get_argv(message.get());
  for (std::size_t i = 0; i < types.size(); ++i) {
    if (!take_value(types[i], arguments[i], read.values)) {
      return input_error(kWrongType);
    }
  }
  out.push_back(std::move(read));
  return Done{};
}

Status<> read_packet(std::span<const std::byte> bytes, int depth, std::vector<OscMessage>& out) {
  if (!is_bundle(bytes)) return read_message(bytes, out);
  if (depth == kDeepest) return input_error("bundles in bundles more than four deep");
  if (bytes.size() < kBundleHead) return input_error("a bundle that is cut off");
  bytes = bytes.subspan(kBundleHead);
  while (!bytes.empty()) {
    if (bytes.size() < 4) return input_error("a bundle that is cut off");
    const std::size_t size = number_at(bytes);
    bytes = bytes.subspan(4);
    if (size > bytes.size() || size == 0) return input_error("a bundle that is cut off");
    if (auto read = read_packet(bytes.first(size), depth + 1, out); !read) return read;
    bytes = bytes.subspan(size);
  }
  return Done{};
}

}  // namespace

Result<std::vector<OscMessage>> read_osc(std::span<const std::byte> datagram) {
  std::vector<OscMessage> messages;
  if (auto read = read_packet(datagram, 0, messages); !read) return std::move(read).error();
  return messages;
}

std::vector<std::byte> osc_bytes(const OscMessage& message) {
  const Message out(lo_message_new());
  for (const OscValue& value : message.values) {
    if (const auto* whole = std::get_if<std::int32_t>(&value)) lo_message_add_int32(out.get(), *whole);
    if (const auto* real = std::get_if<double>(&value)) lo_message_add_float(out.get(), static_cast<float>(*real));
    if (const auto* text = std::get_if<std::string>(&value)) lo_message_add_string(out.get(), text->c_str());
  }
  std::vector<std::byte> bytes(lo_message_length(out.get(), message.address.c_str()));
  std::size_t size = bytes.size();
  (void)lo_message_serialise(out.get(), message.address.c_str(), bytes.data(), &size);
  return bytes;
}

std::vector<std::byte> osc_bundle(const std::vector<OscMessage>& messages) {
  std::vector<std::byte> bytes(kBundleHead);
  std::memcpy(bytes.data(), kBundle.data(), kBundle.size());
  bytes.back() = std::byte{1};  // at once
  for (const OscMessage& message : messages) {
    const std::vector<std::byte> one = osc_bytes(message);
    for (int shift = 24; shift >= 0; shift -= 8) bytes.push_back(static_cast<std::byte>(one.size() >> shift));
    bytes.insert(bytes.end(), one.begin(), one.end());
  }
  return bytes;
}

}  // namespace footlight::app

// SPDX-License-Identifier: Apache-2.0
#include "app/remote/osc_door.hpp"

#include <algorithm>
#include <cctype>
#include <cerrno>
#include <fstream>
#include <system_error>

#include <nettle/memops.h>
#include <sys/stat.h>

namespace footlight::app {
namespace {

constexpr std::size_t kShortestToken = 22;  // 128 bits at six a character
constexpr std::size_t kLongestToken = 256;

}  // namespace

bool OscDoor::knows(std::string_view address) const { return std::ranges::find(from_, address) != from_.end(); }

bool OscDoor::is_token(std::string_view said) const {
  return said.size() == token_.size() && nettle_memeql_sec(said.data(), token_.data(), token_.size()) != 0;
}

bool OscDoor::connect(const config::NetworkPlace& client, std::string_view token, Instant now) {
  if (token_.empty()) return true;
  if (!is_token(token)) return false;
  if (heard_.size() >= kMostClients) {
    heard_.erase(std::ranges::min_element(heard_, {}, [](const auto& one) { return one.second; }));
  }
  heard_[{client.address, client.port}] = now;
  return true;
}

bool OscDoor::lets_in(const config::NetworkPlace& client, OscMessage& message, Instant now) {
  if (token_.empty()) return true;
  const auto* last = message.values.empty() ? nullptr : std::get_if<std::string>(&message.values.back());
  if (last != nullptr && is_token(*last)) {
    message.values.pop_back();
    return true;
  }
  const auto known = heard_.find({client.address, client.port});
  if (known == heard_.end()) return false;
  if (now - known->second > kForgotten) {
    heard_.erase(known);
    return false;
  }
  known->second = now;
  return true;
}

Result<std::string> read_osc_token(const std::string& file) {
  const auto wrong = [&](const std::string& what, const std::string& right) {
    return input_error("token file \"" + file + "\": " + what + " (" + right + ")");
  };
  constexpr const char* kMake = "(umask 077; head -c 24 /dev/urandom | base64 > FILE) makes one";
  struct stat what {};
  if (::stat(file.c_str(), &what) != 0) return wrong(std::generic_category().message(errno), kMake);
  if ((what.st_mode & (S_IRWXG | S_IRWXO)) != 0) return wrong("others may read it", "chmod 600");
  std::ifstream in(file, std::ios::binary);
  std::string token(kLongestToken + 1, '\0');
  in.read(token.data(), static_cast<std::streamsize>(token.size()));
  token.resize(static_cast<std::size_t>(in.gcount()));
  while (!token.empty() && std::isspace(static_cast<unsigned char>(token.back())) != 0) token.pop_back();
  if (token.size() < kShortestToken || token.size() > kLongestToken) {
    return wrong("a token has 22 to 256 characters", kMake);
  }
  return token;
}

}  // namespace footlight::app

// SPDX-License-Identifier: Apache-2.0
#include "app/console/access.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <cerrno>
#include <cstring>
#include <random>
#include <utility>

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/random.h>
#include <sys/stat.h>
#include <unistd.h>

#include "core/check.hpp"
#include "core/file_descriptor.hpp"
#include "core/secret.hpp"

namespace footlight::app {
namespace {

constexpr std::size_t kTokenBytes = 32;
constexpr std::size_t kShortestToken = 32;
constexpr std::size_t kLongestToken = 256;

std::string lower(std::string_view text) {
  std::string out(text);
  std::ranges::transform(out, out.begin(), [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return out;
}

void fill_random(void* bytes, std::size_t size) {
  auto* at = static_cast<unsigned char*>(bytes);
  while (size > 0) {
    const ssize_t got = ::getrandom(at, size, 0);
    if (got < 0 && errno == EINTR) continue;
    FL_CHECK(got > 0);
    at += got;
    size -= static_cast<std::size_t>(got);
  }
}

std::string reason() { return std::strerror(errno); }  // NOLINT(concurrency-mt-unsafe)

Result<std::string> make_token(const std::filesystem::path& file) {
  const FileDescriptor made(::open(file.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC | O_NOFOLLOW, 0600));
  if (made.get() < 0) return input_error(fmt::format("console token {}: {}", file.string(), reason()));
  const std::string token = random_hex(kTokenBytes);
  const std::string line = token + "\n";
  if (::write(made.get(), line.data(), line.size()) != static_cast<ssize_t>(line.size())) {
    const std::string why = reason();
    (void)::unlink(file.c_str());
    return input_error(fmt::format("console token {}: {}", file.string(), why));
  }
  return token;
}

}  // namespace

std::string_view to_text(Role role) {
  switch (role) {
    case Role::view:
      return "view";
    case Role::operate:
      return "operate";
    case Role::admin:
      return "admin";
  }
  return "";
}

std::optional<Role> paired_role_from(std::string_view text) {
  if (text == "view") return Role::view;
  if (text == "operate") return Role::operate;
  return std::nullopt;
}

std::string random_hex(std::size_t bytes) {
  std::string raw(bytes, '\0');
  fill_random(raw.data(), raw.size());
  std::string out;
  for (const char byte : raw) out += fmt::format("{:02x}", static_cast<unsigned char>(byte));
  return out;
}

Result<std::string> token_in(const std::filesystem::path& file) {
  const FileDescriptor there(::open(file.c_str(), O_RDONLY | O_CLOEXEC | O_NOFOLLOW | O_NONBLOCK));
  if (there.get() < 0 && errno == ENOENT) return make_token(file);
  const auto wrong = [&](const std::string& why) {
    return input_error(fmt::format("console token {}: {}", file.string(), why));
  };
  if (there.get() < 0) return wrong(reason());
  struct stat status {};
  if (::fstat(there.get(), &status) != 0) return wrong(reason());
  if (!S_ISREG(status.st_mode)) return wrong("is no file");
  if (status.st_uid != ::geteuid()) return wrong("belongs to somebody else");
  if ((status.st_mode & 077) != 0) {
    return wrong(
        fmt::format("others may read it (mode {:o}); chmod 600 it, or remove it for a new one", status.st_mode & 0777));
  }
  std::array<char, kLongestToken + 2> bytes{};
  const ssize_t got = ::read(there.get(), bytes.data(), bytes.size());
  if (got < 0) return wrong(reason());
  std::string token(bytes.data(), static_cast<std::size_t>(got));
  while (!token.empty() && std::isspace(static_cast<unsigned char>(token.back())) != 0) token.pop_back();
  const bool plain = std::ranges::all_of(token, [](char c) { return c > ' ' && c <= '~'; });
  if (token.size() < kShortestToken || token.size() > kLongestToken || !plain) {
    return wrong(fmt::format("holds no token: {} to {} characters from ! to ~; remove it for a new one", kShortestToken,
                             kLongestToken));
  }
  return token;
}

void AllowedHosts::add(std::string authority) { hosts_.push_back(lower(authority)); }

bool AllowedHosts::has_host(std::string_view host) const {
  return std::ranges::find(hosts_, lower(host)) != hosts_.end();
}

std::string Pairing::make(Role role, Instant now) {
  constexpr std::uint64_t kCodes = 100'000'000;
  constexpr std::uint64_t kFair = UINT64_MAX / kCodes * kCodes;
  std::uint64_t number = 0;
  do {
    fill_random(&number, sizeof number);
  } while (number >= kFair);
  if (codes_.size() >= kMostCodes) codes_.erase(codes_.begin());
  codes_.push_back({fmt::format("{:08}", number % kCodes), role, now + kGoodFor, 0});
  return codes_.back().digits;
}

std::optional<Pairing::Paired> Pairing::redeem(std::string_view code, Instant now) {
  std::erase_if(codes_, [&](const Code& one) { return now >= one.until || one.wrong >= kWrongTries; });
  auto found = codes_.end();
  for (auto one = codes_.begin(); one != codes_.end(); ++one) {
    if (same_secret(one->digits, code)) found = one;
  }
  if (found == codes_.end() || tokens_.size() >= kMostTokens) {
    for (Code& one : codes_) ++one.wrong;
    return std::nullopt;
  }
  tokens_.push_back({random_hex(kTokenBytes), found->role});
  codes_.erase(found);
  return tokens_.back();
}

std::optional<Role> Pairing::role_of(std::string_view token) const {
  std::optional<Role> role;
  for (const Paired& one : tokens_) {
    if (same_secret(one.token, token)) role = one.role;
  }
  return role;
}

}  // namespace footlight::app

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <cstring>
#include <mutex>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <unordered_map>
#include <vector>

#include "core/sha256.hpp"

namespace footlight::planner {

/// What a stage of planning depends on, in 128 bits of SHA-256.
using StageKey = std::array<std::uint8_t, 16>;

/// Makes the key of a stage out of everything that it depends on.
class StageHash {
 public:
  /// @param stage its name, so that equal inputs of different stages have different keys
  explicit StageHash(std::string_view stage) { sum_.text(stage); }

  template <class T>
  requires std::is_arithmetic_v<T> || std::is_enum_v<T> StageHash& add(T value) {
    if constexpr (std::is_floating_point_v<T>) {
      sum_.real(value);
    } else {
      sum_.integer(static_cast<std::int64_t>(value));
    }
    return *this;
  }
  StageHash& add(std::string_view text) {
    sum_.text(text);
    return *this;
  }
  StageHash& add(const StageKey& key) {
    sum_.bytes(key);
    return *this;
  }
  /// A list of values without padding: its bytes, its length first.
  template <class T>
  requires std::has_unique_object_representations_v<T> || std::is_floating_point_v<T> StageHash& list(
      std::span<const T> values) {
    sum_.integer(static_cast<std::int64_t>(values.size()));
    sum_.bytes({reinterpret_cast<const std::uint8_t*>(values.data()), values.size_bytes()});
    return *this;
  }
  template <class T>
  StageHash& list(const std::vector<T>& values) {
    return list(std::span<const T>(values));
  }
  [[nodiscard]] StageKey key();

 private:
  Sha256 sum_;
};

/// What a stage gave, as bytes: numbers as the machine has them, lists with their length first.
class StageWriter {
 public:
  template <class T>
  requires std::is_trivially_copyable_v<T> StageWriter& add(const T& value) {
    out_.append(reinterpret_cast<const char*>(&value), sizeof value);
    return *this;
  }
  template <class T>
  requires std::is_trivially_copyable_v<T> StageWriter& list(const std::vector<T>& values) {
    add(static_cast<std::uint64_t>(values.size()));
    out_.append(reinterpret_cast<const char*>(values.data()), values.size() * sizeof(T));
    return *this;
  }
  StageWriter& text(std::string_view value) {
    add(static_cast<std::uint64_t>(value.size()));
    out_.append(value);
    return *this;
  }
  [[nodiscard]] std::string take() { return std::move(out_); }

 private:
  std::string out_;
};

/// Reads what StageWriter wrote; bytes that are too few or too many make it `failed`, and all values 0.
class StageReader {
 public:
  explicit StageReader(std::string_view bytes) : rest_(bytes) {}

  template <class T>
  requires std::is_trivially_copyable_v<T> T get() {
    T value{};
    take(&value, sizeof value);
    return value;
  }
  template <class T>
  requires std::is_trivially_copyable_v<T> std::vector<T> list() {
    const auto size = get<std::uint64_t>();
    if (size > rest_.size() / sizeof(T)) failed_ = true;
    std::vector<T> values(failed_ ? 0 : size);
    take(values.data(), values.size() * sizeof(T));
    return values;
  }
  /// A text where it stands.
  std::string_view view() {
    const auto size = get<std::uint64_t>();
    if (failed_ || size > rest_.size()) {
      failed_ = true;
      return {};
    }
    const std::string_view out = rest_.substr(0, size);
    rest_.remove_prefix(size);
    return out;
  }
  std::string text() { return std::string(view()); }
  [[nodiscard]] bool failed() const { return failed_; }
  /// Whether everything was there, and nothing else.
  [[nodiscard]] bool whole() const { return !failed_ && rest_.empty(); }

 private:
  void take(void* to, std::size_t size) {
    if (failed_ || size > rest_.size()) {
      failed_ = true;
      return;
    }
    if (size > 0) std::memcpy(to, rest_.data(), size);
    rest_.remove_prefix(size);
  }

  std::string_view rest_;
  bool failed_ = false;
};

/// What the stages of an earlier planning gave, by the hash of what each depends on. A stage whose inputs are the same
/// is taken from here, so that a plan made with it is the plan made without, byte for byte.
/// Thread: find and keep may be called at the same time.
class Stages {
 public:
  /// What a stage gave; nothing when it has not been planned with these inputs. Valid until `forget_unused`.
  [[nodiscard]] std::optional<std::string_view> find(const StageKey& key);
  void keep(const StageKey& key, std::string value);
  /// From a file; not used yet.
  void load(const StageKey& key, std::string_view value);
  /// Leaves only what was found or kept since this was called last.
  void forget_unused();

  /// Every stage by key, ascending.
  [[nodiscard]] std::vector<std::pair<StageKey, std::string_view>> all() const;
  [[nodiscard]] std::size_t size() const { return entries_.size(); }

 private:
  struct KeyHash {
    std::size_t operator()(const StageKey& key) const noexcept {
      std::size_t out = 0;
      std::memcpy(&out, key.data(), sizeof out);
      return out;
    }
  };
  struct Entry {
    std::string value;
    bool used = false;
  };
  mutable std::mutex mutex_;
  std::unordered_map<StageKey, Entry, KeyHash> entries_;
};

/// What an earlier planning leaves for the next. Every stage (the formations of a section, the pairing of a transition,
/// the walks of an interval, its facts and proof) is known by the hash of all that it depends on: the plan is the one
/// made without, byte for byte.
struct Reuse {
  Stages* stages = nullptr;  ///< in: of earlier plannings; out: of this one alone
  /// For each section: names the film's bytes and how they are read; empty: unknown.
  std::vector<std::string> film_ids;
};

/// How many stages there are of a kind, and how many of them were planned anew.
struct StageCount {
  std::size_t all = 0;
  std::size_t anew = 0;

  /// One more, or one more of those that are here already is planned anew. Several threads may count at the same time.
  void add() { std::atomic_ref(all).fetch_add(1, std::memory_order_relaxed); }
  void add_anew() { std::atomic_ref(anew).fetch_add(1, std::memory_order_relaxed); }
};

/// The value of a stage: from `stages` (nothing: always anew), else made and kept there.
/// @param decode (StageReader&) -> Value  @param encode (const Value&) -> std::string  @param make () -> Value
/// @param stop what was made when it had become true is not kept; may be missing
template <class Decode, class Encode, class Make>
auto recall(Stages* stages, const StageKey& key, StageCount* count, Decode decode, Encode encode, Make make,
            const std::atomic<bool>* stop = nullptr) {
  if (count != nullptr) count->add();
  if (stages != nullptr) {
    if (const auto bytes = stages->find(key)) {
      StageReader reader(*bytes);
      auto value = decode(reader);
      if (reader.whole()) return value;
    }
  }
  if (count != nullptr) count->add_anew();
  auto value = make();
  if (stages != nullptr && (stop == nullptr || !stop->load())) stages->keep(key, encode(value));
  return value;
}

}  // namespace footlight::planner

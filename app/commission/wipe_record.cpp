// SPDX-License-Identifier: Apache-2.0
#include "app/commission/wipe_record.hpp"

#include <algorithm>
#include <system_error>

#include <nlohmann/json.hpp>

#include "app/commission/lamps.hpp"
#include "config/output_file.hpp"
#include "core/clock.hpp"

namespace footlight::app {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::size_t kMostBytes = std::size_t{1} << 20U;

std::filesystem::path file_of(const std::filesystem::path& state) { return state / "wipes.json"; }

std::string key_of(const std::string& show) {
  std::error_code error;
  const auto whole = std::filesystem::weakly_canonical(show, error);
  return error ? show : whole.string();
}

/// What was kept; an empty object where nothing was, or where it cannot be read.
Json read_records(const std::filesystem::path& state) {
  const auto text = config::read_file(file_of(state), kMostBytes);
  Json records = text ? Json::parse(*text, nullptr, false) : Json::object();
  return records.is_object() ? records : Json::object();
}

}  // namespace

Status<> record_wipe(const std::filesystem::path& state, const std::string& show, const Rig& rig) {
  std::error_code ignored;
  std::filesystem::create_directories(state, ignored);
  Json records = read_records(state);
  records[key_of(show)] = {{"places", places_digest(rig)}, {"confirmed_since_1970_s", to_seconds(wall_time())}};
  return config::write_file(file_of(state), records.dump(2) + "\n");
}

std::optional<std::string> wipe_note(const std::filesystem::path& state, const std::string& show, const Rig& rig) {
  if (std::ranges::all_of(rig.buses, [](const Bus& bus) { return bus.simulated(); })) return std::nullopt;
  const Json records = read_records(state);
  const auto found = records.find(key_of(show));
  if (found == records.end() || !found->is_object()) return std::nullopt;
  const auto places = found->find("places");
  if (places != found->end() && *places == places_digest(rig)) return std::nullopt;
  return "the rig has changed since somebody saw all rows and columns of its lamps (footlight commission wipes " +
         show + ")";
}

}  // namespace footlight::app

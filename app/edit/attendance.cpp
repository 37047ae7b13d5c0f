// SPDX-License-Identifier: Apache-2.0
#include "app/edit/attendance.hpp"

#include <system_error>

#include <nlohmann/json.hpp>

#include "config/output_file.hpp"
#include "config/plan_file.hpp"

namespace footlight::app {
namespace {

using Json = nlohmann::ordered_json;

constexpr const char* kFile = "taken.json";
constexpr const char* kPlan = "taken.plan";
constexpr std::size_t kMost_bytes = 16'000'000;

std::string whole(const std::string& show) {
  std::error_code error;
  return std::filesystem::weakly_canonical(show, error).string();
}

std::set<std::string> ids_in(const Json& list) {
  std::set<std::string> out;
  if (!list.is_array()) return out;
  for (const Json& id : list) {
    if (id.is_string()) out.insert(id.get<std::string>());
  }
  return out;
}

}  // namespace

void Attendance::put_into(std::vector<std::string>& absent_ids, std::vector<std::string>& cover_pairs) const {
  absent_ids.insert(absent_ids.end(), repaired.begin(), repaired.end());
  for (const auto& [id, cover] : covers) cover_pairs.push_back(id + "=" + cover);
}

Status<> keep_taken(const std::filesystem::path& folder, const std::string& show, const std::string& show_hash,
                    const Attendance& attendance, const std::filesystem::path& plan_file) {
  std::error_code error;
  std::filesystem::copy_file(plan_file, folder / kPlan, std::filesystem::copy_options::overwrite_existing, error);
  if (error) return input_error("cannot write '" + (folder / kPlan).string() + "': " + error.message());
  const Json document{{"show", whole(show)},
                      {"show_hash", show_hash},
                      {"absent", attendance.absent},
                      {"covers", attendance.covers},
                      {"repaired", attendance.repaired}};
  return config::write_file(folder / kFile, document.dump(1, ' ', false, Json::error_handler_t::replace) + "\n");
}

Attendance take_up_taken(const std::filesystem::path& folder, PlanChoice& choice) {
  const auto text = config::read_file(folder / kFile, kMost_bytes);
  const Json kept = text ? Json::parse(*text, nullptr, false) : Json();
  if (!kept.is_object() || kept.value("show", Json()) != whole(choice.show)) return {};
  const auto loaded = config::load_show(choice.show);
  const auto hash = loaded ? config::hash_files(loaded->planned_files) : Result<std::string>(std::string());
  if (!hash || kept.value("show_hash", Json()) != *hash) return {};
  Attendance out{ids_in(kept.value("absent", Json())), {}, ids_in(kept.value("repaired", Json()))};
  const Json covers = kept.value("covers", Json::object());
  for (const auto& [id, cover] : covers.items()) {
    if (cover.is_string()) out.covers[id] = cover.get<std::string>();
  }
  out.put_into(choice.absent, choice.covers);
  choice.plan = (folder / kPlan).string();
  return out;
}

void forget_taken(const std::filesystem::path& folder) {
  std::error_code error;
  std::filesystem::remove(folder / kFile, error);
  std::filesystem::remove(folder / kPlan, error);
}

}  // namespace footlight::app

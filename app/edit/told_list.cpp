// SPDX-License-Identifier: Apache-2.0
#include "app/edit/told_list.hpp"

#include <algorithm>
#include <system_error>
#include <utility>

#include <nlohmann/json.hpp>

#include "app/natural_order.hpp"
#include "config/output_file.hpp"

namespace footlight::app {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::size_t kMost_bytes = 16'000'000;

}  // namespace

ToldList::ToldList(const std::filesystem::path& folder, const std::string& show) : file_(folder / "untold.json") {
  std::error_code error;
  show_ = std::filesystem::weakly_canonical(show, error).string();
  sort();
  const auto text = config::read_file(file_, kMost_bytes);
  const Json left = text ? Json::parse(*text, nullptr, false) : Json();
  if (!left.is_object() || !left.contains("show") || left["show"] != show_ || !left.contains("untold")) return;
  for (const Json& person : left["untold"]) {
    if (person.is_string()) people_.insert(person.get<std::string>());
  }
  sort();
}

void ToldList::sort() {
  std::vector<std::string> list(people_.begin(), people_.end());
  std::ranges::sort(list, natural_less);
  list_ = std::make_shared<const std::vector<std::string>>(std::move(list));
}

Status<> ToldList::add(const std::vector<std::string>& people) {
  people_.insert(people.begin(), people.end());
  return write();
}

Status<> ToldList::tick(const std::string& person) {
  people_.erase(person);
  return write();
}

Status<> ToldList::tick_all() {
  people_.clear();
  return write();
}

Status<> ToldList::write() {
  sort();
  const Json document{{"show", show_}, {"untold", *list_}};
  return config::write_file(file_, document.dump(1, ' ', false, Json::error_handler_t::replace) + "\n");
}

}  // namespace footlight::app

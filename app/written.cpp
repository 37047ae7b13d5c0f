// SPDX-License-Identifier: Apache-2.0
#include "app/written.hpp"

#include <nlohmann/json.hpp>

namespace footlight::app {

using Json = nlohmann::ordered_json;

Json json_of(const Stamp& stamp) {
  return {{"title", stamp.title}, {"version", stamp.version}, {"show", stamp.show},
          {"plan", stamp.plan},   {"valid", stamp.valid},     {"footlight", FOOTLIGHT_VERSION}};
}

Json written_json(const Stamp& stamp, const std::vector<std::string>& files) {
  Json out = json_of(stamp);
  out["files"] = files;
  return out;
}

}  // namespace footlight::app

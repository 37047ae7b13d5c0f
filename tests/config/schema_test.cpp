// SPDX-License-Identifier: Apache-2.0
#include <fstream>
#include <set>
#include <sstream>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "config/field.hpp"
#include "config/remote_file.hpp"
#include "config/show_file.hpp"

namespace footlight::config {
namespace {

std::string content(const std::string& file) {
  std::ostringstream out;
  out << std::ifstream(std::string(FOOTLIGHT_SOURCE_DIR) + "/" + file, std::ios::binary).rdbuf();
  return out.str();
}

constexpr const char* kRemedy = "run: footlight-schema SOURCE_TREE";

TEST(Schema, OfShowsIsTheOneCheckedIn) { EXPECT_EQ(content("docs/schema/show.schema.json"), show_schema()) << kRemedy; }
TEST(Schema, OfRigsIsTheOneCheckedIn) { EXPECT_EQ(content("docs/schema/rig.schema.json"), rig_schema()) << kRemedy; }
TEST(Schema, OfProfilesIsTheOneCheckedIn) {
  EXPECT_EQ(content("docs/schema/profile.schema.json"), profile_schema()) << kRemedy;
}

TEST(Schema, OfRemoteControlIsTheOneCheckedIn) {
  EXPECT_EQ(content("docs/schema/remote.schema.json"), remote_schema()) << kRemedy;
}

TEST(Schema, NamesItsDraftAndRefusesUnknownKeys) {
  const auto schema = nlohmann::json::parse(show_schema());
  EXPECT_EQ(schema["$schema"], "https://json-schema.org/draft/2020-12/schema");
  EXPECT_EQ(schema["additionalProperties"], false);
  EXPECT_EQ(schema["required"], (nlohmann::json{"footlight", "title", "stage", "performers", "sections"}));
  const auto& grid = schema["properties"]["stage"]["properties"]["grid"];
  EXPECT_EQ(grid["properties"]["columns"]["maximum"], 4096);
  EXPECT_EQ(grid["properties"]["kind"]["enum"], (nlohmann::json{"square", "hexagonal", "triangular"}));
  EXPECT_EQ(grid["properties"]["pitch"]["default"], "1 m");
}

TEST(Reference, TablesOfTheDocumentationAreMadeFromTheListings) {
  const std::string page = content("docs/show-file.md");
  EXPECT_NE(page.find(show_reference()), std::string::npos) << kRemedy;
}

void expect_documented(const Listing& listing) {
  std::set<std::string_view> keys;
  for (const Field& field : listing.fields) {
    EXPECT_TRUE(keys.insert(field.key).second) << listing.name << "." << field.key;
    EXPECT_FALSE(field.doc.empty()) << listing.name << "." << field.key;
    EXPECT_EQ(field.doc.back(), '.') << listing.name << "." << field.key;
    const bool one_of = listing.one_of.find(field.key) != std::string_view::npos;
    EXPECT_EQ(1, static_cast<int>(field.required) + static_cast<int>(!field.fallback.empty()) +
                     static_cast<int>(!field.otherwise.empty()) + static_cast<int>(one_of))
        << listing.name << "." << field.key << ": exactly one of required, default, words for the default";
    EXPECT_EQ(field.type == Type::choice, !field.choices.empty()) << field.key;
    if (field.listing != nullptr) expect_documented(*field.listing);
  }
}

TEST(Listings, SayOfEveryKeyWhatItIsAndWhatHoldsWithoutIt) {
  for (const Listing* listing : {&show_listing(), &rig_listing(), &profile_listing(), &remote_listing()})
    expect_documented(*listing);
}

}  // namespace
}  // namespace footlight::config

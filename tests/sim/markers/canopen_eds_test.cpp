// SPDX-License-Identifier: Apache-2.0
// docs/footlight-marker.eds is what engineering tools know of a marker: it must be what the marker answers.
#include <cstdlib>
#include <fstream>
#include <map>
#include <set>
#include <string>

#include <gtest/gtest.h>

#include "sim/markers/canopen_objects.hpp"

namespace footlight::sim {
namespace {

constexpr std::uint8_t kId = 5;

using Section = std::map<std::string, std::string>;

std::map<std::string, Section> read_eds() {
  std::ifstream file(FOOTLIGHT_SOURCE_DIR "/docs/footlight-marker.eds");
  EXPECT_TRUE(file);
  std::map<std::string, Section> sections;
  std::string section;
  for (std::string line; std::getline(file, line);) {
    if (line.empty()) continue;
    if (line.front() == '[') {
      section = line.substr(1, line.find(']') - 1);
      EXPECT_EQ(sections.count(section), 0U) << section << " is there twice";
      sections[section];
      continue;
    }
    const auto equals = line.find('=');
    EXPECT_NE(equals, std::string::npos) << line;
    sections[section][line.substr(0, equals)] = line.substr(equals + 1);
  }
  return sections;
}

std::uint32_t number(const std::string& text) {
  constexpr std::string_view kNode = "$NODEID+";
  if (text.rfind(kNode, 0) == 0) return kId + number(text.substr(kNode.size()));
  return static_cast<std::uint32_t>(std::strtoul(text.c_str(), nullptr, 0));
}

struct Entry {
  std::string name;
  int type = 0;
  std::string access;
  std::string value;  ///< empty: none is given
};
using Place = std::pair<std::uint16_t, std::uint8_t>;

/// Every object with its sub-indices; compact arrays spread out.
std::map<Place, Entry> entries(const std::map<std::string, Section>& sections) {
  std::map<Place, Entry> found;
  for (const auto& [name, section] : sections) {
    if (name.find_first_not_of("0123456789ABCDEFsub") != std::string::npos || section.count("ParameterName") == 0)
      continue;
    const auto index = static_cast<std::uint16_t>(std::strtoul(name.substr(0, 4).c_str(), nullptr, 16));
    if (section.count("SubNumber") != 0) continue;
    const auto text = [&](const char* key) { return section.count(key) == 0 ? std::string() : section.at(key); };
    Entry entry{text("ParameterName"), static_cast<int>(number(text("DataType"))), text("AccessType"),
                text("DefaultValue")};
    if (section.count("CompactSubObj") == 0) {
      const auto sub = name.size() > 4 ? std::strtoul(name.substr(7).c_str(), nullptr, 16) : 0;
      found[{index, static_cast<std::uint8_t>(sub)}] = entry;
      continue;
    }
    const std::uint32_t last = number(text("CompactSubObj"));
    found[{index, 0}] = {"Highest sub-index", 5, "const", text("CompactSubObj")};
    for (std::uint32_t sub = 1; sub <= last; ++sub) found[{index, static_cast<std::uint8_t>(sub)}] = entry;
  }
  return found;
}

class CanopenEds : public ::testing::Test {
 protected:
  CanopenEds() { model_.power_on(kStart); }
  std::map<std::string, Section> sections_ = read_eds();
  std::map<Place, Entry> entries_ = entries(sections_);
  NodeModel model_{32, true};
  CanopenObjects::Counters counters_;
  CanopenObjects objects_{kId, 0x12345678, model_, counters_};
};

TEST_F(CanopenEds, EveryObjectOfTheFileIsInTheMarkerWithItsTypeAndValue) {
  EXPECT_GT(entries_.size(), 600U);
  const std::map<int, std::size_t> sizes{{5, 1}, {6, 2}, {7, 4}};
  for (const auto& [place, entry] : entries_) {
    std::vector<std::uint8_t> bytes;
    ASSERT_EQ(objects_.read(place.first, place.second, bytes), SdoAbort::none)
        << std::hex << place.first << ':' << int{place.second} << ' ' << entry.name;
    if (entry.type == 9) {
      EXPECT_EQ(std::string(bytes.begin(), bytes.end()), entry.value);
      continue;
    }
    EXPECT_EQ(bytes.size(), sizes.at(entry.type)) << std::hex << place.first << ':' << int{place.second};
    std::uint32_t value = 0;
    for (std::size_t i = 0; i < bytes.size(); ++i) value |= std::uint32_t{bytes[i]} << (8 * i);
    if (!entry.value.empty()) {
      EXPECT_EQ(value, number(entry.value)) << std::hex << place.first << ':' << int{place.second} << ' ' << entry.name;
    } else {
      EXPECT_NE(entry.access, "const") << entry.name << " has no value";
    }
  }
}

TEST_F(CanopenEds, WhatMayBeWrittenIsWhatTheFileSays) {
  for (const auto& [place, entry] : entries_) {
    std::vector<std::uint8_t> bytes;
    ASSERT_EQ(objects_.read(place.first, place.second, bytes), SdoAbort::none);
    const SdoAbort written = objects_.write(place.first, place.second, bytes, kStart);
    EXPECT_EQ(written, entry.access == "rw" ? SdoAbort::none : SdoAbort::read_only)
        << std::hex << place.first << ':' << int{place.second} << ' ' << entry.name;
  }
}

TEST_F(CanopenEds, EveryObjectOfTheMarkerIsInTheFileAndInItsLists) {
  std::set<std::uint16_t> listed;
  for (const char* list : {"MandatoryObjects", "OptionalObjects", "ManufacturerObjects"}) {
    for (const auto& [key, value] : sections_.at(list)) {
      if (key == "SupportedObjects") continue;
      EXPECT_TRUE(listed.insert(static_cast<std::uint16_t>(number(value))).second) << value;
    }
    EXPECT_EQ(number(sections_.at(list).at("SupportedObjects")), sections_.at(list).size() - 1) << list;
  }
  std::vector<std::uint8_t> bytes;
  for (std::uint32_t index = 0x1000; index < 0x10000; ++index) {
    const auto object = static_cast<std::uint16_t>(index);
    const bool there = objects_.read(object, 0, bytes) != SdoAbort::no_object;
    EXPECT_EQ(there, listed.count(object) == 1) << std::hex << index;
    for (int sub = 0; there && sub < 256; ++sub) {
      const auto part = static_cast<std::uint8_t>(sub);
      EXPECT_EQ(objects_.read(object, part, bytes) == SdoAbort::none, entries_.count({object, part}) == 1)
          << std::hex << index << ':' << sub;
    }
  }
}

TEST_F(CanopenEds, RecordsHaveAsManyPartsAsTheySay) {
  for (const auto& [name, section] : sections_) {
    if (section.count("SubNumber") == 0) continue;
    const auto index = static_cast<std::uint16_t>(std::strtoul(name.c_str(), nullptr, 16));
    std::size_t parts = 0;
    for (const auto& [place, entry] : entries_) parts += place.first == index ? 1 : 0;
    EXPECT_EQ(parts, number(section.at("SubNumber"))) << name;
  }
}

}  // namespace
}  // namespace footlight::sim

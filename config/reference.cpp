// SPDX-License-Identifier: Apache-2.0
#include "config/field.hpp"
#include "config/show_file.hpp"

namespace footlight::config {
namespace {

std::string code(std::string_view text) { return "`" + std::string(text) + "`"; }

std::string type_and_unit(const Field& field) {
  const std::string name = type_name(field);
  if (!is_quantity(field.type)) return name;
  return name + " (" + units_of(dimension_of(field.type)) + ")";
}

std::string fallback_of(const Field& field) {
  if (field.required) return "**required**";
  if (!field.fallback.empty()) return code(field.fallback);
  return field.otherwise.empty() ? "-" : std::string(field.otherwise);
}

std::string range_of(const Field& field) {
  if (!field.choices.empty()) {
    std::string out;
    for (const std::string_view choice : field.choices) out += (out.empty() ? "" : ", ") + code(choice);
    return out;
  }
  const std::string unit = is_quantity(field.type) ? std::string(base_unit(dimension_of(field.type))) : "";
  return to_text(field.range, unit);
}

void add_tables(std::string& out, const Listing& listing) {
  out += "### " + code(listing.name) + "\n\n" + std::string(listing.doc);
  if (!listing.one_of.empty()) {
    out += " Exactly one of";
    for (std::string_view rest = listing.one_of; !rest.empty();) {
      const std::string_view word = rest.substr(0, rest.find(' '));
      rest.remove_prefix(std::min(rest.size(), word.size() + 1));
      out += " " + code(word) + (rest.empty() ? "" : ",");
    }
    out += " is given.";
  }
  out += "\n\n| key | type (units) | default | range | meaning |\n|---|---|---|---|---|\n";
  for (const Field& field : listing.fields) {
    out += "| " + code(field.key) + " | " + type_and_unit(field) + " | " + fallback_of(field) + " | " +
           range_of(field) + " | " + std::string(field.doc) + " |\n";
  }
  out += "\n";
  for (const Field& field : listing.fields) {
    if (field.listing != nullptr) add_tables(out, *field.listing);
  }
}

}  // namespace

std::string show_reference() {
  std::string out = "## Keys of the show file\n\n";
  add_tables(out, show_listing());
  out += "## Keys of the rig file\n\n";
  add_tables(out, rig_listing());
  out += "## Keys of a device profile\n\n";
  add_tables(out, profile_listing());
  out += "## Keys of the remote control file\n\n";
  add_tables(out, remote_listing());
  return out;
}

}  // namespace footlight::config

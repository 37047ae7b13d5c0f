// SPDX-License-Identifier: Apache-2.0
#include "config/device_profile.hpp"

#include <algorithm>
#include <cstdlib>
#include <set>
#include <vector>

#include "config/mapping_reader.hpp"
#include "config/nearest.hpp"
#include "config/profile_file.hpp"
#include "core/time.hpp"

namespace footlight::config {
namespace {

std::vector<std::filesystem::path> shipped_folders() {
  std::vector<std::filesystem::path> out;
  if (const char* data = std::getenv("FOOTLIGHT_DATA");
      data != nullptr && *data != '\0') {  // NOLINT(concurrency-mt-unsafe)
    out.push_back(std::filesystem::path(data) / "profiles");
  }
  std::error_code error;
  const auto program = std::filesystem::read_symlink("/proc/self/exe", error);
  if (!error) out.push_back(program.parent_path().parent_path() / "share" / "footlight" / "profiles");
  out.emplace_back(FOOTLIGHT_PROFILES);
  return out;
}

}  // namespace

std::optional<std::filesystem::path> find_profile(const std::string& name, const std::filesystem::path& folder) {
  std::error_code error;
  const auto extension = std::filesystem::path(name).extension();
  if (extension == ".yaml" || extension == ".yml") {
    auto file = (folder / name).lexically_normal();
    if (std::filesystem::is_regular_file(file, error)) return file;
    return std::nullopt;
  }
  if (name.find('/') != std::string::npos) return std::nullopt;
  for (const auto& shipped : shipped_folders()) {
    auto file = shipped / (name + ".yaml");
    if (std::filesystem::is_regular_file(file, error)) return file;
  }
  return std::nullopt;
}

std::vector<std::string> shipped_profiles() {
  std::set<std::string> names;
  for (const auto& folder : shipped_folders()) {
    std::error_code error;
    for (const auto& entry : std::filesystem::directory_iterator(folder, error)) {
      if (entry.path().extension() == ".yaml") names.insert(entry.path().stem().string());
    }
  }
  return {names.begin(), names.end()};
}

namespace {

/// Reads one profile; what is wrong with it goes to its diagnostics.
class ProfileReader {
 public:
  explicit ProfileReader(MappingReader& root) : root_(root) {}

  ModbusProfile read() {
    (void)root_.integer("profile");
    out_.name = root_.text("name").value_or("");
    out_.channels = root_.integer("channels").value_or(kChannelsPerNode);
    out_.coils = root_.has("look_coil");
    out_.look_register = root_.integer(out_.coils ? "look_coil" : "look_register").value_or(0);
    out_.looks_per_register = root_.integer("looks_per_register").value_or(2);
    out_.has_preload_sequence = root_.boolean("preload_sequence").value_or(false);
    out_.readable_looks = root_.boolean("readback").value_or(false);
    out_.latch_register = root_.integer("latch_register");
    out_.heartbeat_register = root_.integer("heartbeat_register");
    out_.status_register = root_.integer("status_register");
    out_.look_table_register = root_.integer("look_table_register");
    read_palette();
    read_states();
    read_service();
    read_quirks();
    check_together();
    return std::move(out_);
  }

 private:
  static std::optional<Colour> read_colour(MappingReader& reader) {
    const auto written = reader.written("colour");
    if (!written) return std::nullopt;
    const auto colour = parse_colour(written->text);
    if (!colour) reader.error(*written, in_quotes(written->text) + " is not a colour", "#RRGGBB");
    return colour;
  }

  void read_palette() {
    bool dark = false;
    bool lit = false;
    std::set<int> values;
    for (MappingReader& entry : root_.mappings("palette")) {
      const auto value = entry.integer("value");
      const auto colour = read_colour(entry);
      const auto effect = entry.choice("effect");
      const auto brightness = entry.integer("brightness");
      if (!value || !colour || !effect || !brightness) continue;
      if (!values.insert(*value).second) {
        entry.error("value", "the value " + std::to_string(*value) + " stands here for the second time", "each once");
      }
      (*colour == Colour{} || *brightness == 0 ? dark : lit) = true;
      out_.palette.push_back(
          {*value, Look{*colour, static_cast<Effect>(*effect), static_cast<std::uint8_t>(*brightness)}});
    }
    if (out_.palette.empty() || (dark && lit)) return;
    root_.error("palette", dark ? "the palette has nothing that is lit" : "the palette has nothing dark",
                "an entry of colour \"#000000\" and one of another colour");
  }

  void read_states() {
    if (!root_.has("states")) return;
    auto reader = root_.mapping("states");
    if (!reader) return;
    StateTable table;
    table.first_register = reader->integer("register").value_or(0);
    table.stride = reader->integer("stride").value_or(1000);
    table.count = reader->integer("count").value_or(1);
    for (MappingReader& code : reader->mappings("effects")) {
      const auto effect = code.choice("effect");
      const auto value = code.integer("value");
      if (effect && value) table.effects.push_back({*value, static_cast<Effect>(*effect)});
    }
    for (MappingReader& code : reader->mappings("colours")) {
      const auto colour = read_colour(code);
      const auto value = code.integer("value");
      if (colour && value) table.colours.push_back({*value, *colour});
    }
    for (MappingReader& code : reader->mappings("brightnesses")) {
      const auto brightness = code.integer("brightness");
      const auto value = code.integer("value");
      if (brightness && value) table.brightnesses.push_back({*value, *brightness});
    }
    table.effect_offset = offset(*reader, "effect_at", "effects", table.stride);
    table.colour_offset = offset(*reader, "colour_at", "colours", table.stride);
    table.brightness_offset = offset(*reader, "brightness_at", "brightnesses", table.stride);
    if (!table.effect_offset && !table.colour_offset && !table.brightness_offset) {
      reader->error(reader->position(), reader->path(), "the states say neither effect nor colour nor brightness",
                    "give at least one of effect_at, colour_at, brightness_at");
    }
    out_.states = std::move(table);
  }

  static std::optional<int> offset(MappingReader& reader, std::string_view key, std::string_view codes, int stride) {
    const auto value = reader.integer(key);
    if (!value) {
      if (reader.has(codes) && !reader.has(key)) {
        reader.error(codes, "the states have " + std::string(codes) + " and nowhere to write them",
                     "give " + std::string(key) + " as well");
      }
      return std::nullopt;
    }
    if (*value >= stride) {
      reader.error(key, "the register " + std::to_string(*value) + " belongs to the next state",
                   "below the stride of " + std::to_string(stride));
    }
    if (!reader.has(codes)) {
      reader.error(key, "the device's numbers of its " + std::string(codes) + " are missing",
                   "list them under " + std::string(codes));
    }
    return value;
  }

  void read_service() {
    out_.identity_register = root_.integer("identity_register");
    out_.identity_registers = root_.integer("identity_registers").value_or(1);
    out_.identity_is_text = root_.boolean("identity_text").value_or(false);
    out_.unique_id_register = root_.integer("unique_id_register");
    out_.identify_register = root_.integer("identify_register");
    out_.address_register = root_.integer("address_register");
    out_.readdress_register = root_.integer("readdress_register");
    for (MappingReader& entry : root_.mappings("health")) {
      HealthRegister health;
      health.name = entry.text("name").value_or("");
      health.number = entry.integer("register").value_or(0);
      health.scale = entry.number("scale").value_or(1);
      health.unit = entry.text("unit").value_or("");
      health.has_sign = entry.boolean("signed").value_or(false);
      out_.health.push_back(std::move(health));
    }
  }

  void read_quirks() {
    out_.low_word_first = root_.choice("word_order") == 1;
    out_.pause_after_write = seconds(root_.quantity("pause_after_write").value_or(0));
    const auto& known = profile_listing().find("quirks")->choices;
    for (const Written& written : root_.list("quirks")) {
      const auto at = std::find(known.begin(), known.end(), written.text);
      if (at == known.end()) {
        root_.error(written, in_quotes(written.text) + " is not a quirk that we know",
                    suggestion(written.text, {known.begin(), known.end()}, "quirks"));
      }
      if (written.text == "no-broadcast") out_.has_broadcast = false;
      if (written.text == "write-one-by-one") out_.writes_one_by_one = true;
      if (written.text == "restart-for-address") out_.restarts_for_address = true;
    }
  }

  /// Keys that are right by themselves and mean nothing together.
  void check_together() {
    if (out_.has_preload_sequence && out_.coils) {
      root_.error("preload_sequence", "coils have no room for a sequence", "false, or look_register");
    }
    if (out_.has_preload_sequence && out_.writes_one_by_one) {
      root_.error("preload_sequence",
                  "a sequence and its looks are one write, and this device takes one register at a "
                  "time",
                  "false, or no quirk write-one-by-one");
    }
    if (out_.coils && root_.has("looks_per_register")) {
      root_.error(root_.key_position("looks_per_register"), root_.path("looks_per_register"),
                  "the key has no meaning here", "only registers hold several looks");
    }
    if (!out_.palette.empty() && (out_.states || out_.look_table_register)) {
      root_.error("palette", "a device with a palette has no look table to fill",
                  "give one of palette, states, look_table_register");
    } else if (out_.states && (out_.look_table_register || out_.coils)) {
      root_.error("states", out_.coils ? "coils cannot select a state" : "the device has two look tables",
                  out_.coils ? "look_register" : "give one of states, look_table_register");
    }
    if (out_.readdress_register && !out_.unique_id_register) {
      root_.error("readdress_register", "nobody can be meant without a unique id", "give unique_id_register as well");
    }
    const int registers = out_.has_preload_sequence ? 1 : 0;
    const int per = out_.coils ? 1 : out_.looks_per_register;
    if (out_.look_register + registers + (out_.channels + per - 1) / per > 65'536) {
      root_.error(out_.coils ? "look_coil" : "look_register",
                  "the looks of " + std::to_string(out_.channels) + " channels go beyond 65535", "a smaller number");
    }
    if (out_.states && out_.states->first_register + out_.states->count * out_.states->stride > 65'536) {
      root_.error("states", "the states go beyond register 65535", "a smaller register, stride or count");
    }
  }

  MappingReader& root_;
  ModbusProfile out_;
};

}  // namespace

std::optional<ModbusProfile> read_profile(const std::filesystem::path& file, Diagnostics& diagnostics,
                                          std::optional<LampCurrents>* currents) {
  return read_profile_file<ModbusProfile>(file, diagnostics, currents, [](MappingReader& root) {
    return is_profile_of(root, DeviceKind::modbus) ? ProfileReader(root).read() : ModbusProfile{};
  });
}

}  // namespace footlight::config

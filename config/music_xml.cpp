// SPDX-License-Identifier: Apache-2.0
#include "config/music_xml.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <utility>

#include <fmt/format.h>
#include <pugixml.hpp>

#include "config/nearest.hpp"
#include "config/quantity.hpp"
#include "config/repeats.hpp"
#include "config/text_scan.hpp"
#include "config/zip_file.hpp"

namespace footlight::config {
namespace {

constexpr const char* kContainer = "META-INF/container.xml";
constexpr std::uint64_t kMostContainerBytes = 1U << 20U;
constexpr double kSame = 1e-6;  // quarters: durations are whole numbers over whole numbers

/// What one measure holds, at places from its beginning.
struct Measure {
  double length = 0;   ///< in quarters, as the notes are; 0: none
  double nominal = 0;  ///< as the meter says
  bool implicit = false;
  std::vector<ScoreEvents::Tempo> tempos;
  std::vector<ScoreEvents::Rehearsal> rehearsals;
  std::optional<ScoreEvents::Meter> meter;
};

std::string trimmed(std::string_view text) {
  const std::size_t first = text.find_first_not_of(" \t\r\n");
  if (first == std::string_view::npos) return {};
  return std::string(text.substr(first, text.find_last_not_of(" \t\r\n") - first + 1));
}

/// A part after the other, measure by measure.
class ScoreReader {
 public:
  ScoreReader(std::string_view bytes, std::string file) : lines_(bytes), file_(std::move(file)) {}

  Result<ScoreEvents> read(const pugi::xml_document& document) {
    const pugi::xml_node root = document.document_element();
    if (std::string_view(root.name()) != "score-partwise") {
      return wrong(root, std::string_view(root.name()) == "score-timewise"
                             ? "a score-timewise (save it as score-partwise, as programs do by themselves)"
                             : fmt::format("{} is no MusicXML score (score-partwise)", in_quotes(root.name())));
    }
    for (const pugi::xml_node part : root.children("part")) {
      read_part(part);
      if (error_) return *std::move(error_);
      is_first_ = false;
    }
    if (measures_.empty()) return wrong(root, "no measure is in the score");
    return events();
  }

 private:
  Error wrong(const pugi::xml_node& node, const std::string& what) {
    const LineIndex::Place place =
        lines_.place_of(static_cast<std::size_t>(std::max<std::ptrdiff_t>(node.offset_debug(), 0)));
    return input_error(fmt::format("{}:{}:{}: error: {}", file_, place.line, place.column, what));
  }
  void fail(const pugi::xml_node& node, const std::string& what) {
    if (!error_) error_ = wrong(node, what);
  }
  /// A number of the whole text; otherwise the reading ends with an error here.
  double number(const pugi::xml_node& node, std::string_view text, double low, double high) {
    const auto value = parse_number(trimmed(text));
    if (value && *value >= low && *value <= high) return *value;
    fail(node, fmt::format("{} is no number of <{}> ({:g} to {:g})", in_quotes(text), node.name(), low, high));
    return low;
  }

  void read_part(const pugi::xml_node& part) {
    divisions_ = 0;
    meter_ = {};
    std::size_t i = 0;
    for (const pugi::xml_node measure : part.children("measure")) {
      if (i == measures_.size()) measures_.emplace_back();
      if (is_first_) {
        turns_.emplace_back();
        measures_[i].implicit = std::string_view(measure.attribute("implicit").value()) == "yes";
      }
      read_measure(measure, i++);
      if (error_) return;
    }
  }

  void read_measure(const pugi::xml_node& node, std::size_t i) {
    here_ = 0;
    double furthest = 0;
    for (const pugi::xml_node child : node.children()) {
      const std::string_view name = child.name();
      if (name == "attributes") {
        read_attributes(child, measures_[i]);
      } else if (name == "note") {
        if (!child.child("chord") && !child.child("grace")) here_ += duration(child);
        if (child.child("notations").child("fermata")) note_once("fermatas: nobody waits on them");
      } else if (name == "forward") {
        here_ += duration(child);
      } else if (name == "backup") {
        here_ = std::max(0.0, here_ - duration(child));
      } else if (name == "direction") {
        read_direction(child, measures_[i]);
      } else if (name == "sound") {
        read_sound(child, measures_[i], here_);
      } else if (name == "barline" && is_first_) {
        read_barline(child, turns_[i]);
      }
      furthest = std::max(furthest, here_);
      if (error_) return;
    }
    measures_[i].length = std::max(measures_[i].length, furthest);
    if (is_first_) measures_[i].nominal = meter_.beats * 4.0 / meter_.note;
  }

  double duration(const pugi::xml_node& node) {
    const pugi::xml_node written = node.child("duration");
    if (!written) {
      fail(node, fmt::format("a <{}> without a <duration>", node.name()));
      return 0;
    }
    if (divisions_ <= 0) {
      fail(node, "no <divisions> say before here how long a duration is");
      return 0;
    }
    return number(written, written.child_value(), 0, 1e9) / divisions_;
  }

  void read_attributes(const pugi::xml_node& node, Measure& measure) {
    if (const auto divisions = node.child("divisions")) {
      divisions_ = number(divisions, divisions.child_value(), 1e-3, 1e6);
    }
    const pugi::xml_node time = node.child("time");
    if (!time || time.child("senza-misura")) return;
    // 3+2 over 8: one measure of five.
    int beats = 0;
    std::string text = trimmed(time.child("beats").child_value());
    for (std::size_t start = 0; start <= text.size();) {
      const std::size_t plus = std::min(text.find('+', start), text.size());
      beats += static_cast<int>(number(time.child("beats"), text.substr(start, plus - start), 1, 64));
      start = plus + 1;
      if (error_) return;
    }
    const double note = number(time.child("beat-type"), time.child("beat-type").child_value(), 1, 64);
    if (error_) return;
    if (beats > 64 || std::exp2(std::round(std::log2(note))) != note) {
      return fail(time, fmt::format("a time signature of {}/{:g} (1 to 64 over 1, 2, 4 ... 64)", beats, note));
    }
    if (time.child("beats").next_sibling("beats")) {
      return fail(time, "a time signature of several (write one for each measure)");
    }
    meter_ = {0, beats, static_cast<int>(note)};
    if (!is_first_) return;
    measure.meter = meter_;
    if (here_ > kSame) note_once("a time signature in the middle of a measure holds from its beginning");
  }

  void read_direction(const pugi::xml_node& node, Measure& measure) {
    double at = here_;
    if (const auto offset = node.child("offset"); offset && divisions_ > 0) {
      at = std::max(0.0, at + number(offset, offset.child_value(), -1e9, 1e9) / divisions_);
    }
    const pugi::xml_node sound = node.child("sound");
    if (sound) read_sound(sound, measure, at);
    for (const pugi::xml_node type : node.children("direction-type")) {
      for (const pugi::xml_node child : type.children()) {
        const std::string_view name = child.name();
        if (name == "rehearsal") {
          add_rehearsal(measure, at, trimmed(child.child_value()));
        } else if (name == "metronome" && !sound.attribute("tempo")) {
          read_metronome(child, measure, at);
        } else if (name == "words") {
          read_words(trimmed(child.child_value()), sound.attribute("tempo"));
        }
      }
    }
  }

  static void add_rehearsal(Measure& measure, double at, std::string text) {
    const bool known = std::any_of(measure.rehearsals.begin(), measure.rehearsals.end(), [&](const auto& mark) {
      return mark.text == text && std::abs(mark.quarter - at) < kSame;
    });
    if (!text.empty() && !known) measure.rehearsals.push_back({at, std::move(text)});
  }

  void read_sound(const pugi::xml_node& node, Measure& measure, double at) {
    if (const auto tempo = node.attribute("tempo")) {
      add_tempo(measure, at, number(node, tempo.value(), 0, 1e6));
      if (std::as_const(measure).tempos.back().quarters_a_minute == 0) fail(node, "a tempo of 0");
    }
    for (const char* jump : {"dacapo", "dalsegno"}) {
      if (!node.attribute(jump)) continue;
      fail(node, fmt::format("a jump ({}) is not played out (write the music as it is played, or save it as MIDI)",
                             std::string_view(jump) == "dacapo" ? "da capo" : "dal segno"));
    }
  }

  static void add_tempo(Measure& measure, double at, double quarters_a_minute) {
    measure.tempos.push_back({at, quarters_a_minute});
  }

  void read_metronome(const pugi::xml_node& node, Measure& measure, double at) {
    constexpr std::array<std::pair<std::string_view, double>, 9> kNotes{{{"breve", 8},
                                                                         {"whole", 4},
                                                                         {"half", 2},
                                                                         {"quarter", 1},
                                                                         {"eighth", 0.5},
                                                                         {"16th", 0.25},
                                                                         {"32nd", 0.125},
                                                                         {"64th", 0.0625},
                                                                         {"long", 16}}};
    const std::string unit = trimmed(node.child("beat-unit").child_value());
    const auto* note =
        std::find_if(kNotes.begin(), kNotes.end(), [&](const auto& known) { return known.first == unit; });
    const auto bpm = parse_number(trimmed(node.child("per-minute").child_value()));
    if (note == kNotes.end() || !bpm || !(*bpm > 0 && *bpm < 1e5)) {
      return note_once(fmt::format(
          "metronome marks without a plain number (the first is in line {})",
          lines_.place_of(static_cast<std::size_t>(std::max<std::ptrdiff_t>(node.offset_debug(), 0))).line));
    }
    double quarters = note->second;
    double dot = quarters / 2;
    for ([[maybe_unused]] const auto dotted : node.children("beat-unit-dot")) {
      quarters += dot;
      dot /= 2;
    }
    add_tempo(measure, at, *bpm * quarters);
  }

  void read_words(const std::string& words, bool with_tempo) {
    if (with_tempo) return;
    std::string lower = words;
    std::transform(lower.begin(), lower.end(), lower.begin(),
                   [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; });
    constexpr std::array kGradual{"rit", "rall", "accel", "string", "allarg", "rubato", "a tempo"};
    for (const char* word : kGradual) {
      if (lower.find(word) == std::string::npos) continue;
      return note_once(fmt::format("{}: words do not change the tempo, marks do", in_quotes(words)));
    }
  }

  void read_barline(const pugi::xml_node& node, MeasureTurn& turn) {
    if (const auto ending = node.child("ending")) {
      const std::string_view type = ending.attribute("type").value();
      if (type == "start") turn.ending_start = endings_of(ending);
      if (type == "stop" || type == "discontinue") turn.ending_stop = true;
    }
    const auto repeat = node.child("repeat");
    if (!repeat) return;
    if (std::string_view(repeat.attribute("direction").value()) == "forward") {
      turn.forward = true;
    } else {
      turn.backward = true;
      if (const auto times = repeat.attribute("times")) {
        turn.times = static_cast<int>(number(repeat, times.value(), 1, 32));
      }
    }
  }
  /// "1, 2": one bit each, from bit 1.
  std::uint64_t endings_of(const pugi::xml_node& ending) {
    std::uint64_t out = 0;
    const std::string_view text = ending.attribute("number").value();
    for (std::size_t start = 0; start <= text.size();) {
      const std::size_t end = std::min(text.find_first_of(", ", start), text.size());
      if (end > start)
        out |= std::uint64_t{1} << static_cast<unsigned>(number(ending, text.substr(start, end - start), 1, 31));
      start = end + 1;
    }
    if (out == 0) fail(ending, "an ending without a number");
    return out;
  }

  void note_once(const std::string& text) {
    if (std::find(ignored_.begin(), ignored_.end(), text) == ignored_.end() && ignored_.size() < 50) {
      ignored_.push_back(text);
    }
  }

  /// What holds at the beginning of a measure, wherever the music comes from.
  struct InForce {
    ScoreEvents::Meter meter;
    std::optional<double> quarters_a_minute;
  };
  [[nodiscard]] std::vector<InForce> in_force() const {
    std::vector<InForce> out;
    InForce now;
    for (const Measure& measure : measures_) {
      if (measure.meter) now.meter = *measure.meter;
      out.push_back(now);
      if (!measure.tempos.empty()) now.quarters_a_minute = measure.tempos.back().quarters_a_minute;
    }
    return out;
  }

  /// The measures as they are played, one after the other.
  Result<ScoreEvents> events() {
    for (Measure& measure : measures_) {
      std::stable_sort(measure.tempos.begin(), measure.tempos.end(),
                       [](const auto& a, const auto& b) { return a.quarter < b.quarter; });
      if (measure.length <= 0) measure.length = measure.nominal;
    }
    if (turns_.size() < measures_.size()) turns_.resize(measures_.size());
    auto order = played_order(turns_);
    if (!order) return input_error(file_ + ": error: " + order.error().message);
    ScoreEvents out;
    out.ignored = std::move(ignored_);
    if (order->size() != measures_.size()) {
      out.ignored.emplace_back(
          "repeats are played out: measures are numbered as they are heard, not as they are printed");
    }
    write(*order, out);
    return out;
  }

  void write(const std::vector<std::size_t>& order, ScoreEvents& out) {
    double at = 0;
    const std::vector<InForce> held = in_force();
    ScoreEvents::Meter sounding;  // as of the measure before
    for (std::size_t k = 0; k < order.size(); ++k) {
      const Measure& measure = measures_[order[k]];
      const ScoreEvents::Meter& written = held[order[k]].meter;
      const auto tempo_before = held[order[k]].quarters_a_minute;
      if (k > 0 && order[k] != order[k - 1] + 1 && tempo_before) out.tempos.push_back({at, *tempo_before});
      const double nominal = written.beats * 4.0 / written.note;
      const bool shorter = std::abs(measure.length - nominal) > kSame;
      ScoreEvents::Meter meter{at, written.beats, written.note};
      if (k == 0 && measure.length < nominal - kSame) {
        out.pickup = measure.length;
      } else if (shorter) {
        meter = odd_measure(meter, measure.length, out);
      }
      if (k == 0 || meter.beats != sounding.beats || meter.note != sounding.note) out.meters.push_back(meter);
      sounding = meter;
      for (const auto& tempo : measure.tempos) {
        out.tempos.push_back({at + std::min(tempo.quarter, measure.length), tempo.quarters_a_minute});
      }
      for (const auto& mark : measure.rehearsals) out.rehearsals.push_back({at + mark.quarter, mark.text});
      at += measure.length;
    }
    std::stable_sort(out.rehearsals.begin(), out.rehearsals.end(),
                     [](const auto& a, const auto& b) { return a.quarter < b.quarter; });
    std::stable_sort(out.tempos.begin(), out.tempos.end(),
                     [](const auto& a, const auto& b) { return a.quarter < b.quarter; });
    out.end = at;
  }

  /// A measure with more or fewer notes than its meter has a meter of its own, where that can be written.
  static ScoreEvents::Meter odd_measure(const ScoreEvents::Meter& meter, double length, ScoreEvents& out) {
    const double beats = length * meter.note / 4;
    const std::string text = "measures that are not as long as their meter: they are as long as their notes";
    if (std::find(out.ignored.begin(), out.ignored.end(), text) == out.ignored.end()) out.ignored.push_back(text);
    if (beats < 1 - kSame || beats > 64 || std::abs(beats - std::round(beats)) > kSame) return meter;
    return {meter.quarter, static_cast<int>(std::round(beats)), meter.note};
  }

  LineIndex lines_;
  std::string file_;
  std::optional<Error> error_;
  std::vector<Measure> measures_;
  std::vector<MeasureTurn> turns_;
  std::vector<std::string> ignored_;
  bool is_first_ = true;  ///< part: meters, repeats and implicit measures are its word
  double divisions_ = 0;
  ScoreEvents::Meter meter_;
  double here_ = 0;  ///< in the measure, quarters
};

}  // namespace

Result<ScoreEvents> read_music_xml(std::string_view bytes, const std::string& file) {
  pugi::xml_document document;
  const pugi::xml_parse_result parsed = document.load_buffer(bytes.data(), bytes.size());
  if (!parsed) {
    const auto offset = std::min(static_cast<std::size_t>(std::max<std::ptrdiff_t>(parsed.offset, 0)), bytes.size());
    const LineIndex::Place place = LineIndex(bytes).place_of(offset);
    return input_error(fmt::format("{}:{}:{}: error: no XML that can be read: {}", file, place.line, place.column,
                                   parsed.description()));
  }
  return ScoreReader(bytes, file).read(document);
}

bool is_compressed_music_xml(std::string_view bytes) {
  const auto zip = ZipFile::open(bytes, "");
  return zip && std::any_of(zip->entries().begin(), zip->entries().end(),
                            [](const ZipFile::Entry& entry) { return entry.name == kContainer; });
}

Result<ScoreEvents> read_compressed_music_xml(std::string_view bytes, const std::string& file) {
  const auto zip = ZipFile::open(bytes, file);
  if (!zip) return zip.error();
  const auto entry_of = [&](std::string_view name) {
    return std::find_if(zip->entries().begin(), zip->entries().end(),
                        [&](const ZipFile::Entry& entry) { return entry.name == name; });
  };
  const auto container = entry_of(kContainer);
  if (container == zip->entries().end()) {
    return input_error(fmt::format("{}: error: a zip without {} is no compressed score", file, kContainer));
  }
  const auto text = zip->read(*container, kMostContainerBytes);
  if (!text) return text.error();
  pugi::xml_document document;
  if (!document.load_buffer(text->data(), text->size())) {
    return input_error(fmt::format("{}/{}: error: no XML that can be read", file, kContainer));
  }
  const std::string path =
      document.child("container").child("rootfiles").child("rootfile").attribute("full-path").value();
  const auto score = entry_of(path);
  if (score == zip->entries().end()) {
    return input_error(fmt::format("{}/{}: error: the score {} is not in the zip", file, kContainer, in_quotes(path)));
  }
  const auto xml = zip->read(*score, kMostScoreBytes);
  if (!xml) return xml.error();
  return read_music_xml(*xml, file + "/" + path);
}

}  // namespace footlight::config

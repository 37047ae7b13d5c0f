// SPDX-License-Identifier: Apache-2.0
#include <string_view>
#include <utility>

#include <fmt/format.h>

#include "app/surfaces/show_timecode.hpp"
#include "app/time/sound_input.hpp"
#include "app/time/time_source.hpp"
#include "controller/time/ltc.hpp"

namespace footlight::app {
namespace {

constexpr std::string_view kAlsa = "alsa:";

class LtcSource final : public TimeSource {
 public:
  LtcSource(std::string name, std::unique_ptr<SoundInput> input, const TimeRules& rules)
      : name_(std::move(name)), input_(std::move(input)), rules_(rules), decoder_(input_->sample_rate(), rules.rate) {}
  [[nodiscard]] std::string name() const override { return name_; }

  TimeNews read(Instant now, const ShowState& /*show*/) override {
    TimeNews news;
    SoundInput::Piece piece = input_->read(now);
    if (!piece.trouble.empty()) news.alarms.push_back(name_ + ": " + piece.trouble);
    if (piece.gap) decoder_.restart();
    if (piece.samples.empty()) return news;
    // Sample 0 of the stream sounded so long before what comes next; a device's own clock is followed piece by piece.
    const double samples = static_cast<double>(decoder_.samples()) + static_cast<double>(piece.samples.size());
    const Instant began = piece.ends - seconds(samples / input_->sample_rate());
    decoder_.take(piece.samples, began, [&](const TimeFix& fix) {
      news.fixes.push_back({fix.at, in_show(fix.position, rules_)});
    });
    if (decoder_.knows_rate() && decoder_.rate() != rules_.rate && !told_rate_) {
      told_rate_ = true;
      news.alarms.push_back(fmt::format("{}: {} frames a second, the show file says {}: it is followed as it is", name_,
                                        to_text(decoder_.rate()), to_text(rules_.rate)));
    }
    return news;
  }

 private:
  std::string name_;
  std::unique_ptr<SoundInput> input_;
  TimeRules rules_;
  controller::LtcDecoder decoder_;
  bool told_rate_ = false;
};

}  // namespace

Result<std::unique_ptr<TimeSource>> open_ltc(const std::string& what, const std::filesystem::path& folder,
                                             const TimeRules& rules) {
  const bool alsa = std::string_view(what).starts_with(kAlsa);
  auto input = alsa ? open_alsa_input(what.substr(kAlsa.size())) : open_sound_file(folder / what);
  if (!input) return std::move(input).error();
  return std::unique_ptr<TimeSource>(
      std::make_unique<LtcSource>("ltc " + (alsa ? what.substr(kAlsa.size()) : what), std::move(input).value(), rules));
}

}  // namespace footlight::app

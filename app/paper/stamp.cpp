// SPDX-License-Identifier: Apache-2.0
#include "app/paper/stamp.hpp"

#include <fmt/format.h>

#include "config/plan_digest.hpp"

namespace footlight::app {
namespace {

constexpr std::size_t kShowDigits = 8;
constexpr std::size_t kPlanDigits = 12;

}  // namespace

Stamp::Stamp(const Plan& of)
    : title(of.title),
      version(of.version),
      show(of.show_hash.substr(0, kShowDigits)),
      plan(config::digest_of(of).substr(0, kPlanDigits)),
      valid(of.valid) {}

std::string Stamp::name() const { return version.empty() ? title : title + "   version " + version; }

std::string Stamp::digits() const {
  return fmt::format("   show {}   plan {}   Footlight {}{}", show, plan, FOOTLIGHT_VERSION,
                     valid ? "" : "   REFUSED: this plan breaks its limits");
}

std::string Stamp::line_of(const Canvas& canvas, double size, double width) const {
  const std::string rest = digits();
  return canvas.beginning(name(), size, width - canvas.width_of(rest, size)) + rest;
}

}  // namespace footlight::app

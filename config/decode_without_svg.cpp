// SPDX-License-Identifier: Apache-2.0
#include "config/decode_still.hpp"

namespace footlight::config {

Still read_svg(const std::string& /*path*/) {
  Still out;
  out.status = DecodeStatus::without_svg;
  return out;
}

}  // namespace footlight::config

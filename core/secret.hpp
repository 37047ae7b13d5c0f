// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>

namespace footlight {

/// Takes the same time wherever two secrets of one length differ; the length is no secret. Thread: reentrant.
[[nodiscard]] bool same_secret(std::string_view one, std::string_view other);

}  // namespace footlight

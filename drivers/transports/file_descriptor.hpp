// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/file_descriptor.hpp"
